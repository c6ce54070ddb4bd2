"""Every story that fits on every shipped profile, against the simulated device of its maker."""

import pytest

from tests.drives.conformance import (
    Story,
    a_move_ends_at_its_target_at_its_own_speed,
    a_silent_drive_is_said_to_be_silent_and_found_again,
    stories_for,
)
from tests.drives.device_rigs import BENCHES, device_rig, serial_device_rig

CASES = [(name, tell) for name, bench in BENCHES.items() for tell in stories_for(bench.traits)]


@pytest.mark.parametrize(("name", "tell"), CASES, ids=[f"{name}-{tell.__name__}" for name, tell in CASES])
async def test_story(name: str, tell: Story) -> None:
    async with device_rig(BENCHES[name]) as rig:
        await tell(rig)


@pytest.mark.parametrize("name", BENCHES)
async def test_a_move_and_a_silence_on_a_serial_line(name: str) -> None:
    """Blocks of one or two registers leave no shorter probe that could tell a late reply."""
    for tell in (
        a_move_ends_at_its_target_at_its_own_speed,
        a_silent_drive_is_said_to_be_silent_and_found_again,
    ):
        async with serial_device_rig(BENCHES[name]) as rig:
            await tell(rig)
