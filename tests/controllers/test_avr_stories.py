"""The stories that every drive has to pass, told to the firmware; its cycles are the clock."""

from dataclasses import replace
from datetime import timedelta
from typing import cast

import pytest

from app.base.clock import VirtualClock
from app.machine.drive_factory import DriveFactory
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from tests.controllers.avr_board import HZ, Board, powered
from tests.drives import conformance
from tests.drives.conformance import Story
from tests.drives.rigs import CONFIG, START, Rig

TOLD: list[Story] = [
    conformance.a_request_is_carried_out_once,
    conformance.a_moving_axis_cannot_be_zeroed,
    conformance.homing_goes_on_while_halt_is_written,
    conformance.a_drive_that_is_fed_in_time_goes_on,
    conformance.a_stop_overtakes_a_move_and_the_drive_obeys_again,
]
"""What needs no fault of the simulated machine, and no wire without delay, and is not in `test_avr.py`."""


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


@pytest.mark.parametrize("tell", TOLD, ids=lambda tell: tell.__name__)
async def test_the_firmware_passes(tell: Story) -> None:
    with powered() as board:
        clock = BoardClock(board)
        serial = SerialConfig(board.terminal, 38_400)
        drive = DriveFactory(clock).make(
            replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_RTU, serial=serial))
        )
        await tell(Rig(drive, cast(SimulatedDrive, None), clock))
        await drive.close()
