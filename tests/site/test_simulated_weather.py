"""A site with a made-up weather station: it moves simulated trackers, is marked, and leaves no trace."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.link.messages import AddTracker, ConfigureTracker
from app.link.weather_orders import ReportWeather, SetMetStation, SimulateWeather
from app.site.weather.weather import WeatherStation
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import MetStation
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.weather.simulated_weather import Scenario, SimulatedStation
from app.tracker.weather.weather import Quality, Weather, WeatherNow
from app.tracker.weather.weather_windows import WeatherWindows
from tests.site.plant import SUMMER_NOON, Begun, Plant
from tests.site.test_weather import known
from tests.site.test_weather_quality import at, quality, report

REAL = DriveConfig(DriveKind.MODBUS_TCP, host="10.0.0.5")
STORM = SimulatedStation(Scenario.STORM, seed=3)


async def weather(plant: Plant) -> WeatherNow:
    await plant.forward(seconds=0.6)
    return known(plant)


async def test_made_up_weather_stows_and_says_so_and_what_it_did_ends_with_it(tracked: Plant) -> None:
    await tracked.ask(SimulateWeather(SimulatedStation(wind_mps=25.0, snow_kg=1.0)))
    seen = await weather(tracked)
    assert (seen.simulated, seen.source) == (True, "SIMULATED station (manual)")
    assert seen.readings.snow_kg == 1.0
    await tracked.until(lambda tracker: tracker.activity is ActivityName.STOWING)
    protection = tracked.tracker().protection
    assert protection is not None
    assert protection.reason.message.endswith("m/s. The reading is SIMULATED.")
    assert [reason.message for reason in tracked.tracker().waiting] == [protection.reason.message]
    assert tracked.tracker().sensors[0].text.endswith("The reading is SIMULATED.")

    await tracked.ask(SimulateWeather(None))
    await tracked.until(lambda tracker: tracker.activity is ActivityName.TRACKING)
    tracked.clock.advance(timedelta(seconds=61))
    await tracked.forward(seconds=1)
    assert tracked.tracker().activity is ActivityName.TRACKING
    assert not any(sensor.known for sensor in tracked.tracker().sensors)
    assert tracked.site.model.state.simulated_weather is None
    told = [event.message for event in tracked.happened(EventKind.WEATHER_STATION_SET)]
    assert told == ["The weather is now SIMULATED: manual.", "The weather is no longer simulated."]


async def test_a_scenario_goes_on_after_a_restart(plant: Plant, begun: Begun) -> None:
    await plant.ask(SimulateWeather(STORM))
    state = plant.site.model.state
    assert state.simulated_weather == replace(STORM, begun_at=SUMMER_NOON)
    later = await begun(
        start=at(0), state=replace(state, simulated_weather=replace(STORM, begun_at=at(-600)))
    )
    seen = await weather(later)
    assert seen.simulated
    assert seen.readings.wind_mps is not None
    assert seen.readings.wind_mps > 10.0


async def test_what_is_measured_is_not_taken_beside_it_and_takes_its_place_by_an_order(plant: Plant) -> None:
    await plant.ask(SimulateWeather(SimulatedStation(wind_mps=6.0)))
    with pytest.raises(CommandRejected, match="measured weather is not accepted"):
        await plant.ask(ReportWeather(Weather(wind_mps=3.0)))
    await plant.ask(SetMetStation(None))
    assert (await weather(plant)).simulated, "reading no station does not end what is made up"
    await plant.ask(SetMetStation(MetStation("10.0.0.9")))
    assert plant.site.model.weather.now(plant.clock.now()) is None, "nothing made up is left"
    told = await plant.ask(ReportWeather(Weather(wind_mps=3.0)))
    assert told.weather is not None
    assert not told.weather.simulated
    assert told.weather.mean_mps == 3.0


async def test_real_trackers_and_made_up_weather_exclude_each_other(plant: Plant) -> None:
    await plant.ask(SimulateWeather(STORM))
    for order in (
        AddTracker(TrackerConfig("T2", "Tracker 2", drive=REAL)),
        ConfigureTracker(TrackerConfig("T1", "Tracker 1", drive=REAL)),
    ):
        with pytest.raises(CommandRejected, match="must not move a real tracker"):
            await plant.ask(order)
    await plant.ask(SimulateWeather(None))
    await plant.ask(AddTracker(TrackerConfig("T2", "Tracker 2", drive=REAL)))
    with pytest.raises(CommandRejected, match="T2 is not simulated"):
        await plant.ask(SimulateWeather(STORM))
    assert plant.site.model.state.simulated_weather is None


def test_gust_and_mean_are_taken_over_the_windows_of_the_site() -> None:
    station = WeatherStation(WeatherWindows(gust_s=10.0, mean_s=60.0))
    for second in range(121):
        report(station, second, wind_mps=20.0 if second < 50 else 5.0 + 0.01 * second)
    seen = station.sensed(at(120))
    assert seen.wind_mean_mps == pytest.approx(5.9, abs=0.01)
    report(station, 121, wind_mps=9.0)
    report(station, 130, wind_mps=6.0)
    assert station.sensed(at(130)).wind.good == 9.0
    assert quality(station, 131) is Quality.GOOD
