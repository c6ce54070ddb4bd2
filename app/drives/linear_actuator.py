"""A drive that counts the millimetres of linear actuators, seen in degrees of the axes.

The drive's own zero is where the axis stands at zero degrees. The speed of an axis is turned into one of the
actuator at the angle that was read last, and written again at every tick.
"""

from dataclasses import replace
from datetime import datetime
from typing import assert_never

from app.base.message import join, say
from app.drives.drive import Drive, answers_at_once, check_fit, line_turn
from app.modbus.line_turn import LineTurn
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.transmission import LinearActuator
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

READING_DIGITS = 9
"""Readings are rounded to 1e-9 degrees, far below any encoder, so that an axis at its zero reads zero."""


class TransmittedDrive:
    """A drive whose actuated axes appear in degrees; the others are passed on as they are."""

    def __init__(self, inner: Drive, config: TrackerConfig) -> None:
        self._inner = inner
        self._actuators = {axis: config.axis(axis).actuator for axis in Axis}
        self._angles_deg = dict.fromkeys(Axis, 0.0)

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
        can = self._inner.capabilities
        moved = [axis.value for axis, actuator in self._actuators.items() if actuator is not None]
        return replace(
            can,
            description=say(
                "{description} Linear actuators: {moved}.",
                description=can.description,
                moved=join(" and ", moved),
            ),
        )

    def check_fit(self) -> None:
        """Try the numbers of the drive behind this one, whose limits and speeds are in its own units."""
        check_fit(self._inner)

    async def read(self) -> Feedback:
        """Return a fresh reading in axis degrees, or raise `DriveError`."""
        seen = await self._inner.read()
        return replace(
            seen,
            azimuth=self._turned(Axis.AZIMUTH, seen.azimuth),
            elevation=self._turned(Axis.ELEVATION, seen.elevation),
        )

    async def write(self, command: DriveCommand) -> None:
        """Make the actuators do this from now on and feed the watchdog, or raise `DriveError`."""
        driven = replace(
            command,
            azimuth=self._driven(Axis.AZIMUTH, command.azimuth),
            elevation=self._driven(Axis.ELEVATION, command.elevation),
        )
        await self._inner.write(driven)

    async def stop(self) -> None:
        """Ramp both axes down at once, or raise `DriveError`."""
        await self._inner.stop()

    async def set_clock(self, at: datetime) -> None:
        """Set the drive's own clock."""
        await self._inner.set_clock(at)

    async def close(self) -> None:
        """Let go of the connection; the axes are stopped first if that is possible."""
        await self._inner.close()

    def _turned(self, axis: Axis, seen: AxisFeedback) -> AxisFeedback:
        """Return a reading of an actuator as one of its axis."""
        actuator = self._actuators[axis]
        if actuator is None:
            return seen
        angle_deg = round(actuator.angle_deg(seen.position_deg + actuator.stroke_mm(0.0)), READING_DIGITS)
        self._angles_deg[axis] = angle_deg
        slope = actuator.mm_per_deg(angle_deg)
        lower, upper = seen.at_lower_limit, seen.at_upper_limit
        return replace(
            seen,
            position_deg=angle_deg + 0.0,
            velocity_dps=seen.velocity_dps / slope + 0.0,
            at_lower_limit=lower if slope > 0.0 else upper,
            at_upper_limit=upper if slope > 0.0 else lower,
        )

    def _driven(self, axis: Axis, command: AxisCommand) -> AxisCommand:
        """Return a command for an axis as one for its actuator."""
        actuator = self._actuators[axis]
        if actuator is None:
            return command
        slope = actuator.mm_per_deg(self._angles_deg[axis])
        match command:
            case Halt():
                return command
            case Velocity():
                return Velocity(command.velocity_dps * slope)
            case Position():
                return Position(counted_mm(actuator, command.position_deg), command.speed_dps * abs(slope))
        assert_never(command)


def counted_mm(actuator: LinearActuator, angle_deg: float) -> float:
    """Return what the drive counts at an axis angle: the stroke from where the axis stands at zero."""
    return actuator.stroke_mm(angle_deg) - actuator.stroke_mm(0.0)


def in_millimetres(config: TrackerConfig) -> TrackerConfig:
    """Return the configuration of the drive that turns the actuators: in millimetres where there is one."""
    return replace(config, azimuth=_driven_axis(config.azimuth), elevation=_driven_axis(config.elevation))


def has_actuators(config: TrackerConfig) -> bool:
    """Return whether an axis is turned by a linear actuator."""
    return any(config.axis(axis).actuator is not None for axis in Axis)


def _driven_axis(axis: AxisConfig) -> AxisConfig:
    """Return limits and speeds of an actuator; it gathers speed at least as fast as the axis should."""
    actuator = axis.actuator
    if actuator is None:
        return axis
    ends_mm = [counted_mm(actuator, angle_deg) for angle_deg in (axis.minimum_deg, axis.maximum_deg)]
    steepest = actuator.speed_mm_s / actuator.slowest_dps(axis.minimum_deg, axis.maximum_deg)
    return AxisConfig(
        minimum_deg=min(ends_mm),
        maximum_deg=max(ends_mm),
        speed_dps=actuator.speed_mm_s,
        acceleration_dps2=axis.acceleration_dps2 * steepest,
        jog_slow_dps=min(axis.jog_slow_dps * steepest, actuator.speed_mm_s),
        jog_fast_dps=min(axis.jog_fast_dps * steepest, actuator.speed_mm_s),
    )
