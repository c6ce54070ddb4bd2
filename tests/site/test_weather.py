"""The site's weather: what is reported or read every second, how it ages, and what it does not move."""

import asyncio
from datetime import timedelta
from math import nan

import pytest

from app.base.clock import VirtualClock
from app.link.weather_orders import ReportWeather, SetWeatherWindows
from app.modbus.errors import DriveError
from app.site.weather.met_poll import UNFORESEEN, MetPoll
from app.tracker.memory.memory import MetStation, SiteState
from app.tracker.state.snapshot import ActivityName
from app.tracker.weather.weather import RANGES, Weather, WeatherNow
from app.tracker.weather.weather_windows import LIMITS, WeatherWindows
from tests.captured_logs import capture_logs
from tests.site.plant import SUMMER_NOON, Begun, Plant, settle


def known(plant: Plant) -> WeatherNow:
    """Return the weather as everybody is told it."""
    weather = plant.latest().weather
    assert weather is not None
    return weather


async def test_a_report_grows_old_and_stale_and_a_new_one_takes_its_place(plant: Plant) -> None:
    await plant.ask(ReportWeather(Weather(wind_mps=12.0)))
    seen = known(plant)
    assert (seen.age_s, seen.stale, seen.source) == (0.0, False, "technician")
    for since_s, usable in ((60, Weather(wind_mps=12.0)), (305, None)):
        plant.clock.move_to(SUMMER_NOON + timedelta(seconds=since_s))
        await plant.forward(seconds=1)
        seen = known(plant)
        assert seen.age_s == pytest.approx(since_s + 1, abs=0.6)
        assert (seen.usable, seen.stale) == (usable, usable is None)
    await plant.ask(ReportWeather(Weather(wind_mps=3.0)))
    assert known(plant).usable == Weather(wind_mps=3.0)


async def test_every_quantity_grows_old_at_its_own_age(begun: Begun) -> None:
    plant = await begun(state=SiteState(weather_windows=WeatherWindows(wind_old_after_s=20.0)))
    await plant.ask(ReportWeather(Weather(wind_mps=12.0, snow_kg=1.0)))
    plant.clock.advance(timedelta(seconds=25))
    await plant.forward(seconds=0.6)
    assert known(plant).usable == Weather(snow_kg=1.0)
    longer = WeatherWindows(wind_old_after_s=60.0)
    await plant.ask(SetWeatherWindows(longer))
    await plant.forward(seconds=0.6)
    assert known(plant).usable == Weather(wind_mps=12.0, snow_kg=1.0)
    assert (await plant.site.detail()).site.weather_windows == longer


async def test_the_age_of_a_report_counts_from_its_measurement(plant: Plant) -> None:
    now = plant.site.model.now()
    for off_s, words in ((11, "Set the station's clock"), (-301, "Send it sooner")):
        with pytest.raises(ValueError, match=words):
            await plant.ask(ReportWeather(Weather(wind_mps=1.0), now + timedelta(seconds=off_s)))
    with pytest.raises(ValueError, match="at least one value"):
        await plant.ask(ReportWeather(Weather()))
    assert plant.latest().weather is None
    await plant.ask(ReportWeather(Weather(irradiance_wm2=800.0), now - timedelta(seconds=100)))
    assert known(plant).age_s == pytest.approx(100.0)


async def test_a_storm_moves_nothing_that_is_not_automatic(ready: Plant) -> None:
    before = ready.tracker().measured
    await ready.ask(ReportWeather(Weather(wind_mps=45.0, snow_kg=500.0)))
    await ready.forward(seconds=5)
    assert ready.tracker().activity is ActivityName.HOLDING
    assert ready.tracker().measured == before


@pytest.mark.parametrize(
    ("kind", "name", "title", "low", "high"),
    [(Weather, name, *limits[:3]) for name, limits in RANGES.items()]
    + [(WeatherWindows, name, *limits) for name, limits in LIMITS.items()],
)
def test_what_is_out_of_range_is_refused_with_a_sentence(
    kind: type[Weather | WeatherWindows], name: str, title: str, low: float, high: float
) -> None:
    for wrong in (low - 0.5, high + 1.0, nan):
        with pytest.raises(ValueError, match=f"{title} must "):
            kind(**{name: wrong})
    assert getattr(kind(**{name: high}), name) == high


MAST = MetStation("10.0.0.9", 502, 3)


class Mast:
    """A station that says what it is told to, and counts."""

    def __init__(self) -> None:
        self.wind_mps: float | None = 4.0
        self.closed = 0

    async def read(self) -> tuple[Weather | None, tuple[str, ...]]:
        if self.wind_mps is None:
            raise DriveError("It does not answer.")
        return Weather(wind_mps=self.wind_mps), ("rain_mm",)

    async def close(self) -> None:
        self.closed += 1


@pytest.mark.parametrize(
    ("host", "port", "unit"), [(" ", 502, 1), ("a", 0, 1), ("a", 65536, 1), ("a", 502, 256)]
)
def test_a_station_without_a_plausible_address_is_refused(host: str, port: int, unit: int) -> None:
    with pytest.raises(ValueError, match="weather station"):
        MetStation(host, port, unit)


async def test_a_station_is_read_every_second_until_another_is_set() -> None:
    clock, mast = VirtualClock(SUMMER_NOON), Mast()
    told: list[tuple[Weather | None, tuple[str, ...], str]] = []
    poll = MetPoll(clock, lambda _: mast, lambda *what: told.append(what))
    await poll.follow(MAST)
    for _ in range(3):
        await settle()
        clock.advance(timedelta(seconds=1))
    await settle()
    assert len(told) == 4
    assert told[0] == (Weather(wind_mps=4.0), ("rain_mm",), "SunSpec 10.0.0.9:502 unit 3")
    mast.wind_mps = None
    clock.advance(timedelta(seconds=1))
    await settle()
    assert (len(told), poll.trouble) == (4, "It does not answer.")
    mast.wind_mps = 5.0
    clock.advance(timedelta(seconds=1))
    await settle()
    assert (len(told), poll.trouble) == (5, "")
    await poll.follow(None)
    clock.advance(timedelta(seconds=5))
    await settle()
    assert (len(told), mast.closed) == (5, 1)
    assert len(asyncio.all_tasks()) == 1


async def test_a_mistake_in_reading_is_told_and_the_station_is_read_on() -> None:
    clock, mast = VirtualClock(SUMMER_NOON), Mast()
    mistakes: list[Exception] = [KeyError("unforeseen"), ZeroDivisionError()]
    told: list[Weather | None] = []

    def hear(weather: Weather | None, impossible: tuple[str, ...], station: str) -> None:
        if mistakes:
            raise mistakes.pop()
        told.append(weather)

    poll = MetPoll(clock, lambda _: mast, hear)
    with capture_logs() as logs:
        await poll.follow(MAST)
        for _ in range(2):
            await settle()
            assert (told, poll.trouble) == ([], UNFORESEEN)
            clock.advance(timedelta(seconds=1))
        await settle()
    assert (told, poll.trouble) == ([Weather(wind_mps=4.0)], "")
    assert [line["log_level"] for line in logs] == ["error"]
    await poll.close()
