"""Drives that count millimetres of an actuator, and drives turned round or stretched, seen in degrees."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.drives.linear_actuator import TransmittedDrive, counted_mm, in_millimetres
from app.drives.scaled import Stretch, corrected
from app.machine.drive_factory import DriveFactory
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import AZIMUTH_DEFAULT, Axis, AxisConfig
from app.tracker.settings.config import AxisDrive, DriveConfig, MountConfig, MountKind, TrackerConfig
from app.tracker.settings.mechanisms import alexandru_diurnal, alexandru_elevation
from app.tracker.values.motion import DriveCommand, DriveRequest, Position, RequestKind, Velocity
from tests.drives.rigs import CONFIG, START, Rig

POLAR = replace(
    CONFIG,
    azimuth=AxisConfig(-60.0, 60.0, 3.0, 6.0, 0.5, 1.5, alexandru_diurnal()),
    elevation=AxisConfig(-23.0, 23.5, 1.9, 6.0, 0.5, 1.0, alexandru_elevation()),
    mount=MountConfig(MountKind.EQUATORIAL, 180.0, 45.65),
)
TURNED = replace(
    CONFIG, drive=DriveConfig(azimuth=AxisDrive(inverted=True), elevation=AxisDrive(gear_ratio=1.25))
)


def polar() -> Rig:
    """An equatorial mount, both of whose axes are turned by linear actuators."""
    clock = VirtualClock(START)
    drive = DriveFactory(clock).make(POLAR)
    return Rig(drive, drive, clock)  # type: ignore[arg-type]  # nobody looks behind it here


async def test_the_factory_turns_both_actuators_of_an_equatorial_mount() -> None:
    rig = polar()
    begun = await rig.drive.read()
    feedback = await rig.forward(2.0, DriveCommand(azimuth=Velocity(1.0), elevation=Velocity(-1.0)))
    assert feedback.azimuth.velocity_dps == pytest.approx(1.0, rel=0.02)
    assert feedback.elevation.velocity_dps == pytest.approx(-1.0, rel=0.02)
    assert feedback.azimuth.position_deg > begun.azimuth.position_deg
    assert feedback.elevation.position_deg < begun.elevation.position_deg
    assert rig.drive.capabilities.description.endswith("Linear actuators: azimuth and elevation.")
    await rig.drive.stop()
    rig.idle(0.4)
    stopped = await rig.drive.read()
    assert (stopped.azimuth.moving, stopped.watchdog_tripped) == (False, False), "before the watchdog would"
    feedback = await rig.until_rest(DriveCommand(request=DriveRequest(1, RequestKind.HOME)))
    assert (feedback.azimuth.homed, feedback.elevation.homed) == (True, True)
    assert (feedback.azimuth.position_deg, feedback.elevation.position_deg) == pytest.approx((0, 0), abs=0.02)
    await rig.drive.close()


async def test_an_actuator_keeps_the_speed_of_its_axis_over_the_whole_range() -> None:
    rig = polar()
    await rig.until_rest(DriveCommand(Position(-55.0, 3.0)))
    speeds = []
    for _ in range(60):
        feedback = await rig.forward(0.5, DriveCommand(Position(55.0, 2.0)), timedelta(seconds=0.25))
        if 2.0 < feedback.azimuth.position_deg + 55.0 < 105.0:
            speeds.append(feedback.azimuth.velocity_dps)
    assert len(speeds) > 40
    assert speeds == pytest.approx([2.0] * len(speeds), rel=0.02)
    assert (await rig.until_rest(DriveCommand(Position(55.0, 2.0)))).azimuth.position_deg == pytest.approx(
        55.0, abs=0.02
    )
    await rig.drive.close()


async def test_an_actuator_has_switches_and_a_clock_and_is_stopped_when_it_is_closed() -> None:
    clock = VirtualClock(START)
    config = replace(POLAR, elevation=CONFIG.elevation)
    machine = SimulatedDrive(in_millimetres(config), clock, watchdog=None)
    drive = TransmittedDrive(machine, config)
    machine.inject(Fault(FaultKind.LOWER_LIMIT_STUCK, Axis.AZIMUTH))
    seen, actuator = (await drive.read()).azimuth, POLAR.azimuth.actuator
    assert actuator is not None
    longer_is_farther = actuator.mm_per_deg(seen.position_deg) > 0.0
    assert (seen.at_lower_limit, seen.at_upper_limit) == (longer_is_farther, not longer_is_farther)
    await drive.set_clock(START + timedelta(days=1))
    assert machine.wall_clock == START + timedelta(days=1)
    await drive.write(DriveCommand(elevation=Velocity(1.0)))
    clock.advance(timedelta(seconds=1))
    assert (await drive.read()).elevation.moving
    await drive.close()
    clock.advance(timedelta(seconds=1))
    assert machine.is_resting


@pytest.mark.parametrize("axis", Axis)
def test_the_drives_limits_are_those_of_the_axis_in_millimetres(axis: Axis) -> None:
    config, driven = POLAR.axis(axis), in_millimetres(POLAR).axis(axis)
    actuator = config.actuator
    assert actuator is not None
    ends_mm = sorted(counted_mm(actuator, end) for end in (config.minimum_deg, config.maximum_deg))
    assert [driven.minimum_deg, driven.maximum_deg] == pytest.approx(ends_mm)
    assert driven.speed_dps == actuator.speed_mm_s
    assert config.speed_dps <= actuator.slowest_dps(config.minimum_deg, config.maximum_deg)


def turned() -> tuple[Rig, SimulatedDrive]:
    """A drive that counts degrees, turned round in azimuth and stretched in elevation, and its machine."""
    clock = VirtualClock(START)
    machines: list[SimulatedDrive] = []

    def make(config: TrackerConfig) -> SimulatedDrive:
        machines.append(SimulatedDrive(config, clock, watchdog=None))
        return machines[-1]

    drive = corrected(TURNED, make)
    return Rig(drive, machines[0], clock), machines[0]


async def test_a_turned_axis_goes_the_other_way_and_a_stretched_one_farther() -> None:
    rig, machine = turned()
    before, true_before = await rig.drive.read(), machine.observe()
    after = await rig.forward(3.0, DriveCommand(Velocity(2.0), Velocity(1.0)))
    true = machine.observe()
    azimuth_deg = after.azimuth.position_deg - before.azimuth.position_deg
    elevation_deg = after.elevation.position_deg - before.elevation.position_deg
    assert azimuth_deg > 5.0
    assert true.azimuth.position_deg - true_before.azimuth.position_deg == pytest.approx(-azimuth_deg)
    assert true.elevation.position_deg - true_before.elevation.position_deg == pytest.approx(
        1.25 * elevation_deg
    )
    machine.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.AZIMUTH))
    assert (await rig.drive.read()).azimuth.at_lower_limit, "the switches change places"
    await rig.drive.stop()
    rig.idle(2.0)
    stood = await rig.drive.read()
    assert not stood.azimuth.moving
    target_deg = stood.elevation.position_deg + 4.0
    moved = await rig.until_rest(DriveCommand(elevation=Position(target_deg, 2.0)))
    assert moved.elevation.position_deg == pytest.approx(target_deg, abs=0.02)
    assert rig.drive.capabilities == machine.capabilities
    await rig.drive.set_clock(START + timedelta(days=1))
    assert machine.wall_clock == START + timedelta(days=1)
    await rig.drive.close()
    assert machine.is_resting


def test_limits_and_speeds_are_those_of_the_drive_and_a_motors_gear_is_refused() -> None:
    stretched = Stretch(-1.5).settings(AZIMUTH_DEFAULT)
    assert (stretched.minimum_deg, stretched.maximum_deg) == (-540.0, 0.0)
    assert stretched.speed_dps == pytest.approx(9.0)
    geared = replace(CONFIG, drive=DriveConfig(azimuth=AxisDrive(gear_ratio=100.0)))
    with pytest.raises(ValueError, match="counts degrees of the axis"):
        corrected(geared, lambda config: SimulatedDrive(config, VirtualClock(START)))
