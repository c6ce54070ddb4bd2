"""Made-up weather: the same twice, within what its numbers promise, and every scenario's story."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from statistics import mean
from zoneinfo import ZoneInfo

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as some
from pvlib import clearsky

from app.sun.position import SunPosition
from app.tracker.weather.simulated_weather import (
    SPANS,
    Scenario,
    SimulatedStation,
    clear_irradiance_wm2,
    weather_at,
)
from app.tracker.weather.weather import Weather
from app.tracker.weather.weather_day import (
    day_of_scenario,
    midnight_before,
    read_steps,
    stepped_day,
)

BEGIN = datetime(2026, 6, 21, 9, tzinfo=UTC)
SUN = SunPosition(180.0, 60.0, 60.0)


def read(station: SimulatedStation, *, minutes: float = 0.0, sun: SunPosition | None = SUN) -> Weather:
    return weather_at(replace(station, begun_at=BEGIN), BEGIN + timedelta(minutes=minutes), sun)


def told(station: SimulatedStation, name: str, *, of: range, step_s: float = 1.0) -> list[float]:
    return [getattr(read(station, minutes=second * step_s / 60.0), name) for second in of]


@pytest.mark.parametrize("scenario", Scenario)
def test_the_same_seed_makes_the_same_weather_and_another_one_another(scenario: Scenario) -> None:
    station = SimulatedStation(scenario, seed=7)
    assert read(station, minutes=3.3) == read(SimulatedStation(scenario, seed=7), minutes=3.3)
    assert read(station, minutes=3.3) != read(SimulatedStation(scenario, seed=8), minutes=3.3)


def test_gusts_by_hand_exceed_the_mean_by_at_most_the_gustiness() -> None:
    winds = told(SimulatedStation(wind_mps=10.0, gustiness_pct=40.0), "wind_mps", of=range(900))
    assert mean(winds) == pytest.approx(10.0, abs=0.2)
    assert 12.5 < max(winds) <= 14.0
    assert 6.0 <= min(winds) < 7.5


def test_a_storm_comes_and_goes() -> None:
    storm = SimulatedStation(Scenario.STORM)
    assert max(told(storm, "wind_mps", of=range(120))) < 8.0
    assert max(told(storm, "wind_mps", of=range(360, 840))) > 22.0
    assert mean(told(storm, "wind_mps", of=range(360, 840))) == pytest.approx(20.0, abs=0.6)
    assert max(told(storm, "wind_mps", of=range(1500, 3600))) < 4.0


def test_clouds_pass_and_a_dark_bank_covers_the_sun_for_twenty_minutes() -> None:
    clear_wm2 = clear_irradiance_wm2(60.0)
    light = told(SimulatedStation(Scenario.CLOUDS), "irradiance_wm2", of=range(360), step_s=10.0)
    assert max(light[30:180]) / min(light[30:180]) > 1.8
    assert max(light[198:318]) < 0.02 * clear_wm2
    assert light[350] > 0.4 * clear_wm2


def test_without_a_sun_light_is_not_made_up_unless_by_hand() -> None:
    assert read(SimulatedStation(Scenario.CALM), sun=None).irradiance_wm2 is None
    assert read(SimulatedStation(irradiance_wm2=300.0), sun=None).irradiance_wm2 == pytest.approx(
        300.0, rel=0.01
    )
    assert read(SimulatedStation(), sun=SunPosition(0.0, -5.0, -5.0)).irradiance_wm2 == 0.0


def test_clear_light_is_what_pvlib_makes_of_haurwitz() -> None:
    elevations = np.array([-3.0, 0.0, 0.2, 5.0, 30.0, 72.0, 90.0])
    expected = clearsky.haurwitz(pd.Series(90.0 - elevations))["ghi"].to_numpy()
    assert [clear_irradiance_wm2(one) for one in elevations] == pytest.approx(expected, abs=1e-9)


@given(
    some.sampled_from(Scenario),
    some.integers(0, 2**31 - 1),
    some.floats(-1e4, 1e4),
    some.floats(0.0, 50.0),
    some.floats(0.0, 100.0),
    some.floats(-90.0, 90.0),
)
def test_nothing_is_ever_made_up_that_no_station_can_measure(
    scenario: Scenario, seed: int, minutes: float, wind_mps: float, gustiness_pct: float, elevation_deg: float
) -> None:
    station = SimulatedStation(scenario, seed, wind_mps, gustiness_pct, irradiance_wm2=None)
    read(station, minutes=minutes, sun=SunPosition(180.0, elevation_deg, elevation_deg))


@pytest.mark.parametrize("name", SPANS)
def test_what_is_out_of_range_is_refused_with_a_sentence(name: str) -> None:
    title, low, high, unit = SPANS[name]
    for wrong in (low - 1.0, high + 1.0, float("nan")):
        with pytest.raises(ValueError, match=f"{title} must lie between {low:g} and {high:g} {unit}"):
            SimulatedStation(**{name: wrong})
    with pytest.raises(ValueError, match="seed"):
        SimulatedStation(seed=-1)


ISTANBUL = ZoneInfo("Europe/Istanbul")
BERLIN = ZoneInfo("Europe/Berlin")
MIDNIGHT = datetime(2026, 6, 21, tzinfo=ISTANBUL)
CSV = "time, wind_mps, snow_kg\n00:30, 4, 0\n\n10:00,,6\n14:00:30,22,\n"


def test_a_step_holds_until_the_next_and_keeps_what_it_does_not_name() -> None:
    day = stepped_day(read_steps(CSV), MIDNIGHT, ISTANBUL)
    assert day.at(MIDNIGHT, None) is None, "before the first step nothing is measured"
    early = day.at(MIDNIGHT + timedelta(hours=1), None)
    snowy = day.at(MIDNIGHT + timedelta(hours=10), None)
    windy = day.at(MIDNIGHT + timedelta(hours=14, seconds=30), None)
    assert early is not None
    assert snowy is not None
    assert windy is not None
    assert early.snow_kg == 0.0
    assert snowy.snow_kg == windy.snow_kg == 6.0
    assert windy.wind_mps == pytest.approx(22.0, rel=0.31)
    assert snowy.wind_mps == pytest.approx(4.0, rel=0.31), "the wind of the step before"
    assert early.irradiance_wm2 is None, "light is that of a clear sky, and there is no sun"


def test_steps_follow_the_civil_clock_over_a_change_of_the_hour() -> None:
    midnight = datetime(2026, 3, 29, tzinfo=BERLIN)
    day = stepped_day(read_steps("time,wind_mps\n00:00,3\n06:00,9\n30:00,5"), midnight, BERLIN)
    assert [since.astimezone(UTC).isoformat() for since, _ in day.parts] == [
        "2026-03-28T23:00:00+00:00",
        "2026-03-29T04:00:00+00:00",
        "2026-03-30T04:00:00+00:00",
    ]
    assert midnight_before(datetime(2026, 3, 29, 12, tzinfo=UTC), BERLIN) == midnight


def test_a_scenario_waits_for_its_time_in_calm() -> None:
    day = day_of_scenario(Scenario.STORM, "12:00", 1, MIDNIGHT + timedelta(hours=7), ISTANBUL)
    noon = MIDNIGHT + timedelta(hours=12)
    calm, stormy = day.at(noon - timedelta(minutes=1), None), day.at(noon + timedelta(minutes=10), None)
    assert calm is not None
    assert stormy is not None
    assert calm.wind_mps is not None
    assert calm.wind_mps < 5.0
    assert stormy.wind_mps is not None
    assert stormy.wind_mps > 12.0
    assert len(day_of_scenario(Scenario.CALM, "00:00", 1, MIDNIGHT, ISTANBUL).parts) == 1


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "The weather is empty"),
        ("wind_mps\n3", "must name the columns: time and any of wind_mps"),
        ("time,time\n10:00,1", "each once"),
        ("time,wind_mps\n10:00", "Line 2 of the weather has 1 fields; there must be 2"),
        ("time,wind_mps\nnoon,3", "Line 2 of the weather: give a time such as 11:30"),
        ("time,wind_mps\n96:00,3", "give a time such as 11:30"),
        ("time,wind_mps\n10:00,fast", "wind_mps must be a number, not 'fast'"),
        ("time,wind_mps\n10:00,99", "The simulated mean wind must lie between 0 and 50"),
        ("time,wind_mps\n10:00,nan", "wind_mps must be a number, not 'nan'"),
        ("time,wind_mps\n10:00,3\n10:00,4", "must come after the one before it"),
        ("time,wind_mps", "has 1 to 500 steps"),
        (
            "time,wind_mps" + "".join(f"\n{at // 60}:{at % 60:02},3" for at in range(501)),
            "has 1 to 500 steps",
        ),
    ],
)
def test_what_cannot_be_read_says_why(text: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        stepped_day(read_steps(text), MIDNIGHT, ISTANBUL)
