"""What is written behind the loop: together, in order, and before what is waited for."""

from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.link.messages import StopAll
from app.link.weather_orders import ReportWeather
from app.site.recording.gathering import EVERY, LONGEST_WAY_S, LOOKED_EVERY_S, GiveWay, Waiting
from app.site.recording.write_queue import Ledger
from app.store.store import JournalFilter, StoreFailed, Writer
from app.store.writer import DatabaseWriter
from app.tracker.protections.words import Protection
from app.tracker.state.snapshot import ActivityName, Event, EventKind
from app.tracker.weather.weather import Weather
from tests.amount import amount
from tests.site.plant import SUMMER_NOON, settle
from tests.site.test_sample_batches import CountingWriter
from tests.site.tracking_field import ONE_HZ, activities, field_of

FIELD = amount(50, 500)
STORM = ReportWeather(Weather(wind_mps=28.0))
MOST_TRANSACTIONS = 8


@pytest.fixture
def writer(store: DatabaseWriter) -> CountingWriter:
    return CountingWriter(store)


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock(SUMMER_NOON)


def told(number: int) -> Event:
    return Event(SUMMER_NOON, EventKind.STOPPED, "T1", f"{number}")


def journal(store: Writer) -> list[str]:
    return [one.event.message for one in store.journal(JournalFilter(after=0, limit=1000))]


async def test_what_gathers_is_stored_in_order_in_one_transaction(
    writer: CountingWriter, clock: VirtualClock
) -> None:
    ledger = Ledger(writer, clock)
    ledger.post_events((told(0),))
    await settle()
    assert journal(writer.writer) == ["0"], "what comes alone is stored at once"
    for number in range(1, 301):
        ledger.post_events((told(number),))
        await settle()
    assert writer.transactions == 1
    clock.advance(EVERY - timedelta(milliseconds=1))
    await settle()
    assert writer.transactions == 1
    clock.advance(timedelta(milliseconds=1))
    await settle()
    assert writer.transactions == 2
    assert journal(writer.writer) == [f"{number}" for number in range(301)]
    ledger.close()


async def test_what_is_waited_for_is_stored_after_everything_posted_before_it(
    writer: CountingWriter, clock: VirtualClock
) -> None:
    ledger = Ledger(writer, clock)
    for number in range(3):
        ledger.post_events((told(number),))
        await settle()
    await ledger.append((told(3),))
    assert journal(writer.writer) == ["0", "1", "2", "3"]
    ledger.close()


async def test_one_piece_that_fails_takes_no_other_with_it(
    writer: CountingWriter, clock: VirtualClock
) -> None:
    ledger = Ledger(writer, clock)
    broken = Event(SUMMER_NOON, EventKind.STOPPED, "T1", "broken", data={"no": object()})
    for event in (told(0), broken, told(1)):
        ledger.post_events((event,))
    ledger.close()
    assert "cannot be stored" in str(writer.failures[0])
    assert journal(writer.writer) == ["0", "1"]
    assert ledger.behind


async def test_a_batch_that_finds_the_disk_full_is_behind_as_a_whole(
    writer: CountingWriter, clock: VirtualClock
) -> None:
    ledger = Ledger(writer, clock)
    writer.refuses = True
    ledger.post_events((told(0),))
    ledger.post_events((told(1),))
    ledger.close()
    assert journal(writer.writer) == []
    assert ledger.behind
    assert isinstance(writer.failures[0], StoreFailed)


def test_the_writer_waits_for_a_pressed_loop_before_every_piece_and_not_for_long() -> None:
    pauses, pressed = [], iter([True, True, False, False, *[True] * 10_000])
    batch = [Waiting(print, None) for _ in range(4)]
    given = GiveWay(lambda: next(pressed), pauses.append)(batch)
    assert next(given) is batch[0]
    assert pauses == [LOOKED_EVERY_S] * 2, "until it is pressed no more"
    assert next(given) is batch[1]
    assert len(pauses) == 2
    assert list(given) == batch[2:]
    assert sum(pauses) == pytest.approx(LONGEST_WAY_S), (
        "a whole batch together, however long the loop is pressed"
    )


@pytest.mark.fault(73)
async def test_a_storm_over_a_large_field_is_a_handful_of_transactions(writer: CountingWriter) -> None:
    """Every tracker posted its own, and with 1,000 writes waiting the next were refused."""
    field = await field_of(FIELD, writer=writer, period=ONE_HZ)
    await field.forward(seconds=1.0)
    before = writer.transactions
    await field.ask(STORM)
    await field.forward(seconds=1.0)
    assert activities(field) == {ActivityName.STOWING}
    assert writer.transactions - before <= MOST_TRANSACTIONS
    started = writer.writer.journal(JournalFilter(limit=10 * FIELD, kinds=(EventKind.STOW_STARTED,)))
    assert len({one.event.tracker_id for one in started}) == FIELD
    assert all(one.memory.protection is Protection.WIND_STOW for one in writer.writer.trackers())
    await field.close()


@pytest.mark.fault(74)
async def test_stop_all_over_a_large_field_is_stored_together_before_it_is_answered(
    writer: CountingWriter,
) -> None:
    field = await field_of(FIELD, writer=writer, period=ONE_HZ)
    before = writer.transactions
    await field.ask(StopAll())
    assert writer.transactions - before <= MOST_TRANSACTIONS
    assert not any(one.memory.tracking_on for one in writer.writer.trackers())
    await field.close()
