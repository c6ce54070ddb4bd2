"""A technician proves a drive that was wired the wrong way round and geared otherwise than set."""

from collections.abc import AsyncIterator
from dataclasses import replace

import pytest

from app.base.clock import VirtualClock
from app.drives.drive import Drive
from app.drives.scaled import corrected
from app.link.messages import (
    AnswerDirection,
    AnswerScale,
    ConfigureTracker,
    RestoreDrive,
    SetSoftLimit,
)
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site
from app.tracker.commands.commands import (
    CommandRejected,
    Move,
    RunCommunicationLossTest,
    RunDirectionTest,
    RunScaleTest,
    RunStopTest,
    SetHome,
    Step,
    Stop,
)
from app.tracker.commissioning.drive_test_states import ProofState
from app.tracker.commissioning.steps import StepStatus
from app.tracker.memory.drive_tests import AxisEnd, ProofKind, StopSpeed
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import AxisDrive, Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.site.plant import SUMMER_NOON, Plant

WIDE = AxisConfig(-350.0, 350.0, 6.0, 6.0, 0.5, 3.0)
BUILT = TrackerConfig("T1", "Tracker 1", WIDE, WIDE, park=Orientation(0.0, 0.0))
TRUE_FACTOR = {Axis.AZIMUTH: -1.1, Axis.ELEVATION: 1.0}
"""Degrees that the panel turns for one degree of the drive: azimuth is wired wrongly and geared higher."""


class Site1(Plant):
    """A site with one tracker whose machine stays the same whatever is set; what the technician sees."""

    machine: SimulatedDrive

    def panel_deg(self, axis: Axis) -> float:
        seen = self.machine.observe()
        turned = seen.azimuth if axis is Axis.AZIMUTH else seen.elevation
        return TRUE_FACTOR[axis] * turned.position_deg

    @property
    def config(self) -> TrackerConfig:
        return self.site.model.tracker("T1").config

    @property
    def memory(self) -> TrackerMemory:
        return self.site.model.tracker("T1").memory

    async def proof(
        self, kind: ProofKind, axis: Axis | None = None, speed: StopSpeed | None = None
    ) -> ProofState:
        states = (await self.site.detail()).trackers["T1"].proofs
        (found,) = [one for one in states if (one.kind, one.axis, one.speed) == (kind, axis, speed)]
        return found

    async def rest(self) -> None:
        await self.forward(seconds=0.5)
        await self.until(lambda seen: seen.activity is ActivityName.HOLDING)
        await self.forward(seconds=0.5)

    async def turn(self, command: RunDirectionTest | RunScaleTest, axis: Axis) -> float:
        """Give the command and return by how much the panel turned."""
        before = self.panel_deg(axis)
        await self.ask(command)
        await self.rest()
        return self.panel_deg(axis) - before

    async def prove(self, axis: Axis) -> None:
        """Prove direction and scale, correcting what is found."""
        for _ in range(2):
            turned = await self.turn(RunDirectionTest(axis), axis)
            await self.ask(AnswerDirection("T1", right=turned > 0.0))
        for _ in range(2):
            turned = await self.turn(RunScaleTest(axis), axis)
            await self.ask(AnswerScale("T1", abs(round(turned, 1))))


@pytest.fixture
async def plant() -> AsyncIterator[Site1]:
    clock = VirtualClock(SUMMER_NOON)
    machine = SimulatedDrive(BUILT, clock)
    drives: dict[str, Drive] = {}

    def make(config: TrackerConfig) -> Drive:
        drives["T1"] = corrected(config, lambda _: machine)
        return drives["T1"]

    state = TrackerState(BUILT, TrackerMemory())
    built = Site1(clock, Site(clock, make, SiteState(), (state,)), drives)
    built.machine = machine
    await built.start()
    await built.forward(seconds=0.3)
    yield built
    await built.close()


