"""What must stand still stays still: late commands, restarts, repairs, the end of the machine."""

import asyncio
from collections.abc import Callable
from typing import TypeVar, cast

import pytest

from app.link.messages import Order, RenameSite, SetLocation, StopAll
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.store.store import Writer
from app.tracker.commands.commands import CommandRejected, Move, ResetFault, Stop, Track
from app.tracker.memory.memory import TrackerState
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import DriveCommand
from tests.patience import PATIENCE_S
from tests.site.plant import SAMSUN, Begun, Plant, settle
from tests.site.tracking_field import homed
from tests.site.wrapped_drive import WrappedDrive, wrapped

T = TypeVar("T")
FAR = Orientation(250.0, 80.0)


async def on_its_way() -> Plant:
    plant = homed(wrap=WrappedDrive)
    await plant.start()
    await plant.ask(Move(FAR))
    await plant.forward(seconds=1)
    assert plant.site.model.tracker("T1").moving
    return plant


def simulated(plant: Plant) -> SimulatedDrive:
    drive = wrapped(plant, "T1").inner
    assert isinstance(drive, SimulatedDrive)
    return drive


async def test_a_command_that_was_not_taken_is_not_sent_to_a_drive_that_restarted_since() -> None:
    plant = await on_its_way()
    drive = wrapped(plant, "T1")
    drive.refuses = True
    await plant.forward(seconds=0.1)
    simulated(plant).inject(Fault(FaultKind.POWER_LOSS))
    drive.refuses = False
    drive.written.clear()
    await plant.forward(seconds=1)

    assert {(told.azimuth, told.elevation) for told in drive.written} == {
        (DriveCommand().azimuth, DriveCommand().elevation)
    }
    assert not plant.tracker().homed
    await plant.close()


async def test_once_the_drives_are_stopped_for_the_end_no_tick_moves_them_again() -> None:
    plant = await on_its_way()

    await plant.site.stop_drives()
    await plant.forward(seconds=2)

    assert not plant.site.model.tracker("T1").moving
    await plant.close()


async def test_a_stop_that_meets_a_programming_error_still_ends_the_motion() -> None:
    plant = await on_its_way()
    wrapped(plant, "T1").cannot_stop = True
    await plant.ask(Stop())
    await plant.forward(seconds=3)
    assert plant.tracker().activity is ActivityName.HOLDING
    assert not plant.site.model.tracker("T1").moving
    await plant.site.stop_drives()
    await plant.close()


async def tracking_and_broken() -> Plant:
    plant = homed(tracks=True, wrap=WrappedDrive)
    await plant.start()
    await plant.forward(seconds=1)
    wrapped(plant, "T1").nonsense = True
    await plant.forward(seconds=1)
    wrapped(plant, "T1").nonsense = False
    return plant


async def test_after_an_unexpected_error_tracking_waits_for_the_operator() -> None:
    plant = await tracking_and_broken()

    await plant.ask(ResetFault())
    await plant.forward(seconds=2)

    shown = plant.tracker()
    assert shown.activity is ActivityName.HOLDING
    assert shown.tracking_on
    assert shown.waiting
    await plant.ask(Track())
    assert plant.tracker().activity is ActivityName.TRACKING
    await plant.close()


async def test_an_unexpected_error_is_a_fault_that_outlives_a_restart(begun: Begun) -> None:
    plant = await tracking_and_broken()
    state: TrackerState = plant.site.model.tracker("T1").state
    drive = plant.drives["T1"]
    await plant.close()

    again = await begun(
        start=plant.clock.now(), state=plant.site.model.state, trackers=(state,), wrap=lambda _: drive
    )
    await again.forward(seconds=2)

    assert again.tracker().activity is ActivityName.FAULTED


async def test_what_a_broken_tracker_last_saw_is_not_shown_as_live() -> None:
    plant = await tracking_and_broken()
    before = plant.tracker()
    await plant.forward(seconds=5)

    shown = plant.tracker()
    assert (shown.measured, shown.azimuth, shown.elevation, shown.off_sun_deg) == (None, None, None, None)
    assert not shown.in_position
    assert before.position_age_s is not None
    assert shown.position_age_s == pytest.approx(before.position_age_s + 5.0, abs=0.2)
    await plant.close()


async def test_stop_with_a_key_that_was_used_before_stops_again() -> None:
    plant = await on_its_way()
    await plant.ask(Stop(), key="k")
    await plant.forward(seconds=3)
    await plant.ask(Move(FAR))
    await plant.forward(seconds=1)

    await plant.ask(Stop(), key="k")
    await plant.forward(seconds=2)

    assert not plant.site.model.tracker("T1").moving
    await plant.ask(StopAll(), key="k")
    await plant.close()


async def test_an_order_that_had_to_wait_too_long_for_another_is_not_carried_out(plant: Plant) -> None:
    async with plant.site.model.changing:
        given = Order(RenameSite("Late"), "technician", issued_at=plant.site.model.now())
        waiting = asyncio.create_task(plant.site.execute(given))
        await plant.forward(seconds=3)
    await settle()

    with pytest.raises(CommandRejected, match="ago"):
        await waiting
    assert plant.site.model.state.name != "Late"


class StalledWriter:
    """A disk that answers nobody for as long as the story likes."""

    def __init__(self) -> None:
        self.stalled = False

    async def call(self, work: Callable[[Writer], T]) -> T:
        if self.stalled:
            await asyncio.Event().wait()
        return cast(T, None)

    def post(self, work: Callable[[Writer], object]) -> bool:
        return True


async def test_stop_is_answered_although_the_disk_is_stalled(begun: Begun) -> None:
    writer = StalledWriter()
    plant = await begun(writer=writer)
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    writer.stalled = True

    await asyncio.wait_for(plant.site.execute(Order(Stop(), "technician", "T1")), PATIENCE_S)

    assert plant.happened(EventKind.STOPPED)


async def test_a_watchdog_that_a_drive_turns_out_not_to_have_is_known_from_the_first_reading_on(
    begun: Begun,
) -> None:
    """A profile promises one; what it is set to is read with everything else, and may be 0 from the start."""
    plant = await begun(wrap=WrappedDrive)
    drive = wrapped(plant, "T1")
    assert "no_watchdog" not in [one.code for one in plant.tracker().notices]
    drive.watchdog_off = True
    await plant.forward(seconds=0.2)
    assert "no_watchdog" in [one.code for one in plant.tracker().notices]
