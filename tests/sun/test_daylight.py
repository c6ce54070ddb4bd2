"""From a sunrise to the sunset after it, and the next day that has enough of the sun."""

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from app.sun.daylight import daylight, next_daylight
from app.sun.position import Algorithm, Location, sun_position

DAY = timedelta(days=1)
HOUR = timedelta(hours=1)
SYDNEY = Location(-33.87, 151.21)
SVALBARD = Location(78.0, 15.0)
TROMSO = Location(69.65, 18.96)


def utc(year: int, month: int, day: int) -> datetime:
    return datetime(year, month, day, tzinfo=UTC)


def test_the_sunset_that_follows_a_sunrise_may_lie_on_the_next_day() -> None:
    found = daylight(Algorithm.PSA, SYDNEY, utc(2026, 11, 22), utc(2026, 11, 23))
    assert found is not None
    rise, sets = found
    assert rise.hour == 18
    assert timedelta(hours=14) < sets - rise < timedelta(hours=14, minutes=10)


def test_where_the_sun_does_not_rise_or_does_not_set_there_is_none() -> None:
    for month in (6, 12):
        assert daylight(Algorithm.PSA, SVALBARD, utc(2026, month, 21), utc(2026, month, 22)) is None


@settings(deadline=None, max_examples=20)
@given(
    latitude_deg=st.floats(-66.0, 66.0),
    longitude_deg=st.floats(-180.0, 180.0),
    day=st.integers(0, 72_000),
)
def test_between_the_two_the_sun_is_up(latitude_deg: float, longitude_deg: float, day: int) -> None:
    place, begin = Location(latitude_deg, longitude_deg), utc(1901, 2, 1) + timedelta(days=day)
    found = daylight(Algorithm.PSA, place, begin, begin + DAY)
    assume(found is not None)
    assert found is not None
    rise, sets = found
    length = sets - rise
    for part in (0.001, 0.3, 0.5, 0.7, 0.999):
        assert sun_position(Algorithm.PSA, place, rise + part * length).is_up
    for outside in (rise - timedelta(seconds=1), sets + timedelta(seconds=1)):
        assert not sun_position(Algorithm.PSA, place, outside).is_up


def test_after_the_polar_night_the_next_daylight_is_weeks_away() -> None:
    found = next_daylight(Algorithm.PSA, TROMSO, utc(2026, 12, 1))
    assert found is not None
    assert utc(2027, 1, 14) < found < utc(2027, 1, 20)
    day = found.replace(hour=0, minute=0, second=0, microsecond=0)
    lit = daylight(Algorithm.PSA, TROMSO, day, day + DAY)
    assert lit is not None
    assert lit[1] - lit[0] >= HOUR
    before = daylight(Algorithm.PSA, TROMSO, day - DAY, day)
    assert before is None or before[1] - before[0] < HOUR + timedelta(minutes=40)


@pytest.mark.parametrize("at", [utc(2099, 12, 31), utc(2099, 12, 31).replace(hour=23, minute=59)])
def test_beyond_the_years_that_are_known_there_is_none(at: datetime) -> None:
    assert next_daylight(Algorithm.PSA, SVALBARD, at) is None