async def test_direction_and_scale_are_corrected_until_the_axis_reads_what_the_panel_does(
    plant: Site1,
) -> None:
    for axis in Axis:
        await plant.prove(axis)
    assert plant.config.drive.azimuth.inverted
    assert plant.config.drive.azimuth.gear_ratio == pytest.approx(1 / 1.1, rel=0.01)
    assert plant.config.drive.elevation == AxisDrive()
    before = plant.panel_deg(Axis.AZIMUTH)
    await plant.ask(Step(Axis.AZIMUTH, 5.0))
    await plant.rest()
    assert plant.panel_deg(Axis.AZIMUTH) - before == pytest.approx(5.0, abs=0.05)
    for axis in Axis:
        for kind in (ProofKind.DIRECTION, ProofKind.SCALE):
            state = await plant.proof(kind, axis)
            assert (state.status, state.by) == (StepStatus.DONE, "technician")
    assert "(+0.0 %)" in (await plant.proof(ProofKind.SCALE, Axis.ELEVATION)).result


async def test_a_move_that_waits_to_be_judged_says_so_and_is_judged_once(plant: Site1) -> None:
    await plant.turn(RunDirectionTest(Axis.ELEVATION), Axis.ELEVATION)
    waiting = await plant.proof(ProofKind.DIRECTION, Axis.ELEVATION)
    assert waiting.status is StepStatus.TO_DO
    assert waiting.reasons[0].code == "move_to_judge"
    with pytest.raises(CommandRejected, match="has not been moved for this drive test"):
        await plant.ask(AnswerScale("T1", 3.0))
    await plant.ask(AnswerDirection("T1", right=True))
    with pytest.raises(CommandRejected, match="has not been moved for this drive test"):
        await plant.ask(AnswerDirection("T1", right=True))
    assert plant.memory.proofs.move is None
    (told,) = [one for one in plant.happened(EventKind.DRIVE_TEST_ENDED) if one.data["outcome"] == "proven"]
    assert told.message == "The elevation axis moves in the right direction."


async def test_a_move_is_not_judged_with_an_angle_that_cannot_be_nor_under_other_settings(
    plant: Site1,
) -> None:
    with pytest.raises(CommandRejected, match="uses 10, 30, or 90 degrees"):
        await plant.ask(RunScaleTest(Axis.ELEVATION, 20.0))
    turned = await plant.turn(RunScaleTest(Axis.AZIMUTH), Axis.AZIMUTH)
    for measured_deg in (0.0, -5.0, 4000.0, float("nan")):
        with pytest.raises(ValueError, match="Enter the degrees that the panel turned"):
            await plant.ask(AnswerScale("T1", measured_deg))
    assert plant.config == BUILT
    geared = replace(BUILT.drive, azimuth=AxisDrive(gear_ratio=1.05))
    await plant.ask(ConfigureTracker(replace(BUILT, drive=geared)))
    await plant.rest()
    assert plant.memory.proofs.move is None
    with pytest.raises(CommandRejected, match="has not been moved for this drive test"):
        await plant.ask(AnswerScale("T1", abs(turned)))
    assert plant.config.drive == geared


async def test_nothing_is_judged_while_the_axis_moves(plant: Site1) -> None:
    await plant.ask(RunDirectionTest(Axis.ELEVATION))
    await plant.forward(seconds=0.3)
    assert (await plant.proof(ProofKind.DIRECTION, Axis.ELEVATION)).reasons[0].code == "move_under_way"
    with pytest.raises(CommandRejected, match="is moving to a position"):
        await plant.ask(AnswerDirection("T1", right=True))
    await plant.ask(Stop())
    await plant.rest()


async def test_another_direction_loses_the_zero_and_can_be_undone(plant: Site1) -> None:
    with pytest.raises(CommandRejected, match="have not been changed"):
        await plant.ask(RestoreDrive("T1"))
    await plant.ask(SetHome())
    await plant.rest()
    assert plant.tracker().homed
    await plant.turn(RunDirectionTest(Axis.AZIMUTH), Axis.AZIMUTH)
    await plant.ask(AnswerDirection("T1", right=False))
    await plant.forward(seconds=0.5)
    assert not plant.tracker().homed
    assert plant.memory.former_drive == BUILT.drive
    await plant.ask(RestoreDrive("T1"))
    assert plant.config.drive == BUILT.drive
    assert plant.memory.former_drive is not None
    assert plant.memory.former_drive.azimuth.inverted
    assert not plant.tracker().homed


