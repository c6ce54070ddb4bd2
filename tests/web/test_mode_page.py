"""Step 4 says which angles a mode holds, how they stand now, and where they are set."""

import re
from collections.abc import AsyncIterator
from dataclasses import replace

import httpx
import pytest

from app.tracker.settings.config import MountConfig, MountKind, Orientation
from app.tracker.values.mode import Mode
from tests.fakes import FakeMachine, fake_app, serving

PAGE = "/trackers/T1/commissioning/mode"


@pytest.fixture
def machine() -> FakeMachine:
    machine = FakeMachine()
    tracker = machine.trackers["T1"]
    tracker.memory = replace(tracker.memory, orientation=Orientation(170.0, 32.5))
    return machine


@pytest.fixture
async def client(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as one:
        yield one


async def held(client: httpx.AsyncClient) -> dict[str, str]:
    """Return what the page says of the angles that each mode holds."""
    page = (await client.get(PAGE)).text
    rows = re.findall(r'name="mode" value="(\w+)".*?</label>', page, re.DOTALL)
    said = [re.search(r'class="mode-held">([^<]*)<', row) for row in page.split('name="mode"')[1:]]
    return {mode: one[1] if one else "" for mode, one in zip(rows, said, strict=True)}


async def test_each_mode_says_what_it_holds_and_where_that_is_set(client: httpx.AsyncClient) -> None:
    assert await held(client) == {
        "dual": "",
        "azimuth": "Elevation 32.5°, set on the next page.",
        "elevation": "Azimuth 170.0°, set on the next page.",
        "fixed": "Azimuth 170.0° and elevation 32.5°, set on the next page.",
    }


@pytest.mark.parametrize("mode", Mode)
async def test_a_mode_that_holds_an_angle_leads_to_where_it_is_set(
    mode: Mode, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    tracker = machine.trackers["T1"]
    tracker.memory = replace(tracker.memory, mode=mode)
    link = re.search(r'id="set-held" href="([^"]*)"', (await client.get(PAGE)).text)
    assert (link is not None) == (mode is not Mode.DUAL)
    if link is not None:
        form = (await client.get(link[1])).text
        assert ("f-elevation" in form, "f-azimuth" in form) == (
            mode is not Mode.ELEVATION,
            mode is not Mode.AZIMUTH,
        )


async def test_a_single_axis_holds_a_direction_when_it_is_fixed_alone(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    tracker = machine.trackers["T1"]
    tracker.config = replace(tracker.config, mount=MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS))
    assert await held(client) == {
        "azimuth": "",
        "fixed": "Azimuth 170.0° and elevation 32.5°, set on the next page.",
    }
