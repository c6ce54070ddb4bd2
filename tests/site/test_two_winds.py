"""Two wind sensors on one site: the highest that can be relied on counts; both are told if they differ."""

from datetime import UTC, datetime, timedelta

import pytest

from app.link.messages import Order
from app.link.weather_orders import ReportWeather
from app.site.weather.weather import WeatherStation
from app.tracker.state.snapshot import ActivityName
from app.tracker.weather.weather import Quality, Weather, WeatherNow
from tests.fault_result import VIRTUAL, FaultResult
from tests.site.plant import Plant

BEGIN = datetime(2026, 6, 21, 6, tzinfo=UTC)


def at(seconds: float) -> datetime:
    return BEGIN + timedelta(seconds=seconds)


def blow(station: WeatherStation, seconds: int, **winds_mps: float) -> WeatherNow:
    """Let every sensor report once a second, with the ripple that a working one has, and look."""
    for second in range(seconds):
        for source, wind_mps in winds_mps.items():
            rippled = wind_mps + 0.01 * (second % 7)
            station.receive(Weather(wind_mps=rippled), None, source, at(second), at(second))
    seen = station.now(at(seconds - 1))
    assert seen is not None
    return seen


def test_the_highest_counts_and_both_are_shown() -> None:
    station = WeatherStation()
    seen = blow(station, 30, mast=6.0, roof=7.5)
    assert seen.disagreement is None
    assert {source: one.quality for source, one in seen.winds.items()} == {
        "mast": Quality.GOOD,
        "roof": Quality.GOOD,
    }
    assert seen.quantities["wind_mps"].source == "roof"
    assert station.sensed(at(29)).wind.good == pytest.approx(7.56)
    assert station.sensed(at(29)).wind_mean_mps == pytest.approx(7.5, abs=0.1)


@pytest.mark.parametrize(
    ("low_mps", "high_mps", "told"),
    [(1.0, 3.9, False), (1.0, 4.1, True), (15.0, 20.0, False), (10.0, 16.0, True)],
)
def test_sensors_disagree_when_their_means_are_3_mps_and_30_percent_apart(
    low_mps: float, high_mps: float, told: bool
) -> None:
    seen = blow(WeatherStation(), 90, mast=low_mps, roof=high_mps)
    assert (seen.disagreement is not None) is told


def test_a_sensor_that_is_stuck_neither_counts_nor_disagrees() -> None:
    station = WeatherStation()
    for second in range(0, 700, 10):
        station.receive(Weather(wind_mps=20.0), None, "stuck", at(second), at(second))
        rippled = Weather(wind_mps=4.0 + 0.1 * (second % 70))
        station.receive(rippled, None, "mast", at(second), at(second))
    seen = station.now(at(690))
    assert seen is not None
    assert seen.winds["stuck"].quality is Quality.FROZEN
    assert seen.quantities["wind_mps"].source == "mast"
    assert station.sensed(at(690)).wind.good is not None
    assert (station.sensed(at(690)).wind.good or 0.0) < 12.0
    assert seen.disagreement is None


def test_what_was_silent_for_an_hour_is_no_sensor_any_more() -> None:
    station = WeatherStation()
    blow(station, 10, mast=5.0, roof=5.0)
    late = at(3700)
    station.receive(Weather(wind_mps=5.2), None, "mast", late, late)
    seen = station.now(late)
    assert seen is not None
    assert set(seen.winds) == {"mast"}


@pytest.mark.fault(39)
async def test_two_sensors_that_disagree_stow_by_the_higher_and_are_told_with_both(
    tracked: Plant, fault: FaultResult
) -> None:
    plant = tracked
    for second in range(20):
        await report(plant, second, mast=6.0, roof=6.5)
    assert "wind_sensors_disagree" not in plant.alarms()

    taken_s = 0
    while "wind_sensors_disagree" not in plant.alarms():
        taken_s += 1
        assert taken_s <= 60, "a minute's mean tells it"
        await report(plant, taken_s, mast=6.0, roof=19.0)
    message = plant.alarms()["wind_sensors_disagree"]
    assert "roof shows" in message
    assert "mast" in message
    assert "m/s" in message
    fault.noticed(float(taken_s), VIRTUAL)
    fault.shows(message)
    fault.recovers("automatic: when they agree")
    await plant.until(lambda seen: seen.activity is ActivityName.STOWED)

    for second in range(80):
        await report(plant, second, mast=6.0, roof=6.5)
    assert "wind_sensors_disagree" not in plant.alarms()


async def report(plant: Plant, second: int, **winds_mps: float) -> None:
    for source, wind_mps in winds_mps.items():
        reading = Weather(wind_mps=wind_mps + 0.01 * (second % 7))
        await plant.site.execute(Order(ReportWeather(reading), source))
    await plant.forward(seconds=1.0)