async def test_limits_are_taken_where_the_axis_stands(plant: Site1) -> None:
    with pytest.raises(CommandRejected, match="is not homed"):
        await plant.ask(SetSoftLimit("T1", Axis.AZIMUTH, AxisEnd.LOWER))
    await plant.ask(SetHome())
    await plant.rest()
    for to_deg, end in ((-20.0, AxisEnd.LOWER), (200.0, AxisEnd.UPPER)):
        await plant.ask(Move(Orientation(to_deg % 360.0, 0.0)))
        await plant.rest()
        await plant.ask(SetSoftLimit("T1", Axis.AZIMUTH, end))
        await plant.forward(seconds=0.5)
        assert plant.tracker().homed
    assert plant.config.azimuth.minimum_deg == pytest.approx(-20.0, abs=0.06)
    assert plant.config.azimuth.maximum_deg == pytest.approx(200.0, abs=0.06)
    assert (await plant.proof(ProofKind.LIMITS, Axis.AZIMUTH)).status is StepStatus.DONE
    with pytest.raises(ValueError, match="lower soft limit must lie below"):
        await plant.ask(SetSoftLimit("T1", Axis.AZIMUTH, AxisEnd.LOWER))


async def test_what_a_later_change_made_untrue_is_to_be_confirmed_and_true_again_when_undone(
    plant: Site1,
) -> None:
    await plant.prove(Axis.ELEVATION)
    await plant.ask(RunStopTest(Axis.ELEVATION, StopSpeed.JOG))
    await plant.rest()
    await plant.ask(RunCommunicationLossTest(Axis.ELEVATION))
    await plant.rest()
    proven = [
        (ProofKind.DIRECTION, Axis.ELEVATION, None),
        (ProofKind.SCALE, Axis.ELEVATION, None),
        (ProofKind.STOP, Axis.ELEVATION, StopSpeed.JOG),
        (ProofKind.LINK_LOSS, None, None),
    ]
    for which in proven:
        assert (await plant.proof(*which)).status is StepStatus.DONE, which
    drive = plant.config.drive
    geared = replace(drive, elevation=AxisDrive(gear_ratio=1.5), azimuth=AxisDrive(inverted=True))
    await plant.ask(ConfigureTracker(replace(plant.config, drive=geared)))
    assert (await plant.proof(*proven[0])).status is StepStatus.DONE
    assert (await plant.proof(*proven[1])).status is StepStatus.TO_BE_CONFIRMED
    await plant.ask(RestoreDrive("T1"))
    other = replace(plant.config, drive=replace(plant.config.drive, unit=7))
    await plant.ask(ConfigureTracker(other))
    for which in proven:
        state = await plant.proof(*which)
        assert state.status is StepStatus.TO_BE_CONFIRMED, which
        assert state.reasons[0].code == "drive_changed"
    await plant.ask(RestoreDrive("T1"))
    for which in proven:
        assert (await plant.proof(*which)).status is StepStatus.DONE, which


async def test_other_speeds_and_another_zero_make_tests_and_limits_to_be_confirmed(plant: Site1) -> None:
    await plant.ask(SetHome())
    await plant.rest()
    for to_deg, end in ((0.0, AxisEnd.LOWER), (5.0, AxisEnd.UPPER)):
        await plant.ask(Move(Orientation(0.0, to_deg)))
        await plant.rest()
        await plant.ask(SetSoftLimit("T1", Axis.ELEVATION, end))
        await plant.forward(seconds=0.5)
    await plant.ask(RunStopTest(Axis.AZIMUTH, StopSpeed.RATED))
    await plant.rest()
    await plant.ask(SetHome())
    await plant.rest()
    slower = replace(plant.config.azimuth, speed_dps=4.0)
    await plant.ask(ConfigureTracker(replace(plant.config, azimuth=slower)))
    stop = await plant.proof(ProofKind.STOP, Axis.AZIMUTH, StopSpeed.RATED)
    limits = await plant.proof(ProofKind.LIMITS, Axis.ELEVATION)
    assert (stop.status, stop.reasons[0].code) == (StepStatus.TO_BE_CONFIRMED, "speed_changed")
    assert (limits.status, limits.reasons[0].code) == (StepStatus.TO_BE_CONFIRMED, "zero_changed")
    by_hand = replace(plant.config.elevation, maximum_deg=20.0)
    await plant.ask(ConfigureTracker(replace(plant.config, elevation=by_hand)))
    limits = await plant.proof(ProofKind.LIMITS, Axis.ELEVATION)
    assert {reason.code for reason in limits.reasons} == {"limits_changed", "zero_changed"}
