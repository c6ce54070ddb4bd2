"""The stories that every drive has to pass, told to the firmware; its cycles are the clock."""

import inspect
from dataclasses import replace
from datetime import timedelta
from typing import cast

import pytest

from app.base.clock import VirtualClock
from app.machine.drive_factory import DriveFactory
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from tests.controllers.avr_board import HZ, Board, powered
from tests.drives.conformance import Story, stories_for
from tests.drives.rigs import CONFIG, FULL, START, Rig

WIRE_TAKES_TIME = {
    "a_jog_turns_at_its_speed_and_a_halt_ends_it",
    "a_new_target_in_mid_move_makes_no_jump",
    "without_commands_the_watchdog_ramps_both_axes_down",
    "stop_ramps_both_axes_down",
}
"""They compare with a wire without delay; `test_avr.py` measures the same in cycles."""


class BoardClock(VirtualClock):
    """Lets the board run when time passes; what the wire took counts as part of it."""

    def __init__(self, board: Board) -> None:
        super().__init__(START)
        self._board = board
        self._due = board.cycle

    def advance(self, by: timedelta) -> None:
        """Let time pass on the board too."""
        super().advance(by)
        self._due += round(by.total_seconds() * HZ)
        self._board.say(f"run {max(0, self._due - self._board.cycle)}")


def told_without_a_machine(tell: Story) -> bool:
    """Return whether a story needs nothing but the drive: faults of the simulated machine have no pin."""
    return "rig.machine" not in inspect.getsource(tell) and tell.__name__ not in WIRE_TAKES_TIME


STORIES = [tell for tell in stories_for(FULL) if told_without_a_machine(tell)]


@pytest.mark.parametrize("tell", STORIES, ids=lambda tell: tell.__name__)
async def test_the_firmware_passes(tell: Story) -> None:
    with powered() as board:
        clock = BoardClock(board)
        serial = SerialConfig(board.terminal, 38_400)
        drive = DriveFactory(clock).make(
            replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_RTU, serial=serial))
        )
        await tell(Rig(drive, cast(SimulatedDrive, None), clock))
        await drive.close()


def test_the_firmware_hears_most_stories() -> None:
    assert len(STORIES) >= 12
