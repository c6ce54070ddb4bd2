"""Every order is said once: its spec, who carries it out, where it comes from; and how short its way is."""

import ast
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import get_args

import pytest

from app.link.messages import SiteCommand
from app.link.orders import KINDS
from app.link.settings_orders import UndoSiteSettings
from app.tracker import orders
from app.tracker.access import interlocks
from app.tracker.access.interlocks import Action
from app.tracker.commands.commands import Command
from app.tracker.values.order_spec import Interface, Motion, OrderSpec
from app.web.features.control import motion_api
from tests.site.plant import Plant

APP = Path(__file__).parents[2] / "app"
DOORS = {
    Interface.PAGE: ("web/shell", "web/features", "web/sockets.py"),
    Interface.API: ("web/api", "web/features"),
    Interface.SUNSPEC: ("gateway/sunspec_controls.py", "gateway/calibration.py"),
}
STANDS_AT_THE_MACHINE = {
    "set_inhibit",
    "release_inhibit",
    "begin_service_mode",
    "confirm_area_clear",
    "end_service_mode",
}


def kinds_where(holds: Callable[[OrderSpec], bool]) -> set[str]:
    return {kind for kind, one in KINDS.items() if holds(one.spec)}


def test_every_order_has_a_kind_of_its_own_and_a_spec() -> None:
    every = (*get_args(Command), *get_args(SiteCommand))
    assert len(KINDS) == len(every) == len(set(every))
    assert all(isinstance(one.spec, OrderSpec) for one in every)
    assert all("spec" not in {field.name for field in fields(one)} for one in every)


async def test_every_order_is_carried_out_by_exactly_one(plant: Plant) -> None:
    to_site = plant.site._handlers
    assert set(orders.HANDLERS) == set(get_args(Command))
    assert {*to_site, UndoSiteSettings} == set(get_args(SiteCommand))
    assert len(to_site) == len(get_args(SiteCommand)) - 1


def test_every_command_says_why_it_is_refused() -> None:
    commands = {kind for kind, one in KINDS.items() if one in orders.HANDLERS}
    assert commands - {"end_jog"} == set(Action) - {Action.SET_LIMIT}
    assert set(interlocks.REQUIRED) == set(Action)


def test_only_stops_go_the_way_of_stops_and_only_they_and_alarms_go_in_safe_mode() -> None:
    stops = {"stop", "stop_all"}
    assert kinds_where(lambda spec: spec.motion is Motion.STOPS) == stops
    assert kinds_where(lambda spec: spec.ends_motion) == stops | {"end_jog"}
    alarms = {"acknowledge_alarm", "shelve_alarm", "unshelve_alarm"}
    assert kinds_where(lambda spec: spec.in_safe_mode) == stops | alarms


def test_control_is_needed_for_everything_but_stops_and_who_stands_at_the_machine() -> None:
    free = {kind for kind in kinds_where(lambda spec: not spec.control) if KINDS[kind] in orders.HANDLERS}
    assert free == {"stop", "end_jog"} | STANDS_AT_THE_MACHINE


def test_whatever_begins_motion_needs_the_drive_unlocked() -> None:
    for kind in kinds_where(lambda spec: spec.motion is Motion.BEGINS):
        assert interlocks.remote in interlocks.REQUIRED[Action(kind)]


def test_everything_is_recorded_but_measurements_readings_and_signs_of_life() -> None:
    assert kinds_where(lambda spec: not spec.audited) == {
        "report_weather",
        "check_connection",
        "renew_control",
        "report_device_clock",
    }
    assert kinds_where(lambda spec: spec.held) == {"jog", "end_jog"}


@pytest.mark.parametrize("door", list(DOORS), ids=lambda door: str(door.name))
def test_an_order_comes_from_the_interfaces_that_its_spec_names_and_from_no_other(door: Interface) -> None:
    given = {name for place in DOORS[door] for name in _orders_in(APP / place, door)}
    if door is Interface.API:
        given |= {one.order.__name__ for one in get_args(get_args(motion_api.AnyCommand)[0])}
    assert given == {one.__name__ for one in KINDS.values() if door in one.spec.by}


def _serves(path: Path, door: Interface) -> bool:
    """Return whether a module of a feature is one of this interface; what is signed is asked for by both."""
    return path.name == "record_orders.py" or path.name.endswith("_api.py") is (door is Interface.API)


def _orders_in(place: Path, door: Interface) -> Iterator[str]:
    names = {one.__name__ for one in KINDS.values()}
    for path in place.rglob("*.py") if place.is_dir() else (place,):
        if "features" in path.parts and not _serves(path, door):
            continue
        tree = ast.parse(path.read_text())
        imported = {
            alias.name
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom)
            and (node.module or "").startswith(("app.tracker.commands.commands", "app.link."))
            for alias in node.names
        }
        yield from imported & names & {one.id for one in ast.walk(tree) if isinstance(one, ast.Name)}
