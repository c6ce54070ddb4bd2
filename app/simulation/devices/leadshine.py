"""A Leadshine CS2RS or EM2RS stepper drive: path table, motion status and control word.

Sources: Leadshine CS2RS manual, pp. 15, 24, 43 and appendix A; EM2RS manual, p. 26. Path 0 alone is served.
"""

from collections.abc import Collection

from app.simulation.devices.axis_device import AxisDevice
from app.tracker.values.motion import AxisFeedback, Position, Velocity

PULSES, DIRECTION, ENABLE, PEAK_CURRENT, INPUT_1 = 0x0001, 0x0007, 0x000F, 0x0191, 0x0145
STATUS, COMMAND_POSITION, POSITION, COMMAND_SPEED, SPEED = 0x1003, 0x1012, 0x1014, 0x1044, 0x1046
CONTROL, ALARM, TRIGGER, INPUTS = 0x1801, 0x2203, 0x6002, 0x602E
PATH, PATH_WORDS = 0x6200, 8
PATH_MODE, PATH_POSITION, PATH_SPEED, PATH_TRIGGER = PATH, PATH + 1, PATH + 3, PATH + 7
ORIGIN, POSITIVE_LIMIT, NEGATIVE_LIMIT = 0x27, 0x25, 0x26
INPUT_COUNT = 7
RUN_PATH_0, HOME, SET_HOME, STOP = 0x10, 0x20, 0x21, 0x40
RESET_ALARM = 0x1111
ABSOLUTE, RELATIVE, TURN = 0x01, 0x41, 0x02


class LeadshineDrive(AxisDevice):
    """One stepper axis with inputs 1 to 3 wired to origin, positive and negative limit."""

    @property
    def writable(self) -> Collection[int]:
        """Return the registers that may be written."""
        inputs = (INPUT_1 + 2 * place for place in range(INPUT_COUNT))
        path = range(PATH, PATH + PATH_WORDS)
        return {PULSES, DIRECTION, ENABLE, PEAK_CURRENT, CONTROL, TRIGGER, *inputs, *path}

    def power_up(self) -> None:
        """Begin disabled, with the inputs set as the connection page says."""
        for address in self.writable:
            self.put(address, 0)
        self.put(PULSES, 10000)
        for place, function in enumerate((ORIGIN, POSITIVE_LIMIT, NEGATIVE_LIMIT)):
            self.put(INPUT_1 + 2 * place, function)

    def refresh(self, feedback: AxisFeedback, fault_code: int) -> None:
        """Show motion status, position, speed, inputs and alarm."""
        flags = {
            0: fault_code != 0,
            1: self.word(ENABLE) == 1 and not fault_code,
            2: feedback.moving,
            4: not feedback.moving,
            5: not feedback.moving,
            6: feedback.homed and not self.homing,
        }
        self.put(STATUS, sum(1 << bit for bit, is_on in flags.items() if is_on))
        for address in (COMMAND_POSITION, POSITION):
            self.put_wide(address, self.steps(feedback.position_deg))
        speed_rpm = feedback.velocity_dps / self._dps_per_rpm
        for address in (COMMAND_SPEED, SPEED):
            self.put(address, round(speed_rpm))
        self.put(ALARM, fault_code)
        self.put(INPUTS, self._inputs(feedback))

    def act(self, written: Collection[int]) -> None:
        """Follow the trigger, its copy behind path 0, and the control word."""
        if CONTROL in written and self.word(CONTROL) == RESET_ALARM:
            self.machine.reset_fault()
        if ENABLE in written and self.word(ENABLE) != 1:
            self.halt()
        for address in (TRIGGER, PATH_TRIGGER):
            if address in written:
                self._trigger(self.word(address))

    def _trigger(self, command: int) -> None:
        if command == STOP:
            self.halt()
        elif self.word(ENABLE) != 1 and command != SET_HOME:
            return
        elif command == RUN_PATH_0:
            self._run()
        elif command == HOME:
            self.seek_origin()
        elif command == SET_HOME:
            self.machine.set_home(self.axis)

    def _run(self) -> None:
        speed_dps = self.signed(PATH_SPEED) * self._dps_per_rpm
        target_deg = self.wide(PATH_POSITION) / self.steps_per_deg
        self.homing = False
        match self.word(PATH_MODE):
            case mode if mode == ABSOLUTE:
                self.machine.turn(self.axis, Position(target_deg, speed_dps))
            case mode if mode == RELATIVE:
                self.machine.turn(self.axis, Position(self.feedback.position_deg + target_deg, speed_dps))
            case mode if mode == TURN:
                self.machine.turn(self.axis, Velocity(speed_dps))

    @property
    def _dps_per_rpm(self) -> float:
        return self.word(PULSES) / 60.0 / self.steps_per_deg

    def _inputs(self, feedback: AxisFeedback) -> int:
        on = {
            ORIGIN: feedback.at_origin,
            POSITIVE_LIMIT: feedback.at_upper_limit,
            NEGATIVE_LIMIT: feedback.at_lower_limit,
        }
        functions = (self.word(INPUT_1 + 2 * place) for place in range(INPUT_COUNT))
        return sum(1 << place for place, function in enumerate(functions) if on.get(function, False))
