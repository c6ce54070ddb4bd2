"""Every story that fits on every shipped profile, against the simulated device of its maker."""

import pytest

from tests.drives import conformance
from tests.drives.conformance import Story, stories_for
from tests.drives.device_rigs import BENCHES, device_rig, serial_device_rig

CASES = [(name, tell) for name, bench in BENCHES.items() for tell in stories_for(bench.traits)]

ON_A_LINE = {
    conformance.a_silent_drive_is_said_to_be_silent_and_found_again,
    conformance.a_move_ends_at_its_target,
    conformance.homing_goes_on_while_halt_is_written,
    conformance.a_stop_overtakes_a_move_and_the_drive_obeys_again,
}
"""What a serial line could spoil: the connection, moves, the search for zero, and stops."""
SERIAL_CASES = [case for case in CASES if case[1] in ON_A_LINE]


@pytest.mark.parametrize(("name", "tell"), CASES, ids=[f"{name}-{tell.__name__}" for name, tell in CASES])
async def test_story(name: str, tell: Story) -> None:
    async with device_rig(BENCHES[name]) as rig:
        await tell(rig)


@pytest.mark.parametrize(
    ("name", "tell"), SERIAL_CASES, ids=[f"{name}-{tell.__name__}" for name, tell in SERIAL_CASES]
)
async def test_story_on_a_serial_line(name: str, tell: Story) -> None:
    async with serial_device_rig(BENCHES[name]) as rig:
        await tell(rig)
