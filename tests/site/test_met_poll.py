"""The site reads its weather station every second, and what it reads acts as a report does."""

import asyncio
from datetime import UTC, datetime, timedelta

import pytest

from app.base.clock import VirtualClock
from app.modbus.errors import DriveError
from app.site.weather.met_poll import UNFORESEEN, MetPoll
from app.tracker.memory.memory import MetStation
from app.tracker.weather.weather import Weather
from tests.captured_logs import capture_logs
from tests.site.plant import settle

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


async def test_a_station_is_read_every_second_until_another_is_set() -> None:
    clock, mast = VirtualClock(datetime(2026, 6, 21, tzinfo=UTC)), Mast()
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
    clock, mast = VirtualClock(datetime(2026, 6, 21, tzinfo=UTC)), Mast()
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


@pytest.mark.parametrize(("host", "port", "unit"), [(" ", 502, 1), ("a", 0, 1), ("a", 502, 256)])
def test_a_station_without_a_plausible_address_is_refused(host: str, port: int, unit: int) -> None:
    with pytest.raises(ValueError, match="weather station"):
        MetStation(host, port, unit)
