"""A drive that counts degrees, turned round and stretched: the axis reads what the panel does."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.base.clock import VirtualClock
from app.drives.scaled import CorrectedDrive, Stretch, corrected
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import AZIMUTH_DEFAULT, Axis
from app.tracker.settings.config import AxisDrive, DriveConfig, TrackerConfig
from app.tracker.values.motion import DriveCommand, Position, Velocity

START = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)
PLAIN = TrackerConfig("T1", "Tracker 1")
TURNED = replace(
    PLAIN,
    drive=DriveConfig(azimuth=AxisDrive(inverted=True), elevation=AxisDrive(gear_ratio=1.25)),
)


class Rig:
    """The corrected drive, and the machine behind it."""

    def __init__(self) -> None:
        self.clock = VirtualClock(START)
        self.machines: list[SimulatedDrive] = []
        self.drive = corrected(TURNED, self._make)

    def _make(self, config: TrackerConfig) -> SimulatedDrive:
        self.machines.append(SimulatedDrive(config, self.clock, watchdog=None))
        return self.machines[-1]

    async def after(self, seconds: float, command: DriveCommand) -> tuple[float, float, float, float]:
        """Return how far the axes have turned by their readings, and how far by the machine's."""
        before, inner = await self.drive.read(), self.machines[0].observe()
        await self.drive.write(command)
        self.clock.advance(timedelta(seconds=seconds))
        after, inner_after = await self.drive.read(), self.machines[0].observe()
        return (
            after.azimuth.position_deg - before.azimuth.position_deg,
            after.elevation.position_deg - before.elevation.position_deg,
            inner_after.azimuth.position_deg - inner.azimuth.position_deg,
            inner_after.elevation.position_deg - inner.elevation.position_deg,
        )


async def test_a_turned_axis_goes_the_other_way_and_a_stretched_one_farther() -> None:
    rig = Rig()
    turned = await rig.after(3.0, DriveCommand(Velocity(2.0), Velocity(1.0)))
    assert turned[0] > 5.0
    assert turned[2] == pytest.approx(-turned[0], abs=1e-6)
    assert turned[3] == pytest.approx(1.25 * turned[1], abs=1e-6)


async def test_a_position_is_reached_in_degrees_of_the_axis_at_its_speed() -> None:
    rig = Rig()
    begin = (await rig.drive.read()).elevation.position_deg
    way = await rig.after(2.0, DriveCommand(elevation=Position(begin + 10.0, 2.0)))
    assert way[1] == pytest.approx(2.0 * (2.0 - 2.0 / 2 / AZIMUTH_DEFAULT.acceleration_dps2), abs=0.05)
    await rig.after(10.0, DriveCommand(elevation=Position(begin + 10.0, 2.0)))
    assert (await rig.drive.read()).elevation.position_deg == pytest.approx(begin + 10.0, abs=0.02)


async def test_the_limit_switches_of_a_turned_axis_change_places() -> None:
    rig = Rig()
    rig.machines[0].inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.AZIMUTH))
    seen = (await rig.drive.read()).azimuth
    assert seen.at_lower_limit
    assert rig.machines[0].observe().azimuth.at_upper_limit


async def test_stop_and_the_drives_own_words_pass_through() -> None:
    rig = Rig()
    await rig.drive.write(DriveCommand(azimuth=Velocity(3.0)))
    rig.clock.advance(timedelta(seconds=2))
    await rig.drive.stop()
    rig.clock.advance(timedelta(seconds=2))
    assert not (await rig.drive.read()).azimuth.moving
    assert rig.drive.capabilities == rig.machines[0].capabilities
    await rig.drive.set_clock(START + timedelta(days=1))
    assert rig.machines[0].wall_clock - rig.clock.now() == pytest.approx(
        timedelta(days=1), abs=timedelta(minutes=1)
    )
    await rig.drive.close()
    assert rig.machines[0].is_resting


def test_what_needs_no_correction_is_left_as_it_is() -> None:
    made = corrected(PLAIN, lambda config: SimulatedDrive(config, VirtualClock(START)))
    assert isinstance(made, SimulatedDrive)
    assert not isinstance(made, CorrectedDrive)


def test_limits_and_speeds_are_those_of_the_drive() -> None:
    turned = Stretch(-1.5).settings(AZIMUTH_DEFAULT)
    assert (turned.minimum_deg, turned.maximum_deg) == (-540.0, 0.0)
    assert turned.speed_dps == pytest.approx(9.0)


def test_a_gear_ratio_of_a_motor_is_refused_with_a_sentence() -> None:
    geared = replace(PLAIN, drive=DriveConfig(azimuth=AxisDrive(gear_ratio=100.0)))
    with pytest.raises(ValueError, match="counts degrees of the axis"):
        corrected(geared, lambda config: SimulatedDrive(config, VirtualClock(START)))
