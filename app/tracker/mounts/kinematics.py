"""Forward and inverse kinematics of every mount, for one direction or for arrays of them.

First and second angle are longitude and latitude about the first axis, so that the distance of two directions
is the same on this sphere as in the sky: azimuth and elevation, hour angle (west positive) and declination
(north positive), or the rotation about a single axis and the fixed angle at which the panel hangs on it.
"""

from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, T, Trigonometry
from app.tracker.mounts.backtracking import backtracked_deg
from app.tracker.mounts.frame import into, out_of
from app.tracker.settings.config import MountConfig, MountKind
from app.tracker.values.mode import Mode

FIRST_FOLLOWS = frozenset({Mode.AZIMUTH, Mode.DUAL})
SECOND_FOLLOWS = frozenset({Mode.ELEVATION, Mode.DUAL})


def angles(mount: MountConfig, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return first and second angle, degrees, for a direction of the sky, without limits or correction.

    A single axis turns to the least angle of incidence; its second angle is the fixed one.
    """
    if mount.kind is MountKind.AZIMUTH_ELEVATION:
        return azimuth_deg, elevation_deg
    first_deg, second_deg = into(mount, azimuth_deg, elevation_deg, trig)
    if mount.single_axis:
        return first_deg, 0.0 * second_deg + fixed_deg(mount)
    return first_deg, second_deg


def direction(mount: MountConfig, first_deg: T, second_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth and elevation, degrees, that the panel faces: the inverse of `angles`, not wrapped."""
    if mount.kind is MountKind.AZIMUTH_ELEVATION:
        return first_deg, second_deg
    if mount.single_axis:
        second_deg = 0.0 * second_deg + fixed_deg(mount)
    return out_of(mount, first_deg, second_deg, trig)


def followed(
    mount: MountConfig, mode: Mode, held: tuple[float, float], sun: tuple[T, T], trig: Trigonometry[T]
) -> tuple[T, T]:
    """Return first and second angle, degrees, of a mode: the sun's on an axis that follows, else the held.

    `held` and `sun` are azimuth and elevation. A single axis follows in every mode but the fixed one, and
    backtracks between rows.
    """
    nothing = 0.0 * sun[0]
    held_first_deg, held_second_deg = angles(mount, nothing + held[0], nothing + held[1], trig)
    if mode is Mode.FIXED:
        return held_first_deg, held_second_deg
    sun_first_deg, sun_second_deg = angles(mount, *sun, trig)
    if mount.single_axis:
        rows = mount.rows
        return (sun_first_deg if rows is None else backtracked_deg(rows, sun_first_deg, trig)), sun_second_deg
    if mode is Mode.ELEVATION and mount.least_incidence and mount.kind is MountKind.AZIMUTH_ELEVATION:
        sun_second_deg = _least_incidence_deg(sun_second_deg, sun_first_deg - held_first_deg, trig)
    return (
        sun_first_deg if mode in FIRST_FOLLOWS else held_first_deg,
        sun_second_deg if mode in SECOND_FOLLOWS else held_second_deg,
    )


def fixed_deg(mount: MountConfig) -> float:
    """Return the second angle of a single axis: the elevation of a panel on a vertical one, else zero."""
    return 90.0 - mount.panel_tilt_deg if mount.kind is MountKind.VERTICAL_SINGLE_AXIS else 0.0


def along_deg(mount: MountConfig, azimuth_deg: T, elevation_deg: T, trig: Trigonometry[T]) -> T:
    """Return how far along the first axis a direction lies, either way: at 90 degrees it cannot be faced."""
    if mount.kind is MountKind.AZIMUTH_ELEVATION:
        return elevation_deg
    return abs(into(mount, azimuth_deg, elevation_deg, trig)[1])


def _least_incidence_deg(sun_second_deg: T, aside_deg: T, trig: Trigonometry[T]) -> T:
    """Return the second angle, which may pass 90 degrees, nearest to a sun that is aside of the first."""
    sun, aside = sun_second_deg * PER_DEGREE, aside_deg * PER_DEGREE
    return trig.atan2(trig.sin(sun), trig.cos(sun) * trig.cos(aside)) * PER_RADIAN
