"""Step 5 says where the axes would go if tracking began now, and step 4 has a mode chosen from the start."""

import re
from dataclasses import replace
from datetime import UTC, datetime

import httpx
import pytest

from app.base.clock import VirtualClock
from app.sun.position import Algorithm, sun_position
from app.tracker.commands.commands import SelectMode
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode
from tests.fakes import FakeMachine, fake_app, serving

NOON = datetime(2026, 6, 21, 9, 30, tzinfo=UTC)
NIGHT = datetime(2026, 6, 21, 22, 0, tzinfo=UTC)
START = "/trackers/T1/commissioning/run"
AIM = re.compile(r'id="run-aim" hidden(?: data-aim="([\d.-]+) ([\d.-]+)")?')


async def aim_of(machine: FakeMachine) -> tuple[float, float] | None:
    """Return the angles that the page has, and that its part has too."""
    async with serving(fake_app(machine)) as client:
        whole, part = [AIM.search((await client.get(path)).text) for path in (START, f"{START}/aim")]
    assert whole is not None
    assert part is not None
    assert whole.groups() == part.groups()
    return None if whole[1] is None else (float(whole[1]), float(whole[2]))


def choose(machine: FakeMachine, mode: Mode, orientation: Orientation | None = None) -> None:
    machine.trackers["T1"].handle(SelectMode(mode, orientation), machine.clock.now(), "ada")


async def test_with_both_axes_the_panel_would_go_to_the_sun() -> None:
    machine = FakeMachine(VirtualClock(NOON))
    choose(machine, Mode.DUAL)
    assert machine.site.location is not None
    sun = sun_position(Algorithm.PSA, machine.site.location, NOON)
    assert await aim_of(machine) == pytest.approx((sun.azimuth_deg, sun.apparent_elevation_deg), abs=1e-9)


async def test_a_fixed_panel_would_go_where_it_is_held_by_night_too() -> None:
    machine = FakeMachine(VirtualClock(NIGHT))
    choose(machine, Mode.FIXED, Orientation(170.0, 30.0))
    assert await aim_of(machine) == pytest.approx((170.0, 30.0))


async def test_by_night_and_without_a_location_it_is_not_known_where() -> None:
    machine = FakeMachine(VirtualClock(NIGHT))
    choose(machine, Mode.DUAL)
    assert await aim_of(machine) is None
    machine = FakeMachine(VirtualClock(NOON))
    choose(machine, Mode.DUAL)
    machine.site = replace(machine.site, location=None)
    assert await aim_of(machine) is None


async def test_until_a_mode_was_saved_the_first_is_chosen(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    path = "/trackers/T1/commissioning/mode"
    tracker = machine.trackers["T1"]
    tracker.memory = replace(tracker.memory, mode=None)
    assert checked(await client.get(path)) == ["dual"]
    choose(machine, Mode.AZIMUTH)
    assert checked(await client.get(path)) == ["azimuth"]


def checked(answer: httpx.Response) -> list[str]:
    return re.findall(r'name="mode" value="(\w+)"\s+required checked', answer.text)
