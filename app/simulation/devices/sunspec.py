"""Another tracker controller: a SunSpec device with models 1 and 601 and one tracker.

Source: SunSpec Alliance model definitions 1 and 601 (draft 2). In automatic control it stands still, in
manual control it goes to its targets, calibration searches the origin of both axes and ends in automatic.
Azimuth is 0 to 360 degrees from true north; it goes the shorter way.
"""

from collections.abc import Collection

from app.base.angles import wrap180, wrap360
from app.base.clock import Clock
from app.simulation.devices.axis_device import AxisDevice
from app.simulation.simulated_machine import SimulatedMachine
from app.tracker.settings.axes import Axis
from app.tracker.values.motion import HALT, AxisFeedback, Position

BASE = 40000
COMMON_LENGTH, TRACKER_LENGTH, CONTROLLER_LENGTH = 66, 22, 26
COMMON = BASE + 2
CONTROLLER = COMMON + 2 + COMMON_LENGTH
TYPE, ALARMS, SCALE, COUNT = CONTROLLER + 10, CONTROLLER + 25, CONTROLLER + 26, CONTROLLER + 27
TRACKER = CONTROLLER + 2 + CONTROLLER_LENGTH
ELEVATION_TARGET, AZIMUTH_TARGET = TRACKER + 8, TRACKER + 10
ELEVATION_POSITION, AZIMUTH_POSITION = TRACKER + 12, TRACKER + 14
ELEVATION_MANUAL, AZIMUTH_MANUAL, CONTROL, TRACKER_ALARMS = (
    TRACKER + 16,
    TRACKER + 18,
    TRACKER + 20,
    TRACKER + 21,
)
END = TRACKER + TRACKER_LENGTH
DUAL_AXIS, END_MODEL = 5, 0xFFFF
NOT_IMPLEMENTED_WIDE, NOT_IMPLEMENTED = -0x8000_0000, 0xFFFF
AUTOMATIC, MANUAL, CALIBRATE = 0, 1, 2
STEP_POWER = -3
SPEED = {Axis.AZIMUTH: 6.0, Axis.ELEVATION: 4.0}


class SunSpecTracker(AxisDevice):
    """Both axes of one tracker in one device, in thousandths of a degree."""

    def __init__(self, machine: SimulatedMachine, clock: Clock) -> None:
        super().__init__(machine, Axis.AZIMUTH, clock, 10.0**-STEP_POWER)

    @property
    def writable(self) -> Collection[int]:
        """Return the points that may be written."""
        return range(ELEVATION_MANUAL, CONTROL + 1)

    def power_up(self) -> None:
        """Lay the models out; it begins in automatic control."""
        for address in range(BASE, END + 2):
            self.put(address, 0)
        for address, word in (
            (BASE, 0x5375), (BASE + 1, 0x6E53), (COMMON, 1), (COMMON + 1, COMMON_LENGTH), (CONTROLLER, 601),
            (CONTROLLER + 1, CONTROLLER_LENGTH + TRACKER_LENGTH), (TYPE, DUAL_AXIS), (SCALE, STEP_POWER),
            (COUNT, 1), (END, END_MODEL),
        ):  # fmt: skip
            self.put(address, word)
        self._text(COMMON + 2, "Heliopanel")
        self._text(COMMON + 18, "Simulated tracker")
        for address in (CONTROLLER + 20, CONTROLLER + 22, ELEVATION_TARGET, AZIMUTH_TARGET):
            self.put_wide(address, NOT_IMPLEMENTED_WIDE)
        self.put(CONTROLLER + 24, NOT_IMPLEMENTED)

    def refresh(self, feedback: AxisFeedback, fault_code: int) -> None:
        """Show both positions and the alarms; calibration that has ended goes back to automatic."""
        observed = self.machine.observe()
        if self.word(CONTROL) == CALIBRATE and not (observed.azimuth.moving or observed.elevation.moving):
            self._end_calibration()
            observed = self.machine.observe()
        self.put_wide(AZIMUTH_POSITION, self.steps(wrap360(observed.azimuth.position_deg)))
        self.put_wide(ELEVATION_POSITION, self.steps(observed.elevation.position_deg))
        self.put(TRACKER_ALARMS, 1 if fault_code else 0)

    def act(self, written: Collection[int]) -> None:
        """Do what the control register says, with the targets as they are."""
        match self.word(CONTROL):
            case mode if mode == MANUAL:
                for axis, address in ((Axis.AZIMUTH, AZIMUTH_MANUAL), (Axis.ELEVATION, ELEVATION_MANUAL)):
                    target_deg = self.wide(address) / self.steps_per_deg
                    if axis is Axis.AZIMUTH:
                        here_deg = self.machine.observe().azimuth.position_deg
                        target_deg = here_deg + wrap180(target_deg - here_deg)
                    self.machine.turn(axis, Position(target_deg, SPEED[axis]))
            case mode if mode == CALIBRATE:
                for axis in Axis:
                    self.machine.seek_origin(axis)
            case _:
                for axis in Axis:
                    self.machine.turn(axis, HALT)

    def _end_calibration(self) -> None:
        observed = self.machine.observe()
        for axis, feedback in ((Axis.AZIMUTH, observed.azimuth), (Axis.ELEVATION, observed.elevation)):
            if feedback.at_origin:
                self.machine.set_home(axis)
        self.put(CONTROL, AUTOMATIC)

    def _text(self, address: int, text: str) -> None:
        raw = text.encode().ljust(32, b"\0")
        for place in range(16):
            self.put(address + place, int.from_bytes(raw[2 * place : 2 * place + 2], "big"))
