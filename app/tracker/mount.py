"""The azimuth-elevation mount: from a direction of the sky to axis angles within limits, and back."""

from dataclasses import dataclass
from math import ceil, cos, radians, sin
from typing import assert_never

from app.angles import separation_deg, wrap180, wrap360
from app.sun.position import SunPosition
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, SCALAR, T, Trigonometry
from app.tracker.axes import AxisConfig
from app.tracker.config import Orientation, TrackerConfig
from app.tracker.memory import Pointing
from app.tracker.mode import Mode


@dataclass(frozen=True, slots=True)
class AxisTarget:
    """Axis angles to go to; `limited` says that the soft limits forbid the direction asked for."""

    azimuth_deg: float
    elevation_deg: float
    limited: bool


def aim(
    config: TrackerConfig, pointing: Pointing, direction: Orientation, near_azimuth_deg: float
) -> AxisTarget:
    """Return axis angles, degrees, at which the panel faces a direction of the sky.

    Of the equivalent azimuths (+-360 degrees) inside the soft limits the nearest to `near_azimuth_deg`; where
    none is inside, the nearest reachable angles.
    """
    azimuth_deg, elevation_deg = to_axes(pointing, direction.azimuth_deg, direction.elevation_deg, SCALAR)
    azimuth_reached_deg, reachable = _within(config.azimuth, azimuth_deg, near_azimuth_deg)
    elevation_reached_deg = config.elevation.clamp(elevation_deg)
    limited = not reachable or elevation_reached_deg != elevation_deg
    return AxisTarget(azimuth_reached_deg, elevation_reached_deg, limited)


def sky(
    config: TrackerConfig, pointing: Pointing, azimuth_axis_deg: float, elevation_axis_deg: float
) -> Orientation:
    """Return the direction of the sky that the panel faces at these axis angles: the inverse of `aim`.

    Azimuth in [0, 360); an axis elevation beyond 90 degrees faces the opposite azimuth.
    """
    azimuth_deg = azimuth_axis_deg - pointing.azimuth_offset_deg
    elevation_deg = elevation_axis_deg - pointing.elevation_offset_deg
    if elevation_deg > 90.0:
        azimuth_deg, elevation_deg = azimuth_deg + 180.0, 180.0 - elevation_deg
    if pointing.lean_north_deg or pointing.lean_east_deg:
        azimuth_deg, elevation_deg = _upright(pointing, azimuth_deg, elevation_deg)
    return Orientation(wrap360(azimuth_deg), elevation_deg)


def to_axes(pointing: Pointing, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return axis angles, degrees, for sky angles: the mast's lean taken out, offsets added, no limits."""
    if pointing.lean_north_deg or pointing.lean_east_deg:
        azimuth_deg, elevation_deg = _leaning(pointing, azimuth_deg, elevation_deg, trig)
    return azimuth_deg + pointing.azimuth_offset_deg, elevation_deg + pointing.elevation_offset_deg


def _leaning(pointing: Pointing, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Turn a direction into the frame of a mast that leans first north, then east."""
    azimuth, elevation = azimuth_deg * PER_DEGREE, elevation_deg * PER_DEGREE
    north, east = trig.cos(elevation) * trig.cos(azimuth), trig.cos(elevation) * trig.sin(azimuth)
    north, up = _turn(north, trig.sin(elevation), pointing.lean_north_deg)
    east, up = _turn(east, up, pointing.lean_east_deg)
    return trig.atan2(east, north) * PER_RADIAN, trig.atan2(up, trig.hypot(north, east)) * PER_RADIAN


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


def mode_direction(mode: Mode, held: Orientation, sun: SunPosition, *, refraction: bool) -> Orientation:
    """Return where the panel should face in a mode: the sun's angle on each axis that follows, else the held.

    Elevation is the apparent one if `refraction`.
    """
    elevation_deg = sun.apparent_elevation_deg if refraction else sun.elevation_deg
    match mode:
        case Mode.FIXED:
            return held
        case Mode.AZIMUTH:
            return Orientation(sun.azimuth_deg, held.elevation_deg)
        case Mode.ELEVATION:
            return Orientation(held.azimuth_deg, elevation_deg)
        case Mode.DUAL:
            return Orientation(sun.azimuth_deg, elevation_deg)
    assert_never(mode)


def needs_move(
    config: TrackerConfig, measured: Orientation, target: Orientation, deadband_deg: float | None = None
) -> bool:
    """Return whether the panel is off its target by more than the deadband, judged on the sphere.

    There an azimuth error counts times the cosine of the elevation: near the zenith, where the sun's azimuth
    races, the axis does not turn for nothing. Without `deadband_deg` the tracker's own deadband counts.
    """
    allowed_deg = config.deadband_deg if deadband_deg is None else deadband_deg
    off_deg = separation_deg(
        measured.azimuth_deg, measured.elevation_deg, target.azimuth_deg, target.elevation_deg
    )
    return off_deg > allowed_deg
