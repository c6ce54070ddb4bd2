"""The weather of a simulated day: steps by the civil clock, scenarios, and what cannot be read."""

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest

from app.tracker.weather.simulated_weather import Scenario
from app.tracker.weather.weather_day import (
    day_of_scenario,
    midnight_before,
    read_steps,
    stepped_day,
)

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
    ],
)
def test_what_cannot_be_read_says_why(text: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        stepped_day(read_steps(text), MIDNIGHT, ISTANBUL)


def test_a_day_of_steps_is_no_scenario() -> None:
    with pytest.raises(ValueError, match="given in steps"):
        day_of_scenario(Scenario.MANUAL, "12:00", 1, MIDNIGHT, ISTANBUL)
