"""The drives that a profile can make, each from its adapter and the devices on the bus."""

from collections.abc import Callable
from typing import assert_never

from app.base.clock import Clock
from app.base.message import say
from app.drives.connections.profile_needs import check_needs
from app.drives.dialects.cia402_axis import Cia402Axis
from app.drives.dialects.dialect import Dialect
from app.drives.dialects.direct_axis import DirectAxis
from app.drives.dialects.gearing import Gearing, gearing_of
from app.drives.dialects.plc import PlcDrive
from app.drives.dialects.pr_axis import PrAxis
from app.drives.dialects.register_axis import RegisterAxis
from app.drives.dialects.sunspec import SunSpecDrive
from app.drives.dialects.two_axes import TwoAxisDrive
from app.drives.drive import Drive
from app.drives.profile import Adapter, Profile, ProfileError
from app.drives.unit import Unit
from app.modbus.bus import BusUnit
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, TrackerConfig

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


def axis_units(drive: DriveConfig) -> dict[Axis, int]:
    """Return the unit id of each axis's drive, or raise `ProfileError` if both have the same."""
    azimuth, *others = drive.units
    if not others:
        raise ProfileError(
            say(
                "Both axes have unit {azimuth}, but profile {profile} uses a separate drive for each "
                "axis. Give the elevation axis a different unit id.",
                azimuth=azimuth,
                profile=drive.profile,
            )
        )
    return {Axis.AZIMUTH: azimuth, Axis.ELEVATION: others[0]}


def _two_axes(
    config: TrackerConfig,
    profile: Profile,
    unit_of: Callable[[int], BusUnit],
    clock: Clock,
    make: MakeDialect,
) -> Drive:
    axes: dict[Axis, RegisterAxis] = {}
    for axis, number in axis_units(config.drive).items():
        bus_unit = unit_of(number)
        unit = Unit(profile, bus_unit, f"{bus_unit} ({axis})")
        gearing = gearing_of(profile, config.drive.axis(axis))
        dialect = make(unit, gearing, config.axis(axis).acceleration_dps2)
        axes[axis] = RegisterAxis(dialect, unit, gearing, config.axis(axis), clock)
    return TwoAxisDrive(config, profile, axes, clock, config.drive.line)
