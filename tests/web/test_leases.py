"""How long a heartbeat lets an axis turn: counted from its arrival, and a press that ran out is forgotten."""

import json
from datetime import timedelta

from fastapi import FastAPI

from app.access.principal import Principal, Via
from app.access.roles import Role, permissions_of
from app.base.clock import VirtualClock
from app.tracker.commands.commands import JOG_LEASE, EndJog, Jog
from app.web.live.viewers import Wanted
from app.web.shell.deps import Panel
from app.web.sockets import Session
from tests.fakes import FakeMachine
from tests.web.sockets import heartbeat
from tests.web.test_live import app, clock, forward, machine, settle

__all__ = ["app", "clock", "machine"]

BEAT_MS = 50.0
ROLES = frozenset({Role.ENGINEER})
SOMEBODY = Principal("Ada", ROLES, permissions_of(ROLES), Via.LOOPBACK, "127.0.0.1")


def session(app: FastAPI) -> Session:
    panel: Panel = app.state.panel
    return Session(panel, panel.hub.join(Wanted("T1")), SOMEBODY)


def beat(page: Session, press: str, sequence: int, sent_ms: float) -> None:
    page.hear(json.dumps(heartbeat(press, sequence, sent_ms)))


def given(machine: FakeMachine) -> list[Jog | EndJog]:
    return [order.command for order in machine.orders if isinstance(order.command, Jog | EndJog)]


async def test_what_the_panel_takes_to_pass_a_heartbeat_on_is_taken_off_the_lease(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    page, busy = session(app), timedelta(milliseconds=80)
    beat(page, "p1", 0, 1000.0)
    clock.advance(busy)
    await settle()
    (jog,) = given(machine)
    assert isinstance(jog, Jog)
    assert jog.lease == JOG_LEASE - busy


async def test_a_heartbeat_that_the_panel_kept_too_long_moves_nothing_longer_than_its_lease(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    page = session(app)
    beat(page, "p1", 0, 1000.0)
    clock.advance(JOG_LEASE * 2)
    await settle()
    assert all(isinstance(order, Jog) and order.lease == timedelta() for order in given(machine))


async def test_a_page_that_goes_ends_only_the_press_that_is_held(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    """A hundred ends of jogs at once kept the controller from its ticks for a quarter of a second."""
    page = session(app)
    for number in range(100):
        beat(page, f"p{number}", 0, 1000.0 + number * 300.0)
        await settle()
        machine.trackers["T1"].press = None
        await forward(clock, 0.3)
    beat(page, "last", 0, 1000.0 + 100 * 300.0)
    await settle()
    machine.orders.clear()
    page.close()
    await settle()
    assert given(machine) == [EndJog("last")]


async def test_a_press_that_ran_out_is_dead_on_every_connection(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    page, other = session(app), session(app)
    beat(page, "p1", 0, 1000.0)
    await settle()
    machine.trackers["T1"].press = None
    await forward(clock, JOG_LEASE.total_seconds() + 0.01)
    beat(page, "p2", 0, 1300.0)
    await settle()
    beat(other, "p1", 1, 1300.0)
    await settle()
    assert [order.press_id for order in given(machine)] == ["p1", "p2"]


async def test_a_press_that_is_renewed_stays_alive(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    page = session(app)
    for sequence in range(20):
        beat(page, "p1", sequence, 1000.0 + sequence * BEAT_MS)
        await settle()
        await forward(clock, BEAT_MS / 1000.0)
    jogs = [order for order in given(machine) if isinstance(order, Jog)]
    assert [(jog.sequence, jog.lease) for jog in jogs] == [(number, JOG_LEASE) for number in range(20)]
