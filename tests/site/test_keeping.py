"""What a site writes down: settings before it answers, events and recordings behind the loop."""

from collections.abc import AsyncIterator, Callable
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TypeVar, cast

import numpy as np
import pytest

from app.link.messages import (
    AddTracker,
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
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter, StoreFailed, Writer
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

T = TypeVar("T")
SOLSTICE = datetime(2028, 6, 21, 3, tzinfo=UTC)
PLAN = ShowPlan(
    "solstice",
    datetime(2026, 6, 21, 2, 10, tzinfo=UTC),
    datetime(2026, 6, 21, 17, 20, tzinfo=UTC),
    timedelta(minutes=3),
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
def url(tmp_path: Path) -> str:
    found = f"sqlite:///{tmp_path / 'heliopanel.db'}"
    upgrade(found)
    return found


@pytest.fixture
async def kept(url: str) -> AsyncIterator[tuple[Plant, ImmediateWriter]]:
    store = open_writer(url)
    writer = ImmediateWriter(store)
    beginning = begin(store, SUMMER_NOON, unclean_since=None)
    plant = make_plant(writer=writer, state=beginning.site, trackers=beginning.trackers)
    await plant.start()
    yield plant, writer
    await plant.close()
    store.close()


async def test_what_was_acknowledged_is_on_disk(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, writer = kept
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    site = writer.writer.site()
    assert site is not None
    assert site.location == SAMSUN
    assert StepName.LOCATION in site.confirmations

    await plant.track()
    (stored,) = writer.writer.trackers()
    assert stored.memory.tracking_on
    assert stored.memory.home is not None

    await plant.ask(Stop())
    assert writer.writer.trackers()[0].memory.tracking_on is False
    kinds = [entry.event.kind for entry in writer.writer.journal(JournalFilter(limit=50))]
    assert {EventKind.LOCATION_SET, EventKind.TRACKING_STARTED, EventKind.STOPPED} <= set(kinds)


async def test_what_cannot_be_stored_is_not_done(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, writer = kept
    await plant.commission()
    await plant.ask(SelectMode(Mode.DUAL))
    before = plant.site.model.state
    writer.full = True

    for command in (SetLocation(SAMSUN, "UTC"), Track(), AddTracker(TrackerConfig("T2", "Two"))):
        with pytest.raises(CommandRejected) as refused:
            await plant.ask(command)
        assert refused.value.reasons[0].code == "not_stored"
    await plant.ask(Stop())
    await plant.forward(seconds=2)

    assert plant.site.model.state == before
    assert not plant.tracker().tracking_on
    assert not plant.site.model.tracker("T1").moving
    assert list(plant.site.model.loops) == ["T1"]


async def test_a_jog_that_cannot_be_recorded_ends_with_its_lease_and_the_next_one_is_refused(
    kept: tuple[Plant, ImmediateWriter],
) -> None:
    plant, writer = kept
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


async def test_a_stop_on_a_full_disk_is_stored_as_soon_as_there_is_room(
    kept: tuple[Plant, ImmediateWriter],
) -> None:
    plant, writer = kept
    await plant.track()
    writer.full = True
    await plant.ask(Stop())
    await plant.forward(seconds=3)
    assert writer.writer.trackers()[0].memory.tracking_on

    writer.full = False
    await plant.forward(seconds=3)

    assert not writer.writer.trackers()[0].memory.tracking_on


async def test_trackers_come_and_go_on_disk(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, writer = kept
    await plant.ask(AddTracker(TrackerConfig("T2", "Two")))
    assert [state.config.tracker_id for state in writer.writer.trackers()] == ["T1", "T2"]

    await plant.ask(RemoveTracker("T2"))
    assert [state.config.tracker_id for state in writer.writer.trackers()] == ["T1"]


def in_phase(phase: ShowPhase) -> Callable[[Snapshot], bool]:
    return lambda seen: seen.show is not None and seen.show.phase is phase


async def test_a_show_is_recorded_from_its_first_frame_to_its_last(
    kept: tuple[Plant, ImmediateWriter],
) -> None:
    plant, writer = kept
    await plant.commission()
    await plant.ask(SavePlan("T1", PLAN))
    await plant.ask(GoToStart(PLAN))
    await plant.until(in_phase(ShowPhase.READY))
    await plant.ask(RunShow(PLAN))
    await plant.until(lambda seen: seen.show is None, within_s=200)
    await plant.forward(seconds=3)

    (info,) = writer.writer.recordings(kind=RecordingKind.SHOW)
    frames = writer.writer.frames(info.recording_id)
    assert info.ended_at is not None
    assert info.location == SAMSUN
    assert len(frames) == pytest.approx(1800, abs=20)
    assert frames.column("elapsed_s")[0] <= 0.1
    assert frames.column("elapsed_s")[-1] == pytest.approx(180.0, abs=0.3)
    assert frames.column("sun_time_s")[-1] == pytest.approx(54_600.0, abs=120.0)
    assert np.all(np.diff(frames.column("sun_time_s")) >= 0.0)
    assert np.all(np.diff(frames.column("elapsed_s")) > 0.07)
    assert writer.writer.show("solstice") is not None


async def test_a_show_that_is_stopped_ends_its_recording(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, writer = kept
    await plant.commission()
    await plant.ask(GoToStart(PLAN))
    await plant.until(in_phase(ShowPhase.READY))
    await plant.ask(RunShow(PLAN))
    await plant.forward(seconds=5)
    await plant.ask(Stop())
    await plant.forward(seconds=3)

    (info,) = writer.writer.recordings(kind=RecordingKind.SHOW)
    assert info.ended_at is not None
    assert info.sample_count == pytest.approx(50, abs=5)


async def test_days_are_recorded_at_one_frame_a_second_and_change_at_local_midnight(
    kept: tuple[Plant, ImmediateWriter],
) -> None:
    plant, writer = kept
    await plant.commission()
    midnight = datetime(2027, 6, 21, 21, tzinfo=UTC)
    plant.clock.move_to(midnight - timedelta(seconds=10))
    await plant.forward(seconds=30)

    newest, older = writer.writer.recordings(kind=RecordingKind.DAY)
    assert newest.sun_start == pytest.approx(midnight, abs=timedelta(seconds=0.2))
    assert older.outcome == "completed"
    assert older.sun_end == midnight
    frames = writer.writer.frames(newest.recording_id)
    assert np.diff(frames.column("elapsed_s")) == pytest.approx(np.ones(len(frames) - 1), abs=0.11)


async def test_no_day_is_recorded_before_place_and_time_are_set(
    kept: tuple[Plant, ImmediateWriter],
) -> None:
    plant, writer = kept
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    await plant.forward(seconds=3)
    assert not writer.writer.recordings(kind=RecordingKind.DAY)

    await plant.ask(SetClock("manual", SOLSTICE))
    await plant.forward(seconds=3)
    (day,) = writer.writer.recordings(kind=RecordingKind.DAY)
    assert day.began_at == pytest.approx(SOLSTICE, abs=timedelta(seconds=1))


async def test_a_simulation_can_be_saved_and_deleted(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, writer = kept
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
    await plant.ask(SaveRecording(info, encoded(frames)))
    assert len(writer.writer.frames(info.recording_id)) == len(frames)

    await plant.ask(DeleteRecording(info.recording_id))
    assert writer.writer.recording(info.recording_id) is None
    with pytest.raises(UnknownRecording):
        await plant.ask(DeleteRecording(info.recording_id))


async def test_a_running_recording_cannot_be_deleted(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, writer = kept
    await plant.commission()
    await plant.forward(seconds=3)
    (day,) = writer.writer.recordings(kind=RecordingKind.DAY)

    with pytest.raises(CommandRejected, match="still running"):
        await plant.ask(DeleteRecording(day.recording_id))


async def test_damaged_chunks_are_refused(kept: tuple[Plant, ImmediateWriter]) -> None:
    plant, _ = kept
    begin_at = datetime(2026, 6, 21, 8, tzinfo=UTC)
    info, _frames = simulate(
        TrackerConfig("T1", "One"), Pointing(), SAMSUN, "UTC", Mode.DUAL, Orientation(0.0, 0.0),
        begin_at, begin_at + timedelta(minutes=1),
    )  # fmt: skip

    with pytest.raises((ValueError, CommandRejected)):
        await plant.ask(SaveRecording(info, ("bm90IGEgY2h1bms=",)))


async def test_tracking_resumes_after_a_restart_with_a_trusted_zero(url: str, begun: Begun) -> None:
    store = open_writer(url)
    first = make_plant(writer=ImmediateWriter(store))
    await first.start()
    await first.track(until=lambda seen: seen.in_position)
    drive = first.drives["T1"]
    await first.close()
    beginning = begin(store, first.clock.now(), unclean_since=None)

    again = await begun(
        start=first.clock.now(),
        writer=ImmediateWriter(store),
        state=beginning.site,
        trackers=beginning.trackers,
        wrap=lambda _: drive,
    )
    await again.forward(seconds=1)

    assert again.tracker().tracking_on
    assert again.happened(EventKind.TRACKING_RESUMED)
    store.close()


async def test_a_restart_after_a_crash_says_what_happened(url: str, begun: Begun) -> None:
    store = open_writer(url)
    writer = ImmediateWriter(store)
    plant = await begun(writer=writer)
    await plant.commission()
    await plant.forward(seconds=5)
    writer.full = True
    began = plant.clock.now() - timedelta(minutes=5)

    beginning = begin(store, plant.clock.now(), unclean_since=began)

    (event,) = beginning.events
    assert event.kind is EventKind.CONTROLLER_STARTED
    assert "ended unexpectedly" in event.message
    assert event.data["clean"] is False
    assert len(event.data["cut_off"]) == 1
    closed = store.recording(event.data["cut_off"][0])
    assert closed is not None
    assert closed.outcome == CUT_OFF
    store.close()


async def test_an_empty_store_begins_with_one_simulated_tracker(url: str) -> None:
    store = open_writer(url)
    beginning = begin(store, SUMMER_NOON, unclean_since=None)

    assert [state.config.tracker_id for state in beginning.trackers] == ["T1"]
    assert "again" not in beginning.events[0].message
    again = begin(store, SUMMER_NOON, unclean_since=None)
    assert replace(again, events=()) == replace(beginning, events=())
    store.close()


async def test_the_real_writer_thread_keeps_the_order_of_changes(url: str) -> None:
    store = open_writer(url)
    failures: list[Exception] = []
    thread = WriterThread(store, failures.append)
    plant = make_plant(writer=thread)
    await plant.start()
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    for _ in range(20):
        await plant.ask(Stop())
    await plant.close()

    assert thread.close()
    assert failures == []
    assert (
        len([e for e in store.journal(JournalFilter(limit=100)) if e.event.kind is EventKind.STOPPED]) == 20
    )
    store.close()
