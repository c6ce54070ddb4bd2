"""What is recorded of refusals stays small, whatever is sent."""

from datetime import UTC, datetime, timedelta

from app.access.principal import nobody
from app.access.refusals import BURST, LEFT_OUT, MOST_REMEMBERED, Refusals

NOW = datetime(2026, 11, 21, 9, tzinfo=UTC)


def test_the_same_refusal_is_recorded_once_a_minute_with_its_count() -> None:
    refusals = Refusals()
    for second in range(61):
        refusals.note("refused", nobody("10.0.0.7"), "POST /x", "No.", NOW + timedelta(seconds=second))
    told = refusals.take(NOW + timedelta(seconds=61))
    assert [one.result for one in told] == ["No.", "No. (59 more times before)"]
    assert told[0].address == "10.0.0.7"


def test_a_flood_of_a_day_from_many_addresses_is_a_few_hundred_entries() -> None:
    refusals, written = Refusals(), []
    for number in range(86_400):
        now = NOW + timedelta(seconds=number)
        refusals.note("refused", nobody(f"10.0.{number % 250}.{number % 251}"), "POST /x", "No.", now)
        if number % 60 == 0:
            written += refusals.take(now)
    assert len(written) <= BURST + 24 * 20 + 24
    left_out = [one for one in written if one.action == LEFT_OUT]
    assert len(left_out) == 24
    assert left_out[-1].result.endswith("refusals were not recorded one by one.")
    assert len(refusals._seen) <= MOST_REMEMBERED


def test_a_long_text_is_cut() -> None:
    refusals = Refusals()
    refusals.note("refused", nobody("a" * 500), "x" * 500, "y" * 5000, NOW)
    (told,) = refusals.take(NOW)
    assert (len(told.address), len(told.object), len(told.result)) == (64, 100, 300)
