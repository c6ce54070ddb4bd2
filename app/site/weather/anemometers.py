"""The wind sensors of a site: the highest that can be relied on counts, and two that disagree are told."""

from datetime import datetime, timedelta

from app.base.message import N_, say, with_format
from app.site.weather.weather_series import Sample, Series
from app.tracker.values.reason import Reason
from app.tracker.weather.weather import Quality, Reading
from app.tracker.weather.weather_windows import WeatherWindows

NAME = "wind_mps"
COMPARED_OVER = timedelta(seconds=60)
LEAST_APART_MPS = 3.0
APART_SHARE = 0.3
"""Sensors some metres apart see different gusts, but within a minute hardly means that differ by this."""
FORGOTTEN_AFTER = timedelta(hours=1)
MOST_SENSORS = 8


class Anemometers:
    """One series a source, with the same face as a single series; times are steady."""

    def __init__(self, windows: WeatherWindows) -> None:
        self._windows = windows
        self._sensors: dict[str, Series] = {}

    @property
    def windows(self) -> WeatherWindows:
        """Return what the values are judged by."""
        return self._windows

    @windows.setter
    def windows(self, windows: WeatherWindows) -> None:
        self._windows = windows
        for series in self._sensors.values():
            series.windows = windows

    @property
    def newest(self) -> Sample | None:
        """Return the newest sample of all sensors, also an impossible one."""
        return max(filter(None, (one.newest for one in self._sensors.values())), key=_when, default=None)

    @property
    def changed_at(self) -> datetime | None:
        """Return when a sensor last showed another value than before."""
        return max(filter(None, (one.changed_at for one in self._sensors.values())), default=None)

    def take(self, at: datetime, value: float, source: str) -> None:
        """Take a sample of one sensor."""
        self._sensor(source, at).take(at, value, source)

    def take_impossible(self, at: datetime, source: str) -> None:
        """Take that what one sensor sent is out of range or no number."""
        self._sensor(source, at).take_impossible(at, source)

    def _sensor(self, source: str, at: datetime) -> Series:
        """Return one sensor; what has been silent for an hour is no sensor of the site any more."""
        series = self._sensors.pop(source, None) or Series(NAME, self._windows)
        fresh = {
            name: one
            for name, one in self._sensors.items()
            if one.newest is not None and at - one.newest.at < FORGOTTEN_AFTER
        }
        kept = list(fresh.items())[-(MOST_SENSORS - 1) :]
        self._sensors = dict(kept) | {source: series}
        return series

    def recall(self, sample: Sample) -> None:
        """Know the newest sample of one sensor from before the restart."""
        self._sensors[sample.source] = Series(NAME, self._windows)
        self._sensors[sample.source].recall(sample)

    def last_of_all(self) -> tuple[Sample, ...]:
        """Return the newest sample of every sensor."""
        return tuple(one.newest for one in self._sensors.values() if one.newest is not None)

    def readings(self, now: datetime, *, others_vary: bool) -> dict[str, Reading]:
        """Return what every sensor reads, by its source."""
        return {source: one.reading(now, others_vary=others_vary) for source, one in self._sensors.items()}

    def reading(self, now: datetime, *, others_vary: bool) -> Reading:
        """Return the highest that can be relied on; where none can, what the newest report says."""
        counting = self._counting(now, others_vary=others_vary)
        found = [series.reading(now, others_vary=others_vary) for series in counting]
        return max(found, key=lambda one: one.value or 0.0, default=Reading())

    def gust(self, now: datetime, *, others_vary: bool) -> float | None:
        """Return the highest gust of the sensors that count."""
        found = [one.gust(now) for one in self._counting(now, others_vary=others_vary)]
        return max((gust for gust in found if gust is not None), default=None)

    def mean(self, now: datetime, *, others_vary: bool) -> float | None:
        """Return the highest mean of the sensors that count."""
        found = [one.mean() for one in self._counting(now, others_vary=others_vary)]
        return max((mean for mean in found if mean is not None), default=None)

    def _counting(self, now: datetime, *, others_vary: bool) -> list[Series]:
        """Return the sensors that can be relied on; where none can, the one that reported last."""
        found = self.readings(now, others_vary=others_vary)
        good = [self._sensors[source] for source, one in found.items() if one.quality is Quality.GOOD]
        newest = self.newest
        return good or ([] if newest is None else [self._sensors[newest.source]])

    def disagreement(self, now: datetime, *, others_vary: bool) -> Reason | None:
        """Return that the means of the last minute of two good sensors are too far apart, with both."""
        good = [
            source
            for source, one in self.readings(now, others_vary=others_vary).items()
            if one.quality is Quality.GOOD
        ]
        means = {source: self._sensors[source].mean_of_last(COMPARED_OVER) for source in good}
        known = sorted((mean, source) for source, mean in means.items() if mean is not None)
        if len(known) < 2:
            return None
        (low_mps, low), (high_mps, high) = known[0], known[-1]
        if high_mps - low_mps <= max(LEAST_APART_MPS, APART_SHARE * high_mps):
            return None
        return Reason(
            "wind_sensors_disagree",
            say(
                "Two wind sensors disagree: {high} shows {high_mps} m/s and {low} {low_mps} m/s, as "
                "one-minute means; the higher value is used.",
                high=high,
                high_mps=with_format(high_mps, ".1f"),
                low=low,
                low_mps=with_format(low_mps, ".1f"),
            ),
            N_("Compare both with the actual wind, and check the faulty one."),
        )


def _when(sample: Sample) -> datetime:
    return sample.at
