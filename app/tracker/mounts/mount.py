"""From a direction of the sky to axis angles within limits, and back, for every mount."""

from math import ceil, cos, radians, sin
from typing import NamedTuple

from app.base.angles import wrap180, wrap360
from app.sun.position import SunPosition
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, SCALAR, T, Trigonometry
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.kinematics import angles, direction, followed
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, TrackerConfig
from app.tracker.values.mode import Mode

PLAIN = MountConfig()
UNLIMITED = AxisConfig(-360.0, 360.0, 360.0, 360.0, 1.0, 1.0)


class AxisTarget(NamedTuple):
    """Angles of first and second axis to go to; `limited`: the soft limits forbid the direction asked for."""

    azimuth_deg: float
    elevation_deg: float
    limited: bool


def aim(
    config: TrackerConfig, pointing: Pointing, wanted: Orientation, near_azimuth_deg: float
) -> AxisTarget:
    """Return axis angles, degrees, at which the panel faces a direction of the sky as nearly as it can.

    Of the equivalent angles (+-360 degrees) of the first axis inside the soft limits the nearest to
    `near_azimuth_deg`; where none is inside, the nearest reachable angles, each axis for itself.
    """
    first_deg, second_deg = to_axes(config.mount, pointing, wanted.azimuth_deg, wanted.elevation_deg, SCALAR)
    first_reached_deg, reachable = _within(config.azimuth, first_deg, near_azimuth_deg)
    second_reached_deg = second_axis(config).clamp(second_deg)
    return AxisTarget(
        first_reached_deg, second_reached_deg, not reachable or second_reached_deg != second_deg
    )


def sky(
    config: TrackerConfig, pointing: Pointing, azimuth_axis_deg: float, elevation_axis_deg: float
) -> Orientation:
    """Return the direction of the sky that the panel faces at these axis angles: the inverse of `aim`.

    Azimuth in [0, 360); an axis elevation beyond 90 degrees faces the opposite azimuth.
    """
    first_deg = azimuth_axis_deg - pointing.azimuth_offset_deg
    second_deg = elevation_axis_deg - pointing.elevation_offset_deg
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return _sky_of_mast(pointing, first_deg, second_deg)
    azimuth_deg, elevation_deg = direction(config.mount, first_deg, second_deg, SCALAR)
    return Orientation(wrap360(azimuth_deg), elevation_deg)


def to_axes(
    mount: MountConfig, pointing: Pointing, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]
) -> tuple[T, T]:
    """Return angles of first and second axis, degrees, for sky angles, without limits.

    Offsets are added on every mount; only on an azimuth-elevation mount a mast leans.
    """
    first_deg, second_deg = azimuth_deg, elevation_deg
    if mount.kind is not MountKind.AZIMUTH_ELEVATION:
        first_deg, second_deg = angles(mount, azimuth_deg, elevation_deg, trig)
        if mount.single_axis:
            return first_deg + pointing.azimuth_offset_deg, second_deg
    elif pointing.lean_north_deg or pointing.lean_east_deg:
        first_deg, second_deg = _leaning(pointing, azimuth_deg, elevation_deg, trig)
    return first_deg + pointing.azimuth_offset_deg, second_deg + pointing.elevation_offset_deg


def second_axis(config: TrackerConfig) -> AxisConfig:
    """Return limits and speeds of the second axis; where the mount has none, it stands for a fixed angle."""
    return UNLIMITED if config.mount.single_axis else config.elevation


def _sky_of_mast(pointing: Pointing, azimuth_deg: float, elevation_deg: float) -> Orientation:
    if elevation_deg > 90.0:
        azimuth_deg, elevation_deg = azimuth_deg + 180.0, 180.0 - elevation_deg
    if pointing.lean_north_deg or pointing.lean_east_deg:
        azimuth_deg, elevation_deg = _upright(pointing, azimuth_deg, elevation_deg)
    return Orientation(wrap360(azimuth_deg), elevation_deg)


def _leaning(pointing: Pointing, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Turn a direction into the frame of a mast that leans first north, then east.

    An elevation beyond 90 degrees stays beyond it, so that the azimuth axis does not turn over.
    """
    azimuth, elevation = azimuth_deg * PER_DEGREE, elevation_deg * PER_DEGREE
    level = trig.cos(elevation)
    side = level / trig.hypot(level, 0.0 * level)
    north, east = level * trig.cos(azimuth), level * trig.sin(azimuth)
    north, up = _turn(north, trig.sin(elevation), pointing.lean_north_deg)
    east, up = _turn(east, up, pointing.lean_east_deg)
    leaning_deg = trig.atan2(up, side * trig.hypot(north, east)) * PER_RADIAN
    return trig.atan2(side * east, side * north) * PER_RADIAN, leaning_deg


def _upright(pointing: Pointing, azimuth_deg: float, elevation_deg: float) -> tuple[float, float]:
    """Undo `_leaning`."""
    azimuth, elevation = radians(azimuth_deg), radians(elevation_deg)
    north, east = cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth)
    east, up = _turn(east, sin(elevation), -pointing.lean_east_deg)
    north, up = _turn(north, up, -pointing.lean_north_deg)
    level = SCALAR.hypot(north, east)
    return SCALAR.atan2(east, north) * PER_RADIAN, SCALAR.atan2(up, level) * PER_RADIAN


def _turn(level: T, up: T, lean_deg: float) -> tuple[T, T]:
    lean = radians(lean_deg)
    return level * cos(lean) - up * sin(lean), up * cos(lean) + level * sin(lean)


def _within(axis: AxisConfig, azimuth_deg: float, near_deg: float) -> tuple[float, bool]:
    """Return the equivalent angle inside the soft limits nearest to `near_deg`, and whether there is one."""
    angle_deg = azimuth_deg + 360.0 * round((near_deg - azimuth_deg) / 360.0)
    if angle_deg < axis.minimum_deg:
        angle_deg += 360.0 * ceil((axis.minimum_deg - angle_deg) / 360.0)
    elif angle_deg > axis.maximum_deg:
        angle_deg -= 360.0 * ceil((angle_deg - axis.maximum_deg) / 360.0)
    if axis.contains(angle_deg):
        return angle_deg, True
    ends = (axis.minimum_deg, axis.maximum_deg)
    return min(ends, key=lambda end: (abs(wrap180(azimuth_deg - end)), abs(end - near_deg))), False


def mode_direction(
    mode: Mode, held: Orientation, sun: SunPosition, *, refraction: bool, mount: MountConfig = PLAIN
) -> Orientation:
    """Return where the panel should face in a mode, soft limits aside.

    That is the sun's angle on each axis that follows, else the held one's; a single axis faces the sun as
    nearly as it can, or backtracks. Elevation is the apparent one if `refraction`. With `least_incidence` it
    may pass 90 degrees, over the top to the other side.
    """
    height_deg = sun.apparent_elevation_deg if refraction else sun.elevation_deg
    if mount.kind is MountKind.AZIMUTH_ELEVATION and mode is Mode.DUAL:
        return Orientation(sun.azimuth_deg, height_deg)
    place = (held.azimuth_deg, held.elevation_deg)
    faced = direction(mount, *followed(mount, mode, place, (sun.azimuth_deg, height_deg), SCALAR), SCALAR)
    return Orientation(wrap360(faced[0]), faced[1])


def upright(wanted: Orientation | None) -> Orientation | None:
    """Return the same direction with an elevation of at most 90 degrees."""
    if wanted is None or wanted.elevation_deg <= 90.0:
        return wanted
    return Orientation(wrap360(wanted.azimuth_deg + 180.0), 180.0 - wanted.elevation_deg)
