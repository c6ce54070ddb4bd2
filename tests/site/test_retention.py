"""What is kept gets old by the time that the machine runs: a clock that was ahead removes nothing."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from datetime import datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.base.clock import VirtualClock
from app.link.messages import SetClock
from app.site.retention import MOST_A_DAY, Limits, counted, moved
from app.site.site import SiteOptions
from app.site.startup import begin
from app.store.store import JournalFilter, Writer
from app.store.writer import DatabaseWriter
from app.tracker.memory.memory import AgesFrom, ClockSetting
from app.tracker.memory.recording import RecordingInfo, RecordingKind
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.mode import Mode
from tests.fault_result import BY_ITSELF, FaultResult
from tests.site.direct_writer import DirectWriter
from tests.site.plant import SAMSUN, SUMMER_NOON, Plant, make_plant, settle

DAY = timedelta(days=1)
LIMITS = Limits(400 * DAY, 1825 * DAY, 500)
AGES = (1825, 1775, 425, 375, 0)


@pytest.fixture
def store(store: DatabaseWriter) -> DatabaseWriter:
    """A store with an entry and a recorded day of every age."""
    begin(store, SUMMER_NOON, unclean_since=None)
    with store.together():
        for days in AGES:
            at = SUMMER_NOON - days * DAY
            store.append_events((Event(at, EventKind.STOPPED, None, f"{days} days ago"),))
            store.save_recording(day(f"{days}", at), [])
    return store


def day(recording_id: str, at: datetime) -> RecordingInfo:
    return RecordingInfo(
        recording_id, RecordingKind.DAY, "T1", "Tracker 1", "Day", at, at, at, 0.0, SAMSUN, "UTC",
        Mode.DUAL, 0.0, 0.0, "psa", "simulated", ended_at=at + DAY / 2,
    )  # fmt: skip


@asynccontextmanager
async def life(store: Writer, at: datetime) -> AsyncIterator[Plant]:
    """Let the site live on a clock that shows this, with what is stored; nobody confirms anything."""
    site = begin(store, at, unclean_since=None).site
    state = replace(site, clock=site.clock if site.clock.source != "unset" else ClockSetting("system"))
    options = SiteOptions(retention=LIMITS)
    plant = make_plant(start=at, state=state, trackers=(), writer=DirectWriter(store), options=options)
    await plant.start()
    yield plant
    await plant.close()


async def run(plant: Plant, span: timedelta, step: timedelta = timedelta(minutes=20)) -> None:
    end = plant.clock.now() + span
    while plant.clock.now() < end:
        plant.clock.move_to(min(end, plant.clock.now() + step))
        await settle()


def kept(store: Writer) -> tuple[set[str], set[str]]:
    """Return the messages of the journal's old entries, and the recorded days."""
    entries = {one.event.message for one in store.journal(JournalFilter(limit=500))}
    return {one for one in entries if one.endswith("days ago")}, {
        one.recording_id for one in store.recordings(limit=500)
    }


@pytest.mark.fault(101)
@pytest.mark.parametrize("ahead_days", [405, 26_000])
async def test_a_start_with_the_clock_ahead_removes_nothing(
    store: DatabaseWriter, ahead_days: int, fault: FaultResult
) -> None:
    async with life(store, SUMMER_NOON) as plant:
        await run(plant, timedelta(hours=2))
    before = kept(store)
    for _ in range(3):
        async with life(store, SUMMER_NOON + ahead_days * DAY) as plant:
            await run(plant, timedelta(hours=2))
    assert kept(store) == before
    async with life(store, SUMMER_NOON + DAY) as plant:
        await run(plant, 2 * DAY)
    assert "1825 days ago" not in kept(store)[0], "what is too old goes on the right clock"
    assert "1775 days ago" in kept(store)[0]
    fault.prevented("age counts while the controller runs")
    fault.shows_nothing("nothing is removed")
    fault.recovers(BY_ITSELF)


async def test_a_clock_that_is_typed_years_ahead_and_confirmed_removes_a_day_or_two(
    store: DatabaseWriter,
) -> None:
    before = kept(store)
    async with life(store, SUMMER_NOON) as plant:
        await plant.ask(SetClock("manual", SUMMER_NOON + 3653 * DAY))
        await run(plant, timedelta(hours=23))
        assert kept(store) == before, "nothing goes before a day of running"
        await run(plant, timedelta(hours=2))
    journal, days = kept(store)
    assert before[0] - journal == {"1825 days ago"}
    assert len(days) == len([one for one in AGES if one < 400])


async def test_what_is_too_old_goes_after_a_day_of_running_in_several_lives(store: DatabaseWriter) -> None:
    at = SUMMER_NOON
    for _ in range(5):
        async with life(store, at) as plant:
            assert "1825 days ago" in kept(store)[0]
            await run(plant, timedelta(hours=5, minutes=30))
        at += DAY
    journal, days = kept(store)
    assert "1825 days ago" not in journal
    assert "425" not in days
    assert "375" in days
    said = [one.event for one in store.journal(JournalFilter(limit=500))]
    assert "Retention removed 1 journal entries" in next(
        one.message for one in said if one.kind is EventKind.JOURNAL_PRUNED
    )


async def test_what_an_order_changes_meanwhile_is_not_stored_over(store: DatabaseWriter) -> None:
    async with life(store, SUMMER_NOON) as plant:
        async with plant.site.model.changing:
            before = plant.site.model.state
            await run(plant, timedelta(hours=3))
            assert plant.site.model.state is before
        await run(plant, timedelta(minutes=20))
        ages = plant.site.model.state.ages_from
    assert ages is not None
    assert ages.ran_s == timedelta(hours=3, minutes=20).total_seconds(), (
        "what ran meanwhile counts all the same"
    )


async def test_the_first_start_notes_from_when_age_counts(store: DatabaseWriter) -> None:
    """A start with the clock ahead that ends within the hour leaves an entry of that time behind."""
    site, before, ahead = store.site(), kept(store), SUMMER_NOON + 3650 * DAY
    assert site is not None
    store.save_site(replace(site, ages_from=None))
    async with life(store, ahead) as plant:
        await run(plant, timedelta(minutes=40))
    store.append_events((Event(ahead, EventKind.STOPPED, None, "ahead"),))
    async with life(store, ahead) as plant:
        await run(plant, timedelta(hours=25))
    assert before[0] - kept(store)[0] == {"1825 days ago"}


async def test_on_a_clock_that_is_not_trusted_nothing_gets_older(store: DatabaseWriter) -> None:
    at = datetime(1971, 1, 1, tzinfo=SUMMER_NOON.tzinfo)
    before = kept(store)
    async with life(store, at) as plant:
        assert plant.site.model.timekeeper.reasons()
        await run(plant, DAY + timedelta(hours=1))
        ages = plant.site.model.state.ages_from
    assert kept(store) == before
    assert ages is not None
    assert ages.ran_s == 0.0


@given(
    st.lists(
        st.tuples(
            st.timedeltas(timedelta(0), timedelta(hours=30)),
            st.integers(-20_000, 26_000).map(lambda days: SUMMER_NOON + days * DAY),
        )
    )
)
def test_whatever_clocks_show_nothing_gets_older_faster_than_twice_the_time_that_runs(
    spans: list[tuple[timedelta, datetime]],
) -> None:
    ages, ran, steady = AgesFrom(SUMMER_NOON), timedelta(0), VirtualClock(SUMMER_NOON)
    for span, shown in spans:
        steady.advance(span)
        ran += span
        ages = counted(ages, span)
        ages = moved(ages, shown) or ages
        assert ages.at <= SUMMER_NOON + MOST_A_DAY * ran
