"""An Oriental Motor AZ driver: direct data operation, driver input and output, monitors.

Sources: Oriental Motor AZ series function manual (direct data operation, driver input command); FAQ 0331.
"""

from collections.abc import Collection

from app.simulation.devices.axis_device import AxisDevice
from app.tracker.values.motion import AxisFeedback, Position, Velocity

DIRECT, INPUT, OUTPUT, ALARM = 0x0058, 0x007C, 0x007E, 0x0080
KIND, TARGET, SPEED, TRIGGER = DIRECT + 2, DIRECT + 4, DIRECT + 6, DIRECT + 14
POSITION, SPEED_RPM, SPEED_HZ = 0x00CC, 0x00CE, 0x00D0
CLEAR_ALARM, PRESET, DATA_0_POSITION = 0x0180, 0x018A, 0x1802
WRITABLE = (*range(DIRECT, DIRECT + 16, 2), INPUT, CLEAR_ALARM, PRESET, DATA_0_POSITION)
HOME_BIT, STOP_BIT, CLEAR_BIT = 0x10, 0x20, 0x80
ABSOLUTE, RELATIVE, CONTINUOUS = 1, 2, 16
STEPS_PER_REVOLUTION = 1000


class OrientalDrive(AxisDevice):
    """One axis; a motion starts when the last register of the direct data block is written as 1."""

    @property
    def writable(self) -> Collection[int]:
        """Return the registers that may be written, both words of each."""
        return {one for address in WRITABLE for one in (address, address + 1)}

    def power_up(self) -> None:
        """Begin with nothing commanded and no input on."""
        self._input = 0
        for address in WRITABLE:
            self.put_wide(address, 0)

    def refresh(self, feedback: AxisFeedback, fault_code: int) -> None:
        """Show outputs, alarm, position and speed."""
        ready = not feedback.moving and not fault_code and not self.homing
        flags = {
            4: feedback.homed and not self.homing,
            5: ready,
            7: fault_code != 0,
            8: feedback.moving,
            13: feedback.moving,
            14: not feedback.moving,
        }
        self.put_wide(OUTPUT, sum(1 << bit for bit, is_on in flags.items() if is_on))
        self.put_wide(ALARM, fault_code)
        self.put_wide(POSITION, self.steps(feedback.position_deg))
        speed = feedback.velocity_dps * self.steps_per_deg
        self.put_wide(SPEED_HZ, round(speed))
        self.put_wide(SPEED_RPM, round(speed * 60.0 / STEPS_PER_REVOLUTION))

    def act(self, written: Collection[int]) -> None:
        """Follow inputs, presets and the trigger of the direct data block."""
        if INPUT + 1 in written:
            self._take_inputs(self.word(INPUT + 1))
        if CLEAR_ALARM + 1 in written and self.wide(CLEAR_ALARM) == 1:
            self.machine.reset_fault()
        if PRESET + 1 in written and self.wide(PRESET) == 1:
            self.machine.set_home(self.axis)
        if TRIGGER + 1 in written and self.wide(TRIGGER) == 1 and not self._input & STOP_BIT:
            self._operate()

    def _take_inputs(self, word: int) -> None:
        rising, self._input = word & ~self._input, word
        if word & STOP_BIT:
            self.halt()
        elif rising & HOME_BIT:
            self.seek_origin()
        if rising & CLEAR_BIT:
            self.machine.reset_fault()

    def _operate(self) -> None:
        speed_dps = self.wide(SPEED) / self.steps_per_deg
        target_deg = self.wide(TARGET) / self.steps_per_deg
        self.homing = False
        match self.wide(KIND):
            case kind if kind == ABSOLUTE:
                self.machine.turn(self.axis, Position(target_deg, speed_dps))
            case kind if kind == RELATIVE:
                self.machine.turn(self.axis, Position(self.feedback.position_deg + target_deg, speed_dps))
            case kind if kind == CONTINUOUS:
                self.machine.turn(self.axis, Velocity(speed_dps))
