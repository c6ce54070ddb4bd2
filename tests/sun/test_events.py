"""Rise, transit and set against NREL SPA, at every latitude."""

from datetime import UTC, datetime, timedelta
from itertools import pairwise
from zoneinfo import ZoneInfo

import pandas as pd
import pvlib
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.sun.events import PolarDay, crossings, day_events, hour_angle_deg, next_rise
from app.sun.position import RISE_ELEVATION_DEG, Algorithm, InstantRefused, Location, sun_position

DAY = timedelta(days=1)
SAMSUN = Location(41.2867, 36.33)
LONGYEARBYEN = Location(78.22, 15.65)
PRECISE = [Algorithm.PSA, Algorithm.PSA_PLUS, Algorithm.KOBLICK]
CONTINUOUS = [*PRECISE, Algorithm.KOBLICK_PARALLAX, Algorithm.SPENCER_LAMM_PHASE]

quick = st.sampled_from(CONTINUOUS)

places = st.builds(Location, st.floats(-90.0, 90.0), st.floats(-180.0, 180.0))
midnights = st.integers(-7305, 29219).map(lambda day: datetime(1970, 1, 1, tzinfo=UTC) + day * DAY)


def local_day(location: Location, year: int, month: int, day: int) -> tuple[datetime, datetime]:
    begin = datetime(year, month, day, tzinfo=UTC) - timedelta(hours=location.longitude_deg / 15.0)
    return begin, begin + DAY


@pytest.mark.parametrize("latitude_deg", [-60.0, 0.0, 41.2867])
@pytest.mark.parametrize(("month", "day"), [(3, 20), (6, 21), (12, 21)])
@pytest.mark.parametrize("algorithm", PRECISE)
@pytest.mark.fault(36)
def test_events_agree_with_spa_within_seconds(
    algorithm: Algorithm, latitude_deg: float, month: int, day: int
) -> None:
    location = Location(latitude_deg, 36.33)
    found = day_events(algorithm, location, *local_day(location, 2026, month, day))
    midnight = pd.DatetimeIndex([datetime(2026, month, day, tzinfo=UTC)])
    spa = pvlib.solarposition.sun_rise_set_transit_spa(midnight, latitude_deg, 36.33).iloc[0]
    assert found.polar is None
    assert found.rise is not None
    assert found.rise.timestamp() == pytest.approx(spa["sunrise"].timestamp(), abs=5.0)
    assert found.transit is not None
    assert found.transit.timestamp() == pytest.approx(spa["transit"].timestamp(), abs=2.0)
    assert found.set is not None
    assert found.set.timestamp() == pytest.approx(spa["sunset"].timestamp(), abs=5.0)


@settings(max_examples=60, deadline=None)
@given(location=places, begin=midnights, algorithm=quick)
def test_every_crossing_is_at_the_horizon_and_they_alternate(
    location: Location, begin: datetime, algorithm: Algorithm
) -> None:
    found = crossings(algorithm, location, begin, begin + DAY)
    for crossing in found:
        assert begin <= crossing.at < begin + DAY
        elevation_deg = sun_position(algorithm, location, crossing.at).elevation_deg
        assert elevation_deg == pytest.approx(RISE_ELEVATION_DEG, abs=1e-4)
    assert all(left.rising != right.rising for left, right in pairwise(found))
    assert all(left.at < right.at for left, right in pairwise(found))


@settings(max_examples=60, deadline=None)
@given(location=places, midnight=midnights, algorithm=quick)
def test_a_local_day_has_rise_transit_set_in_this_order_or_is_polar(
    location: Location, midnight: datetime, algorithm: Algorithm
) -> None:
    begin = midnight - timedelta(hours=location.longitude_deg / 15.0)
    found = day_events(algorithm, location, begin, begin + DAY)
    assert found.transit is None or begin <= found.transit < begin + DAY
    if found.polar:
        assert found.rise is None
        assert found.set is None
    elif abs(location.latitude_deg) < 60.0:
        assert found.rise is not None
        assert found.transit is not None
        assert found.set is not None
        assert found.rise < found.transit < found.set


@settings(max_examples=40, deadline=None)
@given(location=places, begin=midnights)
def test_the_transit_is_on_the_meridian(location: Location, begin: datetime) -> None:
    found = day_events(Algorithm.PSA, location, begin, begin + DAY)
    if found.transit is not None:
        sun = sun_position(Algorithm.PSA, location, found.transit)
        assert abs(hour_angle_deg(location, sun)) < 1e-3
        assert found.transit_elevation_deg == pytest.approx(sun.elevation_deg, abs=1e-9)


@pytest.mark.parametrize(("month", "polar"), [(6, PolarDay.DAY), (12, PolarDay.NIGHT), (3, None), (9, None)])
@pytest.mark.fault(33)
def test_polar_day_and_night_on_svalbard(month: int, polar: PolarDay | None) -> None:
    begin, end = local_day(LONGYEARBYEN, 2026, month, 21)
    assert day_events(Algorithm.PSA, LONGYEARBYEN, begin, end).polar is polar


@pytest.mark.parametrize(("month", "day", "hours"), [(3, 29, 23), (10, 25, 25)])
@pytest.mark.fault(29)
def test_days_of_daylight_saving_have_23_or_25_hours(month: int, day: int, hours: int) -> None:
    berlin = ZoneInfo("Europe/Berlin")
    begin = datetime(2026, month, day, tzinfo=berlin).astimezone(UTC)
    end = datetime(2026, month, day + 1 if month == 3 else 26, tzinfo=berlin).astimezone(UTC)
    assert end - begin == timedelta(hours=hours)
    found = day_events(Algorithm.PSA, Location(52.5, 13.4), begin, end)
    assert found.rise is not None
    assert found.set is not None
    assert begin < found.rise < found.set < end


def test_the_next_rise_may_be_tomorrow_or_never() -> None:
    assert next_rise(Algorithm.PSA, LONGYEARBYEN, datetime(2026, 12, 1, tzinfo=UTC)) is None
    after = datetime(2026, 6, 21, 12, tzinfo=UTC)
    rise = next_rise(Algorithm.PSA, SAMSUN, after)
    assert rise is not None
    assert after + timedelta(hours=14) < rise < after + timedelta(hours=15)


def test_a_day_that_ends_before_it_begins_is_refused() -> None:
    begin = datetime(2026, 6, 21, tzinfo=UTC)
    with pytest.raises(InstantRefused, match="the first before the second"):
        day_events(Algorithm.PSA, SAMSUN, begin, begin)


def test_a_day_that_begins_at_its_transit_has_the_next_one_where_days_are_short() -> None:
    begin, end = local_day(SAMSUN, 2026, 10, 1)
    noon = day_events(Algorithm.PSA, SAMSUN, begin, end).transit
    assert noon is not None
    for microseconds in range(-3, 4):
        begin = noon + timedelta(microseconds=microseconds)
        found = day_events(Algorithm.PSA, SAMSUN, begin, begin + DAY).transit
        assert found is not None
        assert begin <= found < begin + DAY


def test_a_day_just_shorter_than_from_transit_to_transit_may_have_none() -> None:
    noon = day_events(Algorithm.PSA, SAMSUN, *local_day(SAMSUN, 2026, 12, 20)).transit
    assert noon is not None
    begin = noon + timedelta(seconds=1)
    found = day_events(Algorithm.PSA, SAMSUN, begin, begin + DAY)
    assert found.transit is None
    assert found.transit_elevation_deg is None
