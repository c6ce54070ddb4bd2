"""The site's weather: what is taken, how it ages, and that it moves nothing that is not automatic."""

from datetime import timedelta
from math import nan

import pytest

from app.link.weather_orders import ReportWeather
from app.tracker.state.snapshot import ActivityName
from app.tracker.weather.weather import RANGES, Weather
from tests.site.plant import Plant, settle


async def test_a_report_grows_old_and_stale_and_a_new_one_takes_its_place(plant: Plant) -> None:
    told = await plant.ask(ReportWeather(Weather(wind_mps=12.0)))
    assert told.weather is not None
    assert (told.weather.age_s, told.weather.stale, told.weather.source) == (0.0, False, "technician")
    await plant.forward(seconds=60)
    seen = plant.latest()
    assert seen.weather is not None
    assert seen.weather.age_s == pytest.approx(60.0, abs=0.6)
    assert seen.weather.usable == Weather(wind_mps=12.0)
    await plant.forward(seconds=245)
    seen = plant.latest()
    assert seen.weather is not None
    assert seen.weather.stale
    assert seen.weather.usable is None
    told = await plant.ask(ReportWeather(Weather(wind_mps=3.0)))
    assert told.weather is not None
    assert told.weather.usable == Weather(wind_mps=3.0)


async def test_the_age_of_a_report_counts_from_its_measurement(plant: Plant) -> None:
    measured_at = plant.site.model.now() - timedelta(seconds=100)
    told = await plant.ask(ReportWeather(Weather(irradiance_wm2=800.0), measured_at))
    assert told.weather is not None
    assert told.weather.age_s == pytest.approx(100.0)


@pytest.mark.parametrize(("off_s", "words"), [(11, "Set the station's clock"), (-301, "Send it sooner")])
async def test_reports_of_the_future_and_of_the_past_are_refused(
    plant: Plant, off_s: int, words: str
) -> None:
    measured_at = plant.site.model.now() + timedelta(seconds=off_s)
    with pytest.raises(ValueError, match=words):
        await plant.ask(ReportWeather(Weather(wind_mps=1.0), measured_at))
    await settle()
    seen = plant.latest()
    assert seen.weather is None


async def test_a_storm_moves_nothing_that_is_not_automatic(plant: Plant) -> None:
    await plant.commission()
    before = plant.tracker().measured
    await plant.ask(ReportWeather(Weather(wind_mps=45.0, snow_kg=500.0)))
    await plant.forward(seconds=5)
    assert plant.tracker().activity is ActivityName.HOLDING
    assert plant.tracker().measured == before


@pytest.mark.parametrize("name", RANGES)
def test_what_no_station_can_measure_is_refused_with_a_sentence(name: str) -> None:
    title, low, high, _ = RANGES[name]
    for wrong in (low - 1.0, high + 1.0, nan):
        with pytest.raises(ValueError, match=f"{title} must be a number from"):
            Weather(**{name: wrong})
    assert getattr(Weather(**{name: high}), name) == high


async def test_a_report_without_a_value_is_refused(plant: Plant) -> None:
    with pytest.raises(ValueError, match="at least one value"):
        await plant.ask(ReportWeather(Weather()))
