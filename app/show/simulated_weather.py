"""The weather of a simulated day, measured and judged as the site's own station is."""

from datetime import datetime, timedelta

from app.base.message import say
from app.site.weather.weather import WeatherStation
from app.sun.position import SunPosition
from app.tracker.weather.weather import NOTHING_SENSED, SIMULATED, Sensed
from app.tracker.weather.weather_day import WeatherDay

EVERY = timedelta(seconds=2)
SOURCE = say("{simulated} day", simulated=SIMULATED)


class MadeUpWeather:
    """A station that reports every two seconds of steady time what the day has."""

    def __init__(self, day: WeatherDay) -> None:
        self._day = day
        self._station = WeatherStation(simulated=True)
        self._reported_at: datetime | None = None
        self._sensed = NOTHING_SENSED

    def sensed(self, site_time: datetime, sun: SunPosition | None, now: datetime) -> Sensed:
        """Return what one tick of the tracker is told."""
        if self._reported_at is None or now - self._reported_at >= EVERY:
            self._reported_at = now
            weather = self._day.at(site_time, sun)
            if weather is not None:
                self._station.receive(weather, None, SOURCE, site_time, now)
            self._sensed = self._station.sensed(now)
        return self._sensed
