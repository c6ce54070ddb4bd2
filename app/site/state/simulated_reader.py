"""Reads a made-up weather station as a real one is read."""

from collections.abc import Callable
from datetime import datetime

from app.base.message import N_
from app.modbus.errors import DriveSilent
from app.sun.position import SunPosition
from app.tracker.weather.played_weather import report_at
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather import Weather


class SimulatedReader:
    """A station whose values are a function of the site's time and its sun."""

    def __init__(
        self, station: SimulatedStation, now: Callable[[], datetime], sun: Callable[[], SunPosition | None]
    ) -> None:
        self._station = station
        self._now = now
        self._sun = sun

    async def read(self) -> tuple[Weather | None, tuple[str, ...]]:
        """Return what it makes up, or raise `DriveSilent` while it is played that it says nothing."""
        readings, impossible = report_at(self._station, self._now(), self._sun())
        if readings is None:
            raise DriveSilent(N_("The simulated weather station does not answer: this fault is injected."))
        return readings, impossible

    async def close(self) -> None:
        """Let go of nothing."""
