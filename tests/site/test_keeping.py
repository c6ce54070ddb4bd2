"""What a site writes down: settings before it answers, events and recordings behind the loop."""

from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from typing import TypeVar, cast

import numpy as np
import pytest

from app.link.messages import (
    AddTracker,
    ConfirmStep,
    DeleteRecording,
    RemoveTracker,
    RequestControl,
    SavePlan,
    SaveRecording,
    SetClock,
    SetLocation,
    UnknownRecording,
)
from app.show.simulate import encoded, simulate
from app.site.startup import CUT_OFF, begin
from app.store.store import AuditFilter, JournalFilter, StoreFailed, Writer
from app.store.writer import DatabaseWriter
from app.store.writer_thread import WriterThread
from app.tracker.commands.commands import CommandRejected, GoToStart, Jog, RunShow, SelectMode, Stop, Track
from app.tracker.memory.memory import Pointing, StepName
from app.tracker.memory.recording import RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.snapshot import EventKind, ShowPhase, Snapshot
from app.tracker.values.mode import Mode
from tests.site.plant import SAMSUN, SUMMER_NOON, Begun, Plant, make_plant
from tests.site.tracking_field import homed

T = TypeVar("T")
SOLSTICE = datetime(2028, 6, 21, 3, tzinfo=UTC)
PLAN = ShowPlan(
    "solstice",
    datetime(2026, 6, 21, 2, 10, tzinfo=UTC),
    datetime(2026, 6, 21, 7, 10, tzinfo=UTC),
    timedelta(minutes=1),
    SAMSUN,
)


class FullStore:
    """A store on a full disk."""

    def __getattr__(self, name: str) -> Callable[..., None]:
        def fail(*_: object, **__: object) -> None:
            raise StoreFailed("The disk is full. Free some space.")

        return fail


class ImmediateWriter:
    """Does every write at once, in order, and can be made to fail."""

    def __init__(self, writer: Writer) -> None:
        self.writer = writer
        self.full = False

    async def call(self, work: Callable[[Writer], T]) -> T:
        if self.full:
            raise StoreFailed("The disk is full. Free some space.")
        return work(self.writer)

    def post(self, work: Callable[[Writer], object]) -> bool:
        with suppress(StoreFailed):
            work(cast(Writer, FullStore()) if self.full else self.writer)
        return True


@pytest.fixture
def writer(store: DatabaseWriter) -> ImmediateWriter:
    return ImmediateWriter(store)


@pytest.fixture
async def plant(writer: ImmediateWriter, begun: Begun) -> Plant:
    """A site that is stored, whose tracker is homed."""
    made = homed(writer=writer)
    writer.writer.save_site(made.site.model.state)
    writer.writer.save_tracker(made.site.model.tracker("T1").state)
    return await begun(made)


async def test_what_was_acknowledged_is_on_disk(plant: Plant, writer: ImmediateWriter) -> None:
    await plant.ask(SetLocation(SAMSUN, "UTC"))
    site = writer.writer.site()
    assert site is not None
    assert (site.location, site.time_zone) == (SAMSUN, "UTC")
    assert StepName.LOCATION in site.confirmations

    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    (stored,) = writer.writer.trackers()
    assert stored.memory.tracking_on
    assert stored.memory.home is not None

    await plant.ask(Stop())
    assert writer.writer.trackers()[0].memory.tracking_on is False
    kinds = [entry.event.kind for entry in writer.writer.journal(JournalFilter(limit=50))]
    assert {EventKind.LOCATION_SET, EventKind.TRACKING_STARTED, EventKind.STOPPED} <= set(kinds)

    await plant.ask(AddTracker(TrackerConfig("T2", "Two")))
    assert [state.config.tracker_id for state in writer.writer.trackers()] == ["T1", "T2"]
    await plant.ask(RemoveTracker("T2"))
    assert [state.config.tracker_id for state in writer.writer.trackers()] == ["T1"]


