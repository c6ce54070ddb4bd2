"""Can a position be true? Modbus TCP carries no checksum: damage shows only in what a value says."""

from collections.abc import Mapping
from datetime import datetime

from app.base.clock import Clock
from app.base.message import say, with_format
from app.drives.register import Register
from app.modbus.errors import DriveError
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.motion import AxisFeedback, Feedback

FASTER_THAN_RATED = 1.5
NOISE_DEG = 0.5


class Plausibility:
    """Holds a reading against the last good one: range, and how far an axis can have turned since.

    A doubtful reading is read again. Two that agree are the drive's own word, and what it means is for the
    controller to judge; two that do not are damage on the way.
    """

    def __init__(self, config: TrackerConfig, clock: Clock, registers: Mapping[Axis, Register]) -> None:
        self._config = config
        self._registers = registers
        self._clock = clock
        self._last: tuple[Feedback, datetime] | None = None

    def doubt(self, feedback: Feedback) -> str | None:
        """Return why a reading cannot be true, None if it can."""
        outside = self._out_of_range(feedback)
        if outside is not None or self._last is None:
            return outside
        last, at = self._last
        if _zero_may_have_changed(last, feedback):
            return None
        return self._too_far(last, feedback, (self._clock.now() - at).total_seconds())

    def settle(self, first: Feedback, second: Feedback) -> Feedback:
        """Return the second reading if it is good or agrees with the first, else raise `DriveError`."""
        doubt = self.doubt(second)
        agree = self._out_of_range(second) is None and self._too_far(first, second, 0.0) is None
        if doubt is not None and not agree:
            raise DriveError(
                say("{doubt} The reading was rejected. Check the encoder and network.", doubt=doubt)
            )
        return second

    def accept(self, feedback: Feedback) -> None:
        """Take this reading as the one that the next is held against."""
        self._last = feedback, self._clock.now()

    def _out_of_range(self, feedback: Feedback) -> str | None:
        for axis, register in self._registers.items():
            position_deg = _of(feedback, axis).position_deg
            if not register.is_plausible(position_deg):
                return say(
                    "The drive reports {axis} {position_deg} degrees, outside the profile's range of "
                    "{minimum} to {maximum}.",
                    axis=axis,
                    position_deg=with_format(position_deg, "g"),
                    minimum=with_format(register.minimum, "g"),
                    maximum=with_format(register.maximum, "g"),
                )
        return None

    def _too_far(self, last: Feedback, feedback: Feedback, elapsed_s: float) -> str | None:
        for axis in Axis:
            way_deg = abs(_of(feedback, axis).position_deg - _of(last, axis).position_deg)
            reach_deg = self._config.axis(axis).speed_dps * FASTER_THAN_RATED * elapsed_s + NOISE_DEG
            if way_deg > reach_deg:
                return say(
                    "The drive reports that {axis} moved by {way_deg} degrees in {elapsed_s} s, faster "
                    "than it can turn.",
                    axis=axis,
                    way_deg=with_format(way_deg, ".2f"),
                    elapsed_s=with_format(elapsed_s, ".2f"),
                )
        return None


def _zero_may_have_changed(last: Feedback, feedback: Feedback) -> bool:
    return _life(last) != _life(feedback)


def _life(feedback: Feedback) -> tuple[int, int, bool, bool]:
    return feedback.request_done, feedback.boot_count, feedback.azimuth.homed, feedback.elevation.homed


def _of(feedback: Feedback, axis: Axis) -> AxisFeedback:
    return feedback.azimuth if axis is Axis.AZIMUTH else feedback.elevation
