"""The site's weather: the newest report and its age. Nothing moves because of it."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.tracker.weather import Weather, WeatherNow

MOST_AHEAD = timedelta(seconds=10)
STALE_AFTER = timedelta(minutes=5)


@dataclass(frozen=True, slots=True)
class _Report:
    readings: Weather
    measured_at: datetime
    source: str
    age_when_received: timedelta
    received: datetime


class WeatherStation:
    """Keeps the newest report; its age grows with the machine's own clock, whatever the site's clock does."""

    def __init__(self, stale_after: timedelta = STALE_AFTER) -> None:
        self._stale_after = stale_after
        self._report: _Report | None = None

    def receive(
        self, readings: Weather, measured_at: datetime | None, source: str, site_time: datetime, now: datetime
    ) -> None:
        """Take a report, or raise `ValueError` if it is of the future or already stale."""
        measured_at = measured_at or site_time
        age = site_time - measured_at
        if age < -MOST_AHEAD:
            raise ValueError(
                f"The weather was measured at {measured_at.isoformat()}, but the site's clock shows "
                f"{site_time.isoformat()}. Set the station's clock, or leave the time out."
            )
        if age > self._stale_after:
            limit_s = self._stale_after.total_seconds()
            raise ValueError(
                f"The weather is {age.total_seconds():.0f} s old; older than {limit_s:.0f} s is not taken. "
                "Send it sooner, or leave the time out."
            )
        self._report = _Report(readings, measured_at, source, max(age, timedelta(0)), now)

    def now(self, now: datetime) -> WeatherNow | None:
        """Return the newest report with its age, None if there never was one in this life of the machine."""
        report = self._report
        if report is None:
            return None
        age = report.age_when_received + (now - report.received)
        return WeatherNow(
            report.readings, report.measured_at, age.total_seconds(), age > self._stale_after, report.source
        )