async def test_what_cannot_be_stored_is_not_done_but_a_stop_which_is_stored_later(
    plant: Plant, writer: ImmediateWriter
) -> None:
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    site, memory = plant.site.model.state, plant.site.model.tracker("T1").memory
    writer.full = True
    for command in (
        SetLocation(SAMSUN, "UTC"),
        SelectMode(Mode.FIXED, Orientation(10.0, 10.0)),
        AddTracker(TrackerConfig("T2", "Two")),
        ConfirmStep("T1", StepName.HOMING),
    ):
        with pytest.raises(CommandRejected) as refused:
            await plant.ask(command)
        assert refused.value.reasons[0].code == "not_stored"
    assert plant.site.model.state == site
    assert plant.site.model.tracker("T1").memory == memory
    assert list(plant.site.model.loops) == ["T1"]

    await plant.ask(Stop())
    await plant.forward(seconds=3)
    assert not plant.tracker().tracking_on
    assert not plant.site.model.tracker("T1").moving
    assert writer.writer.trackers()[0].memory.tracking_on
    writer.full = False
    await plant.forward(seconds=3)
    assert not writer.writer.trackers()[0].memory.tracking_on


async def test_a_jog_that_cannot_be_recorded_ends_with_its_lease_and_the_next_one_is_refused(
    plant: Plant, writer: ImmediateWriter
) -> None:
    await plant.ask(RequestControl(("T1",)))
    writer.full = True
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))

    with pytest.raises(CommandRejected, match="cannot be recorded"):
        await plant.ask(Jog("p1", Axis.AZIMUTH, 1, sequence=1))
    await plant.forward(seconds=1)
    assert not plant.site.model.tracker("T1").moving
    with pytest.raises(CommandRejected, match="cannot be recorded"):
        await plant.ask(Jog("p2", Axis.AZIMUTH, 1))

    writer.full = False
    await plant.forward(seconds=3)
    await plant.ask(Jog("p3", Axis.AZIMUTH, 1))
    await plant.forward(seconds=0.1)
    assert plant.site.model.tracker("T1").moving


def in_phase(phase: ShowPhase) -> Callable[[Snapshot], bool]:
    return lambda seen: seen.show is not None and seen.show.phase is phase


async def test_a_show_is_recorded_from_its_first_frame_to_its_last_or_to_a_stop(
    plant: Plant, writer: ImmediateWriter
) -> None:
    await plant.ask(SavePlan("T1", PLAN))
    await plant.ask(GoToStart(PLAN))
    await plant.until(in_phase(ShowPhase.READY))
    await plant.ask(RunShow(PLAN))
    await plant.until(lambda seen: seen.show is None, within_s=80)
    await plant.forward(seconds=3)

    (info,) = writer.writer.recordings(kind=RecordingKind.SHOW)
    frames = writer.writer.frames(info.recording_id)
    assert info.ended_at is not None
    assert info.location == SAMSUN
    assert len(frames) == pytest.approx(600, abs=20)
    assert frames.column("elapsed_s")[0] <= 0.1
    assert frames.column("elapsed_s")[-1] == pytest.approx(60.0, abs=0.3)
    assert frames.column("sun_time_s")[-1] == pytest.approx(18_000.0, abs=120.0)
    assert np.all(np.diff(frames.column("sun_time_s")) >= 0.0)
    assert np.all(np.diff(frames.column("elapsed_s")) > 0.07)
    assert writer.writer.show("solstice") is not None

    await plant.ask(GoToStart(PLAN))
    await plant.until(in_phase(ShowPhase.READY))
    await plant.ask(RunShow(PLAN))
    await plant.forward(seconds=5)
    await plant.ask(Stop())
    await plant.forward(seconds=3)
    stopped, _ = writer.writer.recordings(kind=RecordingKind.SHOW)
    assert stopped.ended_at is not None
    assert stopped.sample_count == pytest.approx(50, abs=5)


async def test_days_are_recorded_at_one_frame_a_second_and_change_at_local_midnight(
    plant: Plant, writer: ImmediateWriter
) -> None:
    midnight = datetime(2027, 6, 21, 21, tzinfo=UTC)
    plant.clock.move_to(midnight - timedelta(seconds=10))
    await plant.forward(seconds=30)

    newest, older = writer.writer.recordings(kind=RecordingKind.DAY)
    assert newest.sun_start == pytest.approx(midnight, abs=timedelta(seconds=0.2))
    assert older.outcome == "completed"
    assert older.sun_end == midnight
    frames = writer.writer.frames(newest.recording_id)
    assert np.diff(frames.column("elapsed_s")) == pytest.approx(np.ones(len(frames) - 1), abs=0.11)


