"""Whether a value of the weather may be relied on: age, gusts and means, frozen and impossible sensors."""

from datetime import UTC, datetime, timedelta

import pytest

from app.link.weather_orders import ReportWeather
from app.site.weather.weather import WeatherStation
from app.tracker.protections.words import Protection
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.weather.weather import NOTHING_SENSED, Quality, Weather
from tests.site.plant import Plant

BEGIN = datetime(2026, 6, 21, 6, tzinfo=UTC)


def at(seconds: float) -> datetime:
    return BEGIN + timedelta(seconds=seconds)


def report(station: WeatherStation, seconds: float, source: str = "mast", **values: float) -> None:
    now = at(seconds)
    station.receive(Weather(**values), None, source, now, now)


def quality(station: WeatherStation, seconds: float) -> Quality:
    return station.sensed(at(seconds)).wind.quality


def test_every_quantity_has_its_own_source_and_age() -> None:
    station = WeatherStation()
    assert station.sensed(at(0)) is NOTHING_SENSED
    assert station.now(at(0)) is None
    report(station, 0, "mast", wind_mps=5.0)
    report(station, 100, "roof", irradiance_wm2=700.0)
    seen = station.now(at(110))
    assert seen is not None
    assert seen.readings == Weather(wind_mps=5.0, irradiance_wm2=700.0)
    told = {name: (one.source, one.age_s) for name, one in seen.quantities.items()}
    assert told == {"wind_mps": ("mast", 110.0), "irradiance_wm2": ("roof", 10.0)}
    later = station.now(at(350))
    assert later is not None
    assert later.readings == Weather(irradiance_wm2=700.0)
    assert later.quantities["wind_mps"].quality is Quality.STALE
    assert not later.stale


def test_the_gust_is_the_fastest_wind_of_three_seconds() -> None:
    station = WeatherStation()
    for second, wind_mps in enumerate([4.0, 9.0, 5.0, 5.1, 5.2]):
        report(station, second, wind_mps=wind_mps)
    assert station.sensed(at(4)).wind.good == 9.0
    report(station, 5, wind_mps=5.3)
    assert station.sensed(at(5)).wind.good == 5.3


def test_the_mean_is_over_ten_minutes() -> None:
    station = WeatherStation()
    for minute in range(30):
        report(station, 60.0 * minute, wind_mps=20.0 + 0.1 * minute if minute < 15 else 2.0 + 0.1 * minute)
    seen = station.sensed(at(60.0 * 29))
    assert seen.wind_mean_mps == pytest.approx(2.0 + 0.1 * 24)


@pytest.mark.parametrize(
    ("wind_mps", "turns", "expected"),
    [(4.0, False, Quality.FROZEN), (0.0, True, Quality.FROZEN), (0.0, False, Quality.GOOD)],
)
def test_a_wind_that_never_changes_is_frozen_but_calm_is_not(
    wind_mps: float, turns: bool, expected: Quality
) -> None:
    station = WeatherStation()
    for minute in range(11):
        direction_deg = 180.0 + (minute if turns else 0)
        report(station, 60.0 * minute, wind_mps=wind_mps, wind_direction_deg=direction_deg)
        if minute < 10:
            assert quality(station, 60.0 * minute) is Quality.GOOD
    assert quality(station, 600.0) is expected
    report(station, 601, wind_mps=wind_mps + 0.1)
    assert quality(station, 601) is Quality.GOOD


def test_dark_nights_and_bare_panels_are_not_frozen() -> None:
    station = WeatherStation()
    for minute in range(120):
        report(station, 60.0 * minute, irradiance_wm2=0.0, snow_kg=0.0)
    seen = station.sensed(at(60.0 * 119))
    assert (seen.light.quality, seen.snow.quality) == (Quality.GOOD, Quality.GOOD)


def test_a_jump_that_no_wind_makes_is_believed_only_when_confirmed() -> None:
    station = WeatherStation()
    report(station, 0, wind_mps=3.0)
    report(station, 1, wind_mps=95.0)
    assert quality(station, 1) is Quality.IMPOSSIBLE
    assert station.sensed(at(1)).wind.good is None
    report(station, 2, wind_mps=94.0)
    assert station.sensed(at(2)).wind.good == 94.0


def test_what_is_no_number_or_out_of_range_is_a_condition_of_its_own() -> None:
    station = WeatherStation()
    report(station, 0, wind_mps=3.0)
    station.receive(Weather(irradiance_wm2=500.0), None, "mast", at(1), at(1), impossible=("wind_mps",))
    seen = station.sensed(at(1))
    assert seen.wind.quality is Quality.IMPOSSIBLE
    assert seen.light.good == 500.0


async def test_a_reported_storm_stows_the_tracker_and_is_journalled(tracked: Plant) -> None:
    await tracked.ask(ReportWeather(Weather(wind_mps=23.0)))
    await tracked.until(lambda seen: seen.activity is ActivityName.STOWED)
    seen = tracked.tracker()
    assert seen.protection is not None
    assert seen.protection.protection is Protection.WIND_STOW
    assert seen.measured is not None
    assert seen.measured.elevation_deg == pytest.approx(90.0, abs=0.1)
    assert tracked.happened(EventKind.PROTECTION_BEGAN)
    assert tracked.site.model.tracker("T1").memory.protection is Protection.WIND_STOW
