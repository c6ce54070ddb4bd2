"""The drives that a profile can make, each from its adapter and the devices on the bus."""

from collections.abc import Callable
from typing import assert_never

from app.clock import Clock
from app.drives.bus import BusUnit
from app.drives.cia402_axis import Cia402Axis
from app.drives.dialect import Dialect
from app.drives.direct_axis import DirectAxis
from app.drives.drive import Drive
from app.drives.gearing import Gearing, gearing_of
from app.drives.plc import PlcDrive
from app.drives.pr_axis import PrAxis
from app.drives.profile import Adapter, Profile
from app.drives.profile_needs import check_needs
from app.drives.register_axis import RegisterAxis
from app.drives.sunspec import SunSpecDrive
from app.drives.two_axes import TwoAxisDrive
from app.drives.unit import Unit
from app.tracker.axes import Axis
from app.tracker.config import AxisDrive, TrackerConfig

MakeDialect = Callable[[Unit, Gearing, float], Dialect]


def drive_on(
    config: TrackerConfig, profile: Profile, unit_of: Callable[[int], BusUnit], clock: Clock
) -> Drive:
    """Return the drive of a tracker; `unit_of` gives a device on its bus by the unit id.

    Raises `ProfileError` if the profile lacks what its adapter needs.
    """
    check_needs(profile)
    drive = config.drive
    match profile.adapter:
        case Adapter.PLC:
            return PlcDrive(config, profile, clock, unit_of(drive.unit))
        case Adapter.SUNSPEC:
            unit = unit_of(drive.unit)
            return SunSpecDrive(config, profile, unit, clock, str(unit))
        case Adapter.CIA402:
            return _two_axes(config, profile, unit_of, clock, Cia402Axis)
        case Adapter.PR:
            return _two_axes(config, profile, unit_of, clock, PrAxis)
        case Adapter.DIRECT:
            return _two_axes(config, profile, unit_of, clock, DirectAxis)
        case _ as never:
            assert_never(never)


def axis_units(config: TrackerConfig) -> dict[Axis, int]:
    """Return the unit id of each axis's drive: its own, else the drive's and the next one."""
    drive = config.drive
    azimuth = drive.unit if drive.azimuth.unit is None else drive.azimuth.unit
    elevation = azimuth + 1 if drive.elevation.unit is None else drive.elevation.unit
    return {Axis.AZIMUTH: azimuth, Axis.ELEVATION: elevation}


def _two_axes(
    config: TrackerConfig,
    profile: Profile,
    unit_of: Callable[[int], BusUnit],
    clock: Clock,
    make: MakeDialect,
) -> Drive:
    drives: dict[Axis, AxisDrive] = {
        Axis.AZIMUTH: config.drive.azimuth,
        Axis.ELEVATION: config.drive.elevation,
    }
    axes: dict[Axis, RegisterAxis] = {}
    for axis, number in axis_units(config).items():
        bus_unit = unit_of(number)
        unit = Unit(profile, bus_unit, f"{bus_unit} ({axis})")
        gearing = gearing_of(profile, drives[axis])
        dialect = make(unit, gearing, config.axis(axis).acceleration_dps2)
        axes[axis] = RegisterAxis(dialect, unit, gearing, config.axis(axis), clock)
    return TwoAxisDrive(config, profile, axes, clock, config.drive.line)
