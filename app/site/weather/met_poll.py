"""Reads the site's weather station every second, for as long as one is set."""

import asyncio
from collections.abc import Callable
from datetime import timedelta
from typing import Protocol

from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, told_by
from app.modbus.errors import DriveError
from app.tracker.memory.memory import MetStation
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather import Weather

EVERY = timedelta(seconds=1)
Station = MetStation | SimulatedStation

UNFORESEEN = N_("The weather station cannot be read because of an unexpected error; see the log.")

log = get_logger()


class StationReader(Protocol):
    """A weather station that can be read."""

    async def read(self) -> tuple[Weather | None, tuple[str, ...]]:
        """Return what it measures and the names of what is impossible, or raise `DriveError`."""

    async def close(self) -> None:
        """Let go of the connection."""


class MetPoll:
    """One task that reads one station; what it reads goes to `on_reading` with the station's name."""

    def __init__(
        self,
        clock: Clock,
        make_reader: Callable[[Station], StationReader] | None,
        on_reading: Callable[[Weather | None, tuple[str, ...], str], None],
    ) -> None:
        self.trouble = ""
        self._clock = clock
        self._make_reader = make_reader
        self._on_reading = on_reading
        self._task: asyncio.Task[None] | None = None

    async def follow(self, station: Station | None) -> None:
        """Read this station from now on, None: no station."""
        await self.close()
        if station is not None and self._make_reader is not None:
            reader = self._make_reader(station)
            self._task = asyncio.create_task(self._run(station, reader), name=N_("weather station"))

    async def close(self) -> None:
        """Read no station any more."""
        task, self._task = self._task, None
        self.trouble = ""
        if task is not None:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def _run(self, station: Station, reader: StationReader) -> None:
        try:
            while True:
                await self._read(station, reader)
                await self._clock.sleep_until(self._clock.now() + EVERY)
        finally:
            await reader.close()

    async def _read(self, station: Station, reader: StationReader) -> None:
        """Read once; a station that does not answer says nothing, and its values grow old."""
        try:
            readings, impossible = await reader.read()
            self._on_reading(readings, impossible, station.name)
        except DriveError as error:
            if not self.trouble:
                log.warning("weather_station_not_read", station=station.name, reason=str(error))
            self.trouble = told_by(error)
        except Exception:
            if self.trouble != UNFORESEEN:
                log.exception("weather_station_not_read", station=station.name)
            self.trouble = UNFORESEEN
        else:
            self.trouble = ""
