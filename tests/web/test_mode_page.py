"""Step 4 says which angles a mode holds, how they stand now, and where they are set."""

import re
from dataclasses import replace

import httpx
import pytest

from app.tracker.settings.config import Orientation
from tests.fakes import FakeMachine

PAGE = "/trackers/T1/commissioning/mode"


@pytest.fixture
def machine() -> FakeMachine:
    machine = FakeMachine()
    tracker = machine.trackers["T1"]
    tracker.memory = replace(tracker.memory, orientation=Orientation(170.0, 32.5))
    return machine


async def held(client: httpx.AsyncClient) -> dict[str, str]:
    """Return what the page says of the angles that each mode holds."""
    page = (await client.get(PAGE)).text
    rows = re.findall(r'name="mode" value="(\w+)".*?</label>', page, re.DOTALL)
    said = [re.search(r'class="mode-held">([^<]*)<', row) for row in page.split('name="mode"')[1:]]
    return {mode: one[1] if one else "" for mode, one in zip(rows, said, strict=True)}


async def test_each_mode_says_what_it_holds_and_where_that_is_set(client: httpx.AsyncClient) -> None:
    assert await held(client) == {
        "dual": "",
        "azimuth": "Elevation 32.5°.",
        "elevation": "Azimuth 170.0°.",
        "fixed": "Azimuth 170.0°, elevation 32.5°.",
    }