async def test_no_day_is_recorded_before_place_and_time_are_set_nor_deleted_while_it_runs(
    writer: ImmediateWriter, begun: Begun
) -> None:
    plant = await begun(writer=writer)
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    await plant.forward(seconds=3)
    assert not writer.writer.recordings(kind=RecordingKind.DAY)

    await plant.ask(SetClock("manual", SOLSTICE))
    await plant.forward(seconds=3)
    (day,) = writer.writer.recordings(kind=RecordingKind.DAY)
    assert day.began_at == pytest.approx(SOLSTICE, abs=timedelta(seconds=1))
    with pytest.raises(CommandRejected, match="still running"):
        await plant.ask(DeleteRecording(day.recording_id))


async def test_a_simulation_can_be_saved_and_deleted(plant: Plant, writer: ImmediateWriter) -> None:
    begin_at = datetime(2026, 6, 21, 8, tzinfo=UTC)
    info, frames = simulate(
        TrackerConfig("T1", "One"),
        Pointing(),
        SAMSUN,
        "UTC",
        Mode.DUAL,
        Orientation(0.0, 0.0),
        begin_at,
        begin_at + timedelta(minutes=2),
    )
    with pytest.raises((ValueError, CommandRejected)):
        await plant.ask(SaveRecording(info, ("bm90IGEgY2h1bms=",)))
    await plant.ask(SaveRecording(info, encoded(frames)))
    assert len(writer.writer.frames(info.recording_id)) == len(frames)

    await plant.ask(DeleteRecording(info.recording_id))
    assert writer.writer.recording(info.recording_id) is None
    with pytest.raises(UnknownRecording):
        await plant.ask(DeleteRecording(info.recording_id))


async def test_tracking_resumes_after_a_restart_with_a_trusted_zero(
    store: DatabaseWriter, plant: Plant, writer: ImmediateWriter
) -> None:
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    await plant.forward(seconds=1)
    drive = plant.drives["T1"]
    await plant.close()
    beginning = begin(store, plant.clock.now(), unclean_since=None)

    again = make_plant(
        start=plant.clock.now(),
        writer=writer,
        state=beginning.site,
        trackers=beginning.trackers,
        wrap=lambda _: drive,
    )
    await again.start()
    await again.forward(seconds=1)

    assert again.tracker().tracking_on
    assert again.happened(EventKind.TRACKING_RESUMED)
    await again.close()


async def test_a_restart_after_a_crash_says_what_happened(
    store: DatabaseWriter, plant: Plant, writer: ImmediateWriter
) -> None:
    await plant.forward(seconds=5)
    writer.full = True
    began = plant.clock.now() - timedelta(minutes=5)

    (event,) = begin(store, plant.clock.now(), unclean_since=began).events

    assert event.kind is EventKind.CONTROLLER_STARTED
    assert "ended unexpectedly" in event.message
    assert event.data["clean"] is False
    assert len(event.data["cut_off"]) == 1
    closed = store.recording(event.data["cut_off"][0])
    assert closed is not None
    assert closed.outcome == CUT_OFF


async def test_the_real_writer_thread_keeps_the_order_of_changes_and_the_audit(
    store: DatabaseWriter,
) -> None:
    failures: list[Exception] = []
    assert [one.config.tracker_id for one in begin(store, SUMMER_NOON, unclean_since=None).trackers] == ["T1"]
    thread = WriterThread(store, failures.append)
    plant = make_plant(writer=thread)
    await plant.start()
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    for _ in range(5):
        await plant.ask(Stop())
    await plant.close()

    assert thread.close()
    assert failures == []
    stops = JournalFilter(limit=100, kinds=(EventKind.STOPPED,))
    assert len(store.journal(stops)) == 5
    actions = [one.entry.action for one in store.audit(AuditFilter(after=0))]
    assert actions == ["set_location", *["stop"] * 5]
