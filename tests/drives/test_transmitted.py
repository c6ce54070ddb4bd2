"""A drive that counts millimetres of an actuator, seen in degrees: every story, and the mechanisms."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.drives.linear_actuator import TransmittedDrive, counted_mm, in_millimetres
from app.machine.drive_factory import DriveFactory
from app.simulation.faults import Fault
from app.simulation.position_memory import AxisMemory, PositionFile, PositionMemory
from app.simulation.simulated import SimulatedDrive
from app.simulation.simulated_axis import Mechanics
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation
from app.tracker.settings.mechanisms import alexandru_diurnal, alexandru_elevation
from app.tracker.settings.transmission import LinearActuator, Point
from app.tracker.values.motion import DriveCommand, Feedback, Position, Velocity
from tests.drives.conformance import BEGIN_ELEVATION_DEG, Story, stories_for
from tests.drives.rigs import CONFIG, FULL, START, Rig

LIFT = LinearActuator(Point(900.0, 0.0, 15.0), Point(132.5, 200.1), 0.0, 745.0, 385.0, 25.0)
"""Turns an elevation axis from -13 to 105 degrees, by about as much for a millimetre at 7 and at 37."""
TRUE_ELEVATION_DEG = 6.6
FINE = Mechanics(gear=1e9, switch_margin_deg=2.0)
LIFTED = replace(CONFIG, elevation=replace(CONFIG.elevation, actuator=LIFT))
POLAR = replace(
    CONFIG,
    azimuth=AxisConfig(-60.0, 60.0, 3.0, 6.0, 0.5, 1.5, alexandru_diurnal()),
    elevation=AxisConfig(-23.0, 23.5, 1.9, 6.0, 0.5, 1.0, alexandru_elevation()),
    mount=MountConfig(MountKind.EQUATORIAL, 180.0, 45.65),
)


class LiftedMachine:
    """The simulated machine behind the actuator, asked and hurt in degrees of the elevation axis."""

    def __init__(self, inner: SimulatedDrive) -> None:
        self._inner = inner

    @property
    def true_orientation(self) -> Orientation:
        true = self._inner.true_orientation
        return Orientation(true.azimuth_deg, LIFT.angle_deg(true.elevation_deg + LIFT.stroke_mm(0.0)))

    @property
    def wall_clock(self) -> datetime:
        return self._inner.wall_clock

    def inject(self, fault: Fault) -> None:
        if fault.axis is Axis.ELEVATION:
            fault = replace(fault, amount=fault.amount * LIFT.mm_per_deg(BEGIN_ELEVATION_DEG))
        self._inner.inject(fault)

    def end_injected_faults(self) -> None:
        self._inner.end_injected_faults()

    def observe(self) -> Feedback:
        return self._inner.observe()


@asynccontextmanager
async def lifted_rig(folder: Path) -> AsyncIterator[Rig]:
    clock, memory = VirtualClock(START), folder / "T1.json"
    true_mm = counted_mm(LIFT, TRUE_ELEVATION_DEG)
    elevation = AxisMemory(true_mm, counted_mm(LIFT, BEGIN_ELEVATION_DEG) - true_mm, homed=False)
    PositionFile(memory).keep(PositionMemory(AxisMemory(12.4, 90.0, homed=False), elevation, 1, trusted=True))
    machine = SimulatedDrive(in_millimetres(LIFTED), clock, memory=PositionFile(memory), mechanics=FINE)
    drive = TransmittedDrive(machine, LIFTED)
    yield Rig(drive, LiftedMachine(machine), clock)  # type: ignore[arg-type]  # as much as the stories ask for
    await drive.close()


@pytest.mark.parametrize("tell", stories_for(FULL), ids=lambda tell: tell.__name__)
async def test_story_in_millimetres(tmp_path: Path, tell: Story) -> None:
    async with lifted_rig(tmp_path) as rig:
        await tell(rig)


async def test_the_factory_turns_both_actuators_of_an_equatorial_mount() -> None:
    clock = VirtualClock(START)
    drive = DriveFactory(clock).make(POLAR)
    rig = Rig(drive, drive, clock)  # type: ignore[arg-type]  # nobody looks behind it here
    begun = await drive.read()
    feedback = await rig.forward(2.0, DriveCommand(azimuth=Velocity(1.0), elevation=Velocity(-1.0)))
    assert feedback.azimuth.velocity_dps == pytest.approx(1.0, rel=0.02)
    assert feedback.elevation.velocity_dps == pytest.approx(-1.0, rel=0.02)
    assert feedback.azimuth.position_deg > begun.azimuth.position_deg
    assert feedback.elevation.position_deg < begun.elevation.position_deg
    assert drive.capabilities.description.endswith("Linear actuators: azimuth and elevation.")
    await drive.close()


async def test_an_actuator_keeps_the_speed_of_its_axis_over_the_whole_range() -> None:
    clock = VirtualClock(START)
    drive = DriveFactory(clock).make(POLAR)
    rig = Rig(drive, drive, clock)  # type: ignore[arg-type]  # nobody looks behind it here
    await rig.until_rest(DriveCommand(Position(-55.0, 3.0)))
    speeds = []
    for _ in range(60):
        feedback = await rig.forward(0.5, DriveCommand(Position(55.0, 2.0)))
        if 2.0 < feedback.azimuth.position_deg + 55.0 < 105.0:
            speeds.append(feedback.azimuth.velocity_dps)
    assert len(speeds) > 40
    assert speeds == pytest.approx([2.0] * len(speeds), rel=0.02)
    await drive.close()


@pytest.mark.parametrize("axis", Axis)
def test_the_drives_limits_are_those_of_the_axis_in_millimetres(axis: Axis) -> None:
    config, driven = POLAR.axis(axis), in_millimetres(POLAR).axis(axis)
    actuator = config.actuator
    assert actuator is not None
    ends_mm = sorted(counted_mm(actuator, end) for end in (config.minimum_deg, config.maximum_deg))
    assert [driven.minimum_deg, driven.maximum_deg] == pytest.approx(ends_mm)
    assert driven.speed_dps == actuator.speed_mm_s
    assert config.speed_dps <= actuator.slowest_dps(config.minimum_deg, config.maximum_deg)
