"""What is recorded of refusals stays small, whatever is sent."""

from datetime import UTC, datetime, timedelta

from app.access.events import AccessEvent
from app.access.principal import nobody
from app.access.refusals import BURST, LEFT_OUT, MOST_REMEMBERED, SAME_WITHIN, TELL_EVERY, Allowance, Refusals
from tests.amount import amount

NOW = datetime(2026, 11, 21, 9, tzinfo=UTC)


def test_the_same_refusal_is_recorded_once_a_minute_with_its_count() -> None:
    refusals = Refusals()
    for second in range(61):
        refusals.note("refused", nobody("10.0.0.7"), "POST /x", "No.", NOW + timedelta(seconds=second))
    told = refusals.take(NOW + timedelta(seconds=61))
    assert [one.result for one in told] == ["No.", "No. (59 more times before)"]
    assert told[0].address == "10.0.0.7"


def test_a_flood_of_hours_from_many_addresses_is_a_few_entries() -> None:
    refusals, written, hours = Refusals(), [], amount(3, 24)
    for number in range(hours * 3600):
        now = NOW + timedelta(seconds=number)
        refusals.note("refused", nobody(f"10.0.{number % 250}.{number % 251}"), "POST /x", "No.", now)
        if number % 60 == 0:
            written += refusals.take(now)
    assert len(written) <= BURST + hours * 20 + hours
    left_out = [one for one in written if one.action == LEFT_OUT]
    assert len(left_out) == hours
    assert left_out[-1].result.endswith("refusals were not recorded individually.")
    assert len(refusals._seen) <= MOST_REMEMBERED


def test_a_long_text_is_cut() -> None:
    refusals = Refusals()
    refusals.note("refused", nobody("a" * 500), "x" * 500, "y" * 5000, NOW)
    (told,) = refusals.take(NOW)
    assert (len(told.address), len(told.object), len(told.result)) == (64, 100, 300)


def refuse(refusals: Refusals, number: int, now: datetime = NOW) -> None:
    refusals.note("refused", nobody("10.0.0.7"), f"POST /{number}", "No.", now)


def left_out(refusals: Refusals, now: datetime) -> list[AccessEvent]:
    return [one for one in refusals.take(now) if one.action == LEFT_OUT]


def test_what_is_left_out_is_counted_and_told_once_an_hour() -> None:
    refusals = Refusals()
    for number in range(BURST + 3):
        refuse(refusals, number)
    refusals.leave_out()
    refusals.leave_out()
    told = AccessEvent(
        NOW, "nobody", "nobody", "", LEFT_OUT, "panel", "5 refusals were not recorded individually."
    )
    assert refusals.take(NOW)[BURST:] == [told]
    refusals.leave_out()
    assert left_out(refusals, NOW + TELL_EVERY - timedelta(microseconds=1)) == []
    (later,) = left_out(refusals, NOW + TELL_EVERY)
    assert later.result == "1 refusals were not recorded individually."
    assert left_out(refusals, NOW + 3 * TELL_EVERY) == []


def test_repeats_of_what_is_left_out_are_left_out_with_it() -> None:
    refusals = Refusals()
    for number in range(BURST + 1):
        refuse(refusals, number)
    for _ in range(4):
        refuse(refusals, BURST)
    refuse(refusals, BURST, NOW + SAME_WITHIN)
    assert left_out(refusals, NOW + SAME_WITHIN)[0].result.startswith("6 refusals")


def test_the_same_instant_is_a_repeat_and_a_clock_that_is_set_back_none() -> None:
    refusals = Refusals()
    refuse(refusals, 1)
    refuse(refusals, 1)
    assert len(refusals.take(NOW)) == 1
    refuse(refusals, 1, NOW - timedelta(hours=1))
    (again,) = refusals.take(NOW)
    assert again.result == "No. (1 more times before)"


def test_of_very_many_the_oldest_is_forgotten_and_what_was_counted_of_it_left_out() -> None:
    refusals = Refusals()
    for _ in range(3):
        refuse(refusals, 0)
    for number in range(1, MOST_REMEMBERED):
        refuse(refusals, number)
    refuse(refusals, 0)
    before = MOST_REMEMBERED - BURST
    assert left_out(refusals, NOW)[0].result.startswith(f"{before} ")
    refuse(refusals, MOST_REMEMBERED)
    assert left_out(refusals, NOW + TELL_EVERY)[0].result.startswith("4 "), "itself, and three of the oldest"


def test_an_allowance_comes_back_bit_by_bit_up_to_its_most() -> None:
    allowance, minute = Allowance(2, timedelta(minutes=1)), timedelta(minutes=1)
    assert [allowance.take(NOW) for _ in range(3)] == [True, True, False]
    assert not allowance.take(NOW + minute / 2)
    assert allowance.take(NOW + minute)
    assert not allowance.take(NOW + minute)
    assert [allowance.take(NOW + 99 * minute) for _ in range(3)] == [True, True, False]
    assert not allowance.take(NOW + 98 * minute), "a clock that is set back gives nothing"
    assert allowance.take(NOW + 99 * minute), "and counts on from there"
