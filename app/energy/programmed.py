"""Where a step program has a panel stand, for many instants at once."""

import numpy as np

from app.energy.ideal import AxisPath, faced
from app.sun.trigonometry import ARRAY, Array
from app.tracker.mounts.kinematics import angles, direction
from app.tracker.settings.config import MountConfig, MountKind
from app.tracker.settings.stepped import HOURS_A_DAY, StepFrame, StepProgram, TimeBase


def equatorial_mount(latitude_deg: float) -> MountConfig:
    """Return a mount whose first axis is parallel to the Earth's, at a latitude."""
    return MountConfig(MountKind.EQUATORIAL, 180.0 if latitude_deg >= 0.0 else 0.0, abs(latitude_deg))


def solar_hours(latitude_deg: float, sun_azimuth_deg: Array, sun_elevation_deg: Array) -> Array:
    """Return apparent solar time of instants from the sun's place, hours in [0, 24)."""
    hour_angle_deg, _ = angles(equatorial_mount(latitude_deg), sun_azimuth_deg, sun_elevation_deg, ARRAY)
    return np.asarray(np.mod(12.0 + hour_angle_deg / 15.0, HOURS_A_DAY), dtype=np.float64)


def program_axes(
    program: StepProgram,
    mount: MountConfig,
    latitude_deg: float,
    ideal: AxisPath,
    solar_h: Array,
    utc_h: Array,
) -> AxisPath:
    """Return the axis angles of a step program; an angle that a step leaves out stays the ideal one.

    `solar_h` and `utc_h` are the hours of the day of every instant, in [0, 24).
    """
    solar = program.time_base is TimeBase.SOLAR
    hour = solar_h if solar else np.mod(utc_h + program.utc_offset_h, HOURS_A_DAY)
    starts_h = np.array([step.from_h for step in program.steps])
    index = np.maximum(np.searchsorted(starts_h, hour, side="right") - 1, 0)
    given = _columns(program)[:, index]
    frame = _frame(program.frame, mount, latitude_deg)
    followed = ideal if frame is mount else _angles(frame, *faced(mount, ideal))
    wanted = AxisPath(_filled(given[0], followed.first_deg), _filled(given[1], followed.second_deg))
    if frame is mount:
        return wanted
    return _angles(mount, *direction(frame, wanted.first_deg, wanted.second_deg, ARRAY))


def _frame(frame: StepFrame, mount: MountConfig, latitude_deg: float) -> MountConfig:
    """Return the mount whose axis angles the program's angles are."""
    match frame:
        case StepFrame.AXES:
            return mount
        case StepFrame.HORIZON:
            return mount if mount.kind is MountKind.AZIMUTH_ELEVATION else MountConfig()
        case StepFrame.EQUATOR:
            return equatorial_mount(latitude_deg)


def _angles(mount: MountConfig, azimuth_deg: Array, elevation_deg: Array) -> AxisPath:
    return AxisPath(*angles(mount, azimuth_deg, elevation_deg, ARRAY))


def _columns(program: StepProgram) -> Array:
    """Return both angles of every step, NaN where a step leaves one out."""
    rows = [(step.first_deg, step.second_deg) for step in program.steps]
    return np.array(rows, dtype=np.float64).T


def _filled(given_deg: Array, followed_deg: Array) -> Array:
    return np.where(np.isnan(given_deg), followed_deg, given_deg)
