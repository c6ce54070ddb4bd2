"""Samples go to the store all at once, come back where it took none, and are few bytes on the disk."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import TypeVar, cast

import numpy as np
import pytest

from app.alarms.catalogue import CATALOGUE
from app.alarms.conditions import MEGABYTE
from app.base.clock import VirtualClock
from app.link.weather_orders import ReportWeather
from app.site.recording.sample_batches import MOST_WAITING, SampleBatches
from app.site.recording.write_queue import Ledger
from app.site.site import SiteOptions
from app.site.startup import begin
from app.store.store import StoreFailed, Writer
from app.tracker.memory.recording import COLUMNS, Frames, RecordingKind
from app.tracker.state.snapshot import EventKind
from app.tracker.weather.weather import Weather
from tests.amount import amount
from tests.fault_result import FaultResult
from tests.site.plant import SUMMER_NOON, Begun, Plant
from tests.site.tracking_field import ONE_HZ, homed
from tests.store.tracked_day import MIDNIGHT, day_info, tracked_day

T = TypeVar("T")
EVERY = timedelta(seconds=300)
PAGE = 4096
BESIDE_KIB = 20.0
"""What a commit costs beside its pages in the log: the journal of ext4 12, the index of the log 8."""
MOST_KIB_A_MINUTE = {1: 20.0, 100: 600.0}


@dataclass
class FullAtTheCommit:
    """A store on a disk that turns out to be full when a transaction is to be committed."""

    writer: Writer

    def __getattr__(self, name: str) -> object:
        return getattr(self.writer, name)

    @contextmanager
    def together(self) -> Iterator[None]:
        with self.writer.together():
            yield
            raise StoreFailed("The disk is full.")


@dataclass
class CountingWriter:
    """Does every write at once, counts transactions and the pages they write, and can refuse them."""

    writer: Writer
    refuses: bool = False
    transactions: int = 0
    failures: list[Exception] = field(default_factory=list)

    async def call(self, work: Callable[[Writer], T]) -> T:
        self.transactions += 1
        return work(self.writer)

    def post(self, work: Callable[[Writer], object]) -> bool:
        self.transactions += 1
        try:
            work(cast(Writer, FullAtTheCommit(self.writer)) if self.refuses else self.writer)
        except StoreFailed as failure:
            self.failures.append(failure)
        return True


@pytest.fixture
def writer(store: Writer) -> CountingWriter:
    return CountingWriter(store)


@pytest.fixture
def batches(writer: CountingWriter) -> SampleBatches:
    return SampleBatches(Ledger(writer, VirtualClock(SUMMER_NOON)), EVERY)


def written_bytes() -> int:
    """Return how many bytes this process has handed to files so far."""
    lines = Path("/proc/self/io").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("wchar")).split()[1])


def frames_of(second: float, count: int) -> Frames:
    return tracked_day(count, begin_s=second)


def test_what_waits_goes_after_the_set_time_and_what_begins_or_ends_at_once(
    batches: SampleBatches, writer: CountingWriter
) -> None:
    now = MIDNIGHT
    assert not batches.is_due(now)
    batches.begin(day_info())
    assert batches.is_due(now)
    batches.hand_over(now)
    batches.add({"day-1": frames_of(0, 100)})
    assert not batches.is_due(now + EVERY - timedelta(seconds=1))
    assert batches.is_due(now + EVERY)
    batches.hand_over(now + EVERY)
    assert (writer.transactions, batches.samples_waiting) == (2, 0)
    batches.add({"day-1": frames_of(120, 7)})
    batches.end("day-1", now + EVERY, "completed")
    assert batches.is_due(now + EVERY)
    batches.hand_over(now + EVERY)
    stored = writer.writer.recording("day-1")
    assert stored is not None
    assert (stored.sample_count, stored.outcome, writer.transactions) == (107, "completed", 3)


def test_a_batch_that_was_not_stored_comes_back_and_goes_with_the_next(
    batches: SampleBatches, writer: CountingWriter
) -> None:
    batches.begin(day_info())
    batches.hand_over(MIDNIGHT)
    writer.refuses = True
    for number in range(3):
        batches.add({"day-1": frames_of(10.0 * number, 10)})
        batches.hand_over(MIDNIGHT)
    assert batches.ledger.behind
    assert batches.samples_waiting == 30
    assert len(writer.writer.frames("day-1")) == 0
    assert not batches.is_due(MIDNIGHT + timedelta(seconds=9))
    assert batches.is_due(MIDNIGHT + timedelta(seconds=10))
    writer.refuses = False
    batches.hand_over(MIDNIGHT)
    elapsed_s = writer.writer.frames("day-1").column("elapsed_s")
    assert np.round(elapsed_s).tolist() == list(range(30))
    assert batches.samples_waiting == 0


def test_a_disk_that_takes_nothing_costs_the_oldest_samples_and_no_more_memory(
    batches: SampleBatches, writer: CountingWriter
) -> None:
    batches.begin(day_info())
    writer.refuses = True
    for second in range(0, 2 * MOST_WAITING, 900):
        batches.add({"day-1": frames_of(second, 900)})
        batches.hand_over(MIDNIGHT)
    assert batches.samples_waiting == MOST_WAITING
    writer.refuses = False
    batches.hand_over(MIDNIGHT)
    assert round(float(writer.writer.frames("day-1").column("elapsed_s")[0])) == MOST_WAITING


def test_what_goes_along_is_stored_with_the_samples_the_newest_of_a_name(
    batches: SampleBatches, writer: CountingWriter
) -> None:
    stored: list[int] = []
    for number in range(3):
        batches.ledger.post_along("weather", lambda _writer, number=number: stored.append(number))  # type: ignore[misc]
    writer.refuses = True
    batches.hand_over(MIDNIGHT)
    writer.refuses = False
    batches.hand_over(MIDNIGHT)
    batches.hand_over(MIDNIGHT)
    assert (stored, writer.transactions) == ([2, 2], 2)


def test_samples_of_a_recording_that_does_not_run_do_not_hold_up_the_others(
    batches: SampleBatches, writer: CountingWriter
) -> None:
    batches.begin(day_info())
    too_large = Frames(np.full((1, len(COLUMNS)), 1e300))
    batches.add({"nowhere": frames_of(0, 5), "day-1": frames_of(0, 5)})
    batches.hand_over(MIDNIGHT)
    batches.begin(day_info("day-2"))
    batches.add({"day-2": too_large, "day-1": frames_of(5, 5)})
    batches.hand_over(MIDNIGHT)
    assert writer.failures == []
    assert len(writer.writer.frames("day-1")) == 10


@pytest.mark.fault(85)
@pytest.mark.parametrize("trackers", [1, 100])
def test_hours_of_samples_are_few_bytes(
    batches: SampleBatches, writer: CountingWriter, trackers: int, fault: FaultResult
) -> None:
    minutes = amount(60, 360) if trackers == 1 else amount(20, 120)
    day = tracked_day(minutes * 60, begin_s=6 * 3600.0).values
    names = [f"day-{number}" for number in range(trackers)]
    for name in names:
        batches.begin(day_info(name))
    batches.hand_over(MIDNIGHT)
    before, began = written_bytes(), writer.transactions
    for begin_s in range(0, len(day), 300):
        part = Frames(day[begin_s : begin_s + 300])
        batches.add(dict.fromkeys(names, part))
        batches.hand_over(MIDNIGHT)
    pages_kib = (written_bytes() - before) / 1024.0
    a_minute = (pages_kib + (writer.transactions - began) * BESIDE_KIB) / minutes
    assert len(writer.writer.frames("day-0")) == minutes * 60
    assert writer.transactions - began == minutes // 5
    print(f"{trackers} trackers: {a_minute:.1f} KiB a minute")
    assert a_minute <= MOST_KIB_A_MINUTE[trackers]
    fault.prevented("samples of hours are few bytes")


@pytest.fixture
async def plant(store: Writer, writer: CountingWriter, begun: Begun) -> Plant:
    """A site that is stored, whose tracker tracks."""
    made = homed(tracks=True, writer=writer, options=SiteOptions(period=ONE_HZ))
    store.save_site(made.site.model.state)
    store.save_tracker(made.site.model.tracker("T1").state)
    await begun(made)
    await made.forward(seconds=2.0)
    return made


@pytest.mark.fault(85)
async def test_a_site_that_tracks_writes_once_in_the_set_time(
    plant: Plant, writer: CountingWriter, fault: FaultResult
) -> None:
    await plant.ask(ReportWeather(Weather(wind_mps=3.0)), None)
    await plant.forward(seconds=60.0)
    before, began = written_bytes(), writer.transactions
    for second in range(amount(310, 600)):
        await plant.ask(ReportWeather(Weather(wind_mps=3.0 + second % 10 / 10)), None)
        await plant.forward(seconds=1.0)
    transactions = writer.transactions - began
    a_minute = ((written_bytes() - before) / 1024.0 + transactions * BESIDE_KIB) / amount(5.2, 10.0)
    samples = amount(1, 2)
    assert samples <= transactions <= samples + 1, "and at most one look at the audit's last entry"
    assert a_minute <= MOST_KIB_A_MINUTE[1]
    fault.shows_nothing("no user has to do anything")
    fault.recovers("nothing was lost")


@pytest.mark.fault(49)
async def test_a_disk_with_hardly_any_room_is_spared_samples(
    store: Writer, fault: FaultResult, begun: Begun
) -> None:
    counting, free = CountingWriter(store), [49 * MEGABYTE]
    beginning = begin(store, SUMMER_NOON, unclean_since=None)
    options = SiteOptions(disk_free=lambda: free[0], samples_every=timedelta(seconds=2))
    plant = await begun(writer=counting, state=beginning.site, trackers=beginning.trackers, options=options)
    await plant.forward(seconds=12)
    await plant.commission()
    await plant.forward(seconds=12)
    (day,) = store.recordings(kind=RecordingKind.DAY)
    assert day.sample_count == 0
    raised = next(one for one in plant.happened(EventKind.ALARM_RAISED) if one.data["code"] == "disk_full")
    consequence = CATALOGUE["disk_full"].consequence
    assert "No more samples are recorded" in consequence
    fault.shows(f"{raised.message} {consequence}")
    free[0] = 90 * MEGABYTE
    await plant.forward(seconds=60)
    assert store.frames(day.recording_id).column("elapsed_s").size > 5


@dataclass
class HungWriter(CountingWriter):
    """Takes everything, and from some moment on nothing of it is ever done."""

    hangs: bool = False

    def post(self, work: Callable[[Writer], object]) -> bool:
        return True if self.hangs else super().post(work)


async def test_a_disk_that_hangs_costs_the_oldest_samples_and_no_more_memory(
    store: Writer, monkeypatch: pytest.MonkeyPatch, begun: Begun
) -> None:
    monkeypatch.setattr("app.site.recording.recorder.MOST_WAITING", 60)
    writer = HungWriter(store)
    plant = await begun(homed(writer=writer))
    await plant.forward(seconds=2.0)
    recorder = plant.site.model.recorder
    writer.hangs = True
    recorder.flush(plant.clock.now(), at_once=True)
    under_way = recorder.samples_waiting
    await plant.forward(seconds=75.0)
    assert recorder.samples_waiting == under_way + 60


async def test_while_recording_is_suspended_no_sample_is_kept(plant: Plant, writer: CountingWriter) -> None:
    recorder = plant.site.model.recorder
    recorder.flush(plant.clock.now(), at_once=True)
    (day,) = writer.writer.recordings(kind=RecordingKind.DAY)
    kept = day.sample_count
    for why in ("disk", "load"):
        recorder.suspend(why)
    recorder.resume("load")
    await plant.forward(seconds=10.0)
    recorder.flush(plant.clock.now(), at_once=True)
    assert len(writer.writer.frames(day.recording_id)) == kept
    recorder.resume("disk")
    await plant.forward(seconds=10.0)
    recorder.flush(plant.clock.now(), at_once=True)
    assert len(writer.writer.frames(day.recording_id)) == pytest.approx(kept + 10, abs=2)
