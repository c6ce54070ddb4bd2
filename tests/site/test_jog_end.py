"""How a jog ends: at its instant, whatever else is going on, and what is over costs nothing."""

from datetime import timedelta

import pytest

from app.tracker.commands.commands import JOG_LEASE, EndJog, Jog
from app.tracker.settings.axes import Axis
from app.tracker.state.controller_state import HALTED
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.site.plant import Begun, Plant, settle
from tests.site.wrapped_drive import WrappedDrive, wrapped

BURST = 125
TOLD_WITHIN = timedelta(milliseconds=10)
SHORTLY = timedelta(milliseconds=1)


async def test_the_ends_of_presses_that_are_over_neither_tick_nor_tell(plant: Plant) -> None:
    """A page that held a hundred presses told the end of each: the whole site was published for every one."""
    await plant.forward(seconds=1)
    told, ticks = plant.site.latest(), plant.site.model.tracker("T1").counter.ticks
    for number in range(BURST):
        answer = await plant.ask(EndJog(f"over-{number}"))
        assert answer is told
    assert plant.site.latest() is told
    assert plant.site.model.tracker("T1").counter.ticks == ticks


async def test_the_end_of_the_press_that_is_held_ticks_and_tells_at_once(plant: Plant) -> None:
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.forward(seconds=0.05)
    await plant.ask(EndJog("p1"))
    await plant.forward(seconds=timedelta(milliseconds=1).total_seconds())
    assert plant.tracker().activity is not ActivityName.JOGGING
    assert len(plant.happened(EventKind.JOG_ENDED)) == 1


@pytest.mark.parametrize("hangs_from_ms", [150, 205], ids=["read before the end", "read at the end"])
async def test_a_drive_that_hangs_is_told_to_stop_at_the_lease_s_end(
    hangs_from_ms: int, begun: Begun
) -> None:
    """The read of a tick may take as long as the drive does not answer; the stop goes beside it."""
    plant = await begun(wrap=WrappedDrive)
    await plant.forward(seconds=1)
    begun = plant.clock.now()
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.forward(seconds=hangs_from_ms / 1000.0)
    drive = wrapped(plant, "T1")
    drive.hangs = True
    plant.clock.move_to(begun + JOG_LEASE - SHORTLY)
    await settle()
    assert drive.stops == 0
    plant.clock.move_to(begun + JOG_LEASE + TOLD_WITHIN)
    await settle()
    assert drive.stops == 1
    drive.hangs = False


async def test_a_jog_that_goes_on_is_not_stopped_for_a_drive_that_is_slow(begun: Begun) -> None:
    plant = await begun(wrap=WrappedDrive)
    await plant.forward(seconds=1)
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.forward(seconds=0.15)
    drive = wrapped(plant, "T1")
    drive.hangs = True
    for sequence in range(1, 10):
        await plant.ask(Jog("p1", Axis.AZIMUTH, 1, sequence=sequence))
        await plant.forward(seconds=0.05)
    assert drive.stops == 0
    drive.hangs = False


async def test_a_lease_ends_at_its_instant_between_two_ticks(begun: Begun) -> None:
    """Whatever the phase of the press, the command to rest is written at the end of its lease."""
    plant = await begun(wrap=WrappedDrive)
    drive = wrapped(plant, "T1")
    for number in range(200):
        await plant.forward(seconds=0.3 + 0.0013 * number)
        begun = plant.clock.now()
        await plant.ask(Jog(f"p{number}", Axis.AZIMUTH, 1 - number % 2 * 2))
        plant.clock.move_to(begun + JOG_LEASE - SHORTLY)
        await settle()
        assert plant.tracker().activity is ActivityName.JOGGING
        plant.clock.move_to(begun + JOG_LEASE)
        await settle()
        assert plant.tracker().activity is not ActivityName.JOGGING
        assert drive.written[-1] == HALTED
