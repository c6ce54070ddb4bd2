"""The site's weather: what its stations measured, how old and how good each value is."""

from dataclasses import fields
from datetime import datetime, timedelta

from app.base.message import say, with_format
from app.site.weather.anemometers import Anemometers
from app.site.weather.kept_weather import KeptValue, KeptWeather
from app.site.weather.weather_series import FROZEN_AFTER, Sample, Series
from app.tracker.weather.weather import NOTHING_SENSED, Quality, Reading, Sensed, Weather, WeatherNow
from app.tracker.weather.weather_windows import WeatherWindows

MOST_AHEAD = timedelta(seconds=10)
USUAL = WeatherWindows()
NAMES = tuple(field.name for field in fields(Weather))
WIND = "wind_mps"
MOVES_WITH = {WIND: "wind_direction_deg"}
"""A vane that turns while the anemometer shows no wind says that the anemometer is stuck."""
SENSED_FOR = timedelta(milliseconds=10)
"""So long what one tick is told is told to the next ones too, unless something is reported."""
OLD = (Quality.STALE, Quality.BEFORE_RESTART)


class WeatherStation:
    """Keeps every quantity's samples; ages grow with the machine's own clock, whatever the site's does."""

    def __init__(self, windows: WeatherWindows = USUAL, *, simulated: bool = False) -> None:
        self._windows, self._simulated = windows, simulated
        self._winds = Anemometers(windows)
        self._series: dict[str, Series | Anemometers] = {name: Series(name, windows) for name in NAMES}
        self._series[WIND] = self._winds
        self._reported_at: datetime | None = None
        self._measured_at: datetime | None = None
        self._source = ""
        self._recalled: KeptWeather | None = None
        self._unheard_at: datetime | None = None
        self._sensed: tuple[datetime, Sensed] | None = None

    @property
    def windows(self) -> WeatherWindows:
        """Return what the values are judged by."""
        return self._windows

    def judge_by(self, windows: WeatherWindows) -> None:
        """Go by other windows from now on; a mean over a longer one grows into it."""
        self._windows, self._sensed = windows, None
        for series in self._series.values():
            series.windows = windows

    def receive(
        self,
        readings: Weather | None,
        measured_at: datetime | None,
        source: str,
        site_time: datetime,
        now: datetime,
        impossible: tuple[str, ...] = (),
    ) -> None:
        """Take a report, or raise `ValueError` if it is of the future or already stale.

        `impossible` names what the station sent that was no number or out of range.
        """
        measured_at = measured_at or site_time
        age = self._checked_age(measured_at, site_time)
        at = now - age
        for name in NAMES:
            value = None if readings is None else getattr(readings, name)
            if value is not None:
                self._series[name].take(at, value, source)
        for name in impossible:
            self._series[name].take_impossible(at, source)
        self._reported_at, self._measured_at, self._source = at, measured_at, source
        self._unheard_at = self._sensed = None

    def recall(self, kept: KeptWeather, site_time: datetime, now: datetime) -> None:
        """Know what was reported before the restart."""
        self._sensed = None

        def sample(kept: KeptValue) -> Sample:
            return Sample(now - max(site_time - kept.at, timedelta(0)), kept.value, kept.source)

        for name, one in kept.quantities.items():
            if name in NAMES and name != WIND:
                self._series[name].recall(sample(one))
        for one in kept.winds:
            self._winds.recall(sample(one))
        self._reported_at = now - max(site_time - kept.reported_at, timedelta(0))
        self._measured_at, self._source, self._recalled = kept.reported_at, kept.source, kept
        self._unheard_at = now - max(site_time - (kept.unheard_since or site_time), timedelta(0))

    def kept(self, site_time: datetime, now: datetime) -> KeptWeather | None:
        """Return what the next life of the controller has to know, None if nothing was ever reported."""
        if self._reported_at is None:
            return None

        def value(sample: Sample | None) -> KeptValue | None:
            if sample is None or sample.value is None:
                return None
            return KeptValue(sample.value, site_time - (now - sample.at), sample.source)

        newest = {name: value(series.newest) for name, series in self._series.items() if name != WIND}
        told = self.sensed(now)
        return KeptWeather(
            site_time - (now - self._reported_at),
            self._source,
            {name: one for name, one in newest.items() if one is not None},
            tuple(filter(None, map(value, self._winds.last_of_all()))),
            told.wind.value,
            told.wind_mean_mps,
            None if self._unheard_at is None else site_time - (now - self._unheard_at),
        )

    @property
    def unheard(self) -> bool:
        """Return whether something was reported before the restart, and nothing since."""
        return self._unheard_at is not None

    def now(self, now: datetime) -> WeatherNow | None:
        """Return the newest values with their ages, None if there never was one since the start."""
        if self._reported_at is None or self._measured_at is None:
            return None
        quantities = {name: self._reading(name, now) for name in NAMES if self._series[name].newest}
        age = now - self._reported_at
        vane_turns = self._turns(WIND, now)
        return WeatherNow(
            _newest(quantities),
            self._measured_at,
            age.total_seconds(),
            self.unheard or age > self._windows.oldest,
            self._source,
            quantities,
            self._winds.gust(now, others_vary=vane_turns),
            self._winds.mean(now, others_vary=vane_turns),
            self._simulated,
            self._winds.readings(now, others_vary=vane_turns),
            self._winds.disagreement(now, others_vary=vane_turns),
            self.unheard,
        )

    def sensed(self, now: datetime) -> Sensed:
        """Return what one tick of a tracker is told."""
        if self._reported_at is None:
            return NOTHING_SENSED
        if self._sensed is None or not timedelta(0) <= now - self._sensed[0] < SENSED_FOR:
            self._sensed = now, self._judged(now)
        return self._sensed[1]

    def _judged(self, now: datetime) -> Sensed:
        vane_turns = self._turns(WIND, now)
        wind, gust_mps = self._reading(WIND, now), self._winds.gust(now, others_vary=vane_turns)
        mean_mps = self._winds.mean(now, others_vary=vane_turns)
        if wind.quality is Quality.BEFORE_RESTART and self._recalled is not None:
            gust_mps, mean_mps = self._recalled.gust_mps, self._recalled.mean_mps
        if wind.quality in (Quality.GOOD, Quality.BEFORE_RESTART) and gust_mps is not None:
            wind = Reading(gust_mps, wind.quality, wind.age_s, wind.source)
        return Sensed(
            wind,
            self._reading("snow_kg", now),
            self._reading("irradiance_wm2", now),
            mean_mps,
            self._reading("wind_direction_deg", now).good,
            self._simulated,
            0.0 if self._unheard_at is None else (now - self._unheard_at).total_seconds(),
        )

    def _reading(self, name: str, now: datetime) -> Reading:
        return self._series[name].reading(now, others_vary=self._turns(name, now))

    def _turns(self, name: str, now: datetime) -> bool:
        """Return whether what moves with this quantity has changed of late."""
        with_it = self._series.get(MOVES_WITH.get(name, ""))
        changed_at = None if with_it is None else with_it.changed_at
        return changed_at is not None and now - changed_at < FROZEN_AFTER

    def _checked_age(self, measured_at: datetime, site_time: datetime) -> timedelta:
        age = site_time - measured_at
        if age < -MOST_AHEAD:
            raise ValueError(
                say(
                    "The weather was measured at {isoformat}, but the site's clock shows {isoformat2}. "
                    "Set the station's clock, or omit the time.",
                    isoformat=measured_at.isoformat(),
                    isoformat2=site_time.isoformat(),
                )
            )
        if age > self._windows.oldest:
            limit_s = self._windows.oldest.total_seconds()
            raise ValueError(
                say(
                    "The weather data is {total_seconds} s old; data older than {limit_s} s is not "
                    "accepted. Send it sooner, or omit the time.",
                    total_seconds=with_format(age.total_seconds(), ".0f"),
                    limit_s=with_format(limit_s, ".0f"),
                )
            )
        return max(age, timedelta(0))


def _newest(quantities: dict[str, Reading]) -> Weather:
    """Return the values that are not stale; where all are, the last ones, which are shown with their age."""
    fresh = {name: one.value for name, one in quantities.items() if one.quality not in OLD}
    return Weather(**(fresh or {name: one.value for name, one in quantities.items()}))
