"""Every story on the simulated drive and behind a socket; what a wire could spoil on every other wire."""

import pytest

from tests.drives.conformance import Story, on_every_wire, stories_for
from tests.drives.rigs import FULL, RIGS

TOLD_ALL = ("simulated", "modbus-tcp")
CASES = [
    (name, tell) for name in RIGS for tell in (stories_for(FULL) if name in TOLD_ALL else on_every_wire())
]


@pytest.mark.parametrize(("name", "tell"), CASES, ids=[f"{name}-{tell.__name__}" for name, tell in CASES])
async def test_story(name: str, tell: Story) -> None:
    async with RIGS[name]() as rig:
        await tell(rig)
