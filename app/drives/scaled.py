"""A drive that counts degrees itself, turned round and stretched to the degrees of the axis.

Drives that count motor steps are corrected where steps become degrees (`app.drives.dialects.gearing`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from typing import assert_never

from app.base.message import say, with_format
from app.drives.drive import Drive, answers_at_once, check_fit, line_turn
from app.modbus.line_turn import LineTurn
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import AxisDrive, TrackerConfig
from app.tracker.values.motion import (
    AxisCommand,
    AxisFeedback,
    DriveCapabilities,
    DriveCommand,
    Feedback,
    Halt,
    Position,
    Velocity,
)

LARGEST_RATIO = 2.0


@dataclass(frozen=True, slots=True)
class Stretch:
    """Degrees of the drive for one of the axis, signed: negative where the drive turns the other way."""

    factor: float

    def command(self, told: AxisCommand) -> AxisCommand:
        """Return a command of the axis as one of the drive."""
        match told:
            case Halt():
                return told
            case Velocity():
                return Velocity(told.velocity_dps * self.factor)
            case Position():
                return Position(told.position_deg * self.factor, told.speed_dps * abs(self.factor))
        assert_never(told)

    def feedback(self, seen: AxisFeedback) -> AxisFeedback:
        """Return a reading of the drive as one of the axis; turned round, its ends change places."""
        turned = replace(
            seen,
            position_deg=seen.position_deg / self.factor + 0.0,
            velocity_dps=seen.velocity_dps / self.factor + 0.0,
        )
        if self.factor > 0.0:
            return turned
        return replace(turned, at_lower_limit=seen.at_upper_limit, at_upper_limit=seen.at_lower_limit)

    def settings(self, axis: AxisConfig) -> AxisConfig:
        """Return limits and speeds of the axis in the drive's degrees."""
        ends = sorted((axis.minimum_deg * self.factor, axis.maximum_deg * self.factor))
        size = abs(self.factor)
        return replace(
            axis,
            minimum_deg=ends[0],
            maximum_deg=ends[1],
            speed_dps=axis.speed_dps * size,
            acceleration_dps2=axis.acceleration_dps2 * size,
            jog_slow_dps=axis.jog_slow_dps * size,
            jog_fast_dps=axis.jog_fast_dps * size,
        )


class CorrectedDrive:
    """The drive protocol in degrees of the axes, on a drive that speaks its own."""

    def __init__(self, inner: Drive, azimuth: Stretch, elevation: Stretch) -> None:
        self._inner = inner
        self._azimuth = azimuth
        self._elevation = elevation

    @property
    def inner(self) -> Drive:
        """Return the drive behind this one."""
        return self._inner

    @property
    def answers_at_once(self) -> bool:
        """Return whether the drive behind this one never waits."""
        return answers_at_once(self._inner)

    @property
    def line_turn(self) -> LineTurn | None:
        """Return how the drive behind this one shares its line."""
        return line_turn(self._inner)

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return what the drive can do."""
        return self._inner.capabilities

    def check_fit(self) -> None:
        """Try the numbers of the drive behind this one, whose limits and speeds are in its own units."""
        check_fit(self._inner)

    async def read(self) -> Feedback:
        """Return a fresh reading, or raise `DriveError`."""
        seen = await self._inner.read()
        azimuth, elevation = self._azimuth.feedback(seen.azimuth), self._elevation.feedback(seen.elevation)
        return replace(seen, azimuth=azimuth, elevation=elevation)

    async def write(self, command: DriveCommand) -> None:
        """Make the axes do this from now on and feed the watchdog, or raise `DriveError`."""
        azimuth = self._azimuth.command(command.azimuth)
        elevation = self._elevation.command(command.elevation)
        await self._inner.write(DriveCommand(azimuth, elevation, command.request, command.horn))

    async def stop(self) -> None:
        """Ramp both axes down at once, or raise `DriveError`."""
        await self._inner.stop()

    async def set_clock(self, at: datetime) -> None:
        """Set the drive's own clock where it has one."""
        await self._inner.set_clock(at)

    async def close(self) -> None:
        """Let go of the connection."""
        await self._inner.close()


def corrected(config: TrackerConfig, make: Callable[[TrackerConfig], Drive]) -> Drive:
    """Return the drive that `make` makes, in degrees of the axes; as it is where nothing is to be corrected.

    Raises `ValueError` for a gear ratio that cannot be one of a drive that counts degrees.
    """
    azimuth, elevation = (_stretch(config.drive.axis(axis)) for axis in Axis)
    if azimuth.factor == elevation.factor == 1.0:
        return make(config)
    own = replace(
        config, azimuth=azimuth.settings(config.azimuth), elevation=elevation.settings(config.elevation)
    )
    return CorrectedDrive(make(own), azimuth, elevation)


def check_ratio(gear_ratio: float) -> None:
    """Raise `ValueError` if a drive that counts degrees of the axis cannot be off by this much."""
    if not 1.0 / LARGEST_RATIO <= gear_ratio <= LARGEST_RATIO:
        raise ValueError(
            say(
                "A gear ratio of {gear_ratio} does not fit this drive: it counts degrees of the "
                "axis, so the ratio is near 1. Measure again, or choose the profile of a drive that "
                "counts steps.",
                gear_ratio=with_format(gear_ratio, "g"),
            )
        )


def _stretch(axis: AxisDrive) -> Stretch:
    check_ratio(axis.gear_ratio)
    return Stretch(-axis.gear_ratio if axis.inverted else axis.gear_ratio)
