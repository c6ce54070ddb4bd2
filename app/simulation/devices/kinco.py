"""A Kinco FD servo drive: CiA 402 objects at their Modbus addresses, low word first.

Sources: Kinco FD5P manual, chapter 10, and CD3 manual, p. 122 (frames, statusword bits 10 and 15, sequences
of controlwords, units); CiA 402-2 for the state machine. A read that fails is answered with function 81h.
"""

from collections.abc import Collection

from app.drives.register import WordOrder
from app.simulation.devices.axis_device import AxisDevice
from app.tracker.values.motion import AxisFeedback, Position, Velocity

CONTROLWORD, STATUSWORD, MODE, POSITION, VELOCITY = 0x3100, 0x3200, 0x3500, 0x3700, 0x3B00
TARGET_POSITION, PROFILE_VELOCITY, ACCELERATION, DECELERATION = 0x4000, 0x4A00, 0x4B00, 0x4C00
HOMING_METHOD, INPUTS, TARGET_VELOCITY, ERROR = 0x4D00, 0x6D00, 0x6F00, 0x1F00
WIDE = (TARGET_POSITION, PROFILE_VELOCITY, ACCELERATION, DECELERATION, TARGET_VELOCITY)
NARROW = (CONTROLWORD, MODE, HOMING_METHOD)
DISABLED, READY, SWITCHED_ON, ENABLED, FAULT = 0x40, 0x21, 0x23, 0x27, 0x08
UNITS_PER_STEP_RATE = 512.0 * 60.0 / 1875.0
PRESENT_POSITION = (35, 37)
COMMANDS = {
    (DISABLED, 0x06): READY,
    (READY, 0x07): SWITCHED_ON,
    (READY, 0x0F): ENABLED,
    (SWITCHED_ON, 0x0F): ENABLED,
    (SWITCHED_ON, 0x06): READY,
    (ENABLED, 0x06): READY,
    (ENABLED, 0x07): SWITCHED_ON,
}
"""State and the four lowest bits of the controlword, and the state that follows; 0 disables from any."""


class KincoDrive(AxisDevice):
    """Modes 1 (position), 3 (velocity) and 6 (homing) of one servo axis."""

    order = WordOrder.LOW_FIRST

    @property
    def writable(self) -> Collection[int]:
        """Return the objects that may be written."""
        return {*NARROW, *WIDE, *(address + 1 for address in WIDE)}

    def power_up(self) -> None:
        """Begin in switch-on disabled, in mode 1, with nothing commanded."""
        self._state = DISABLED
        self._last_controlword = 0
        for address in NARROW:
            self.put(address, 0)
        for address in WIDE:
            self.put_wide(address, 0)
        self.put(MODE, 1)

    def refresh(self, feedback: AxisFeedback, fault_code: int) -> None:
        """Show statusword, position, speed, inputs and error."""
        if fault_code:
            self._state = FAULT
        self.put(ERROR, fault_code)
        self.put(STATUSWORD, self._statusword(feedback))
        self.put(STATUSWORD + 1, 0)
        self.put_wide(POSITION, self.steps(feedback.position_deg))
        rate = feedback.velocity_dps * self.steps_per_deg
        self.put_wide(VELOCITY, round(rate * UNITS_PER_STEP_RATE))
        switches = (feedback.at_lower_limit, feedback.at_upper_limit, feedback.at_origin)
        self.put_wide(INPUTS, sum(1 << bit for bit, is_on in enumerate(switches) if is_on))

    def act(self, written: Collection[int]) -> None:
        """Follow a controlword; a new target speed counts at once, a new target position does not."""
        if CONTROLWORD in written:
            controlword = self.word(CONTROLWORD)
            self._change_state(controlword)
            if self._state == ENABLED:
                self._move(controlword)
            self._last_controlword = controlword
        elif TARGET_VELOCITY in written and self._state == ENABLED and self.word(MODE) == 3:
            self._move(self.word(CONTROLWORD))

    async def let_out(self, reply: bytes) -> bytes | None:
        """Answer a read that fails with function 81h instead of 83h, as this drive does."""
        if reply[7] == 0x83:
            reply = reply[:7] + b"\x81" + reply[8:]
        return await super().let_out(reply)

    def _change_state(self, controlword: int) -> None:
        before = self._state
        if self._state == FAULT:
            if controlword & 0x80 and not self._last_controlword & 0x80:
                self.machine.reset_fault()
                self._state = DISABLED
        elif not controlword & 0x02:
            self._state = DISABLED
        else:
            self._state = COMMANDS.get((self._state, controlword & 0x0F), self._state)
        if before == ENABLED and self._state != ENABLED:
            self.halt()

    def _move(self, controlword: int) -> None:
        """Do what mode and controlword say, in operation enabled."""
        rising = controlword & 0x10 and not self._last_controlword & 0x10
        if controlword & 0x100:
            self.halt()
        elif self.word(MODE) == 3:
            speed_dps = self.wide(TARGET_VELOCITY) / UNITS_PER_STEP_RATE / self.steps_per_deg
            self.machine.turn(self.axis, Velocity(speed_dps))
        elif self.word(MODE) == 1 and rising:
            self._go(relative=bool(controlword & 0x40))
        elif self.word(MODE) == 6 and rising:
            self._home()

    def _go(self, *, relative: bool) -> None:
        speed_dps = self.wide(PROFILE_VELOCITY) / UNITS_PER_STEP_RATE / self.steps_per_deg
        target_deg = self.wide(TARGET_POSITION) / self.steps_per_deg
        begin_deg = self.feedback.position_deg if relative else 0.0
        self.homing = False
        self.machine.turn(self.axis, Position(begin_deg + target_deg, speed_dps))

    def _home(self) -> None:
        if self.signed(HOMING_METHOD) in PRESENT_POSITION:
            self.homing_failed = not self.machine.set_home(self.axis)
        else:
            self.seek_origin()

    def _statusword(self, feedback: AxisFeedback) -> int:
        reached = not feedback.moving
        limited = feedback.at_lower_limit or feedback.at_upper_limit
        flags = {10: reached, 11: limited, 13: self.homing_failed, 15: feedback.homed and not self.homing}
        return self._state | sum(1 << bit for bit, is_on in flags.items() if is_on)
