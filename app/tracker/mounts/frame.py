"""The frame of a mount's first axis: directions of the sky as angles about it, and back.

As in pvlib's `tracking.singleaxis` (K. Anderson and M. Mikofski, doi:10.2172/1660126): y' lies along the axis
and dips by its tilt, x' is level and to the right of y', z' is square to both and points upwards. Rotation is
zero in z' and grows towards x'; the second angle is the one above the plane of x' and z', away from y'.
"""

from math import cos, radians, sin

from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, T, Trigonometry
from app.tracker.settings.config import MountConfig, MountKind

VERTICAL_TILT_DEG = 90.0


def axis_tilt_deg(mount: MountConfig) -> float:
    """Return by how much the first axis dips towards its azimuth."""
    match mount.kind:
        case MountKind.HORIZONTAL_SINGLE_AXIS:
            return 0.0
        case MountKind.VERTICAL_SINGLE_AXIS:
            return VERTICAL_TILT_DEG
        case _:
            return mount.axis_tilt_deg


def hand(mount: MountConfig) -> float:
    """Return 1, or -1 for an equatorial mount whose axis dips to the north.

    Its hour angle grows westwards and its declination northwards on both halves of the globe.
    """
    northern = cos(radians(mount.axis_azimuth_deg)) > 0.0
    return -1.0 if mount.kind is MountKind.EQUATORIAL and northern else 1.0


def into(mount: MountConfig, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return rotation, in (-180, 180], and the angle above its plane, degrees, of a direction of the sky."""
    azimuth, elevation = azimuth_deg * PER_DEGREE, elevation_deg * PER_DEGREE
    level = trig.cos(elevation)
    east, north, up = level * trig.sin(azimuth), level * trig.cos(azimuth), trig.sin(elevation)
    cos_a, sin_a, cos_t, sin_t = _constants(mount)
    x = east * cos_a - north * sin_a
    dip = east * sin_a + north * cos_a
    y, z = dip * cos_t - up * sin_t, dip * sin_t + up * cos_t
    sign = hand(mount)
    rotation_deg = sign * (trig.atan2(x, z) * PER_RADIAN)
    return rotation_deg, sign * (trig.atan2(-y, trig.hypot(x, z)) * PER_RADIAN)


def out_of(mount: MountConfig, rotation_deg: T, above_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth, in (-180, 180], and elevation, degrees: the inverse of `into`."""
    sign = hand(mount)
    rotation, above = rotation_deg * (sign * PER_DEGREE), above_deg * (sign * PER_DEGREE)
    plane = trig.cos(above)
    x, y, z = plane * trig.sin(rotation), -trig.sin(above), plane * trig.cos(rotation)
    cos_a, sin_a, cos_t, sin_t = _constants(mount)
    dip, up = y * cos_t + z * sin_t, z * cos_t - y * sin_t
    east, north = x * cos_a + dip * sin_a, dip * cos_a - x * sin_a
    return trig.atan2(east, north) * PER_RADIAN, trig.atan2(up, trig.hypot(east, north)) * PER_RADIAN


def _constants(mount: MountConfig) -> tuple[float, float, float, float]:
    azimuth, tilt = radians(mount.axis_azimuth_deg), radians(axis_tilt_deg(mount))
    return cos(azimuth), sin(azimuth), cos(tilt), sin(tilt)
