"""The samples of one quantity: their newest, their gust and mean, and whether they may be relied on."""

from collections import deque
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.tracker.weather.weather import Quality, Reading
from app.tracker.weather.weather_windows import WeatherWindows

FROZEN_AFTER = timedelta(minutes=10)
FROZEN_SAMPLES = 5
"""So many equal samples in a row, at least, make a sensor that is frozen."""
MOST_SAMPLES = 6000
STEEPEST = {"wind_mps": 30.0, "temperature_degc": 5.0, "pressure_hpa": 20.0}
"""By how much a value can change in a second; a jump is believed once the next sample confirms it."""
ALIVE_ABOVE = {"wind_mps": 0.0, "irradiance_wm2": 20.0}
"""Above this a sensor never reports the same for minutes; at rest (calm, night) it may."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One value, None while none was possible: when it was measured by the steady time, and who sent it."""

    at: datetime
    value: float | None
    source: str


class Series:
    """One quantity of a station; times are steady."""

    def __init__(self, name: str, windows: WeatherWindows) -> None:
        self._name = name
        self.windows = windows
        self._believed: deque[tuple[datetime, float]] = deque()
        self._total = 0.0
        self._newest: Sample | None = None
        self._impossible = self._recalled = False
        self._equal = 0
        self.changed_at: datetime | None = None

    @property
    def newest(self) -> Sample | None:
        """Return the newest sample, also an impossible one."""
        return self._newest

    def recall(self, sample: Sample) -> None:
        """Know the newest sample from before the restart; nothing counts on it."""
        self._newest, self._recalled = sample, True

    def take_impossible(self, at: datetime, source: str) -> None:
        """Take that what was sent is no number or out of range: the last value stays, and is not believed."""
        self._take(Sample(at, None if self._newest is None else self._newest.value, source), impossible=True)

    def take(self, at: datetime, value: float, source: str) -> None:
        """Take a value; one that has jumped is not believed before the next confirms it."""
        self._take(Sample(at, value, source), impossible=self._jumped(self._newest, at, value))

    def _take(self, sample: Sample, *, impossible: bool) -> None:
        before, self._recalled, self._impossible = self._newest, False, impossible
        if before is None or sample.value != before.value:
            self.changed_at, self._equal = sample.at, 1
        else:
            self._equal += 1
        self._newest = sample
        if not impossible and sample.value is not None:
            self._believed.append((sample.at, sample.value))
            self._total += sample.value
        while self._is_over(sample.at):
            self._total -= self._believed.popleft()[1]

    def reading(self, now: datetime, *, others_vary: bool) -> Reading:
        """Return the newest value with its age and quality."""
        newest = self._newest
        if newest is None:
            return Reading()
        quality = self._quality(newest, now, others_vary=others_vary)
        return Reading(newest.value, quality, (now - newest.at).total_seconds(), newest.source)

    def gust(self, now: datetime) -> float | None:
        """Return the highest believable value of the gust's window, None if the newest is stale."""
        if not self._believed:
            return None
        newest_at, highest = self._believed[-1]
        if now - newest_at > self._stale_after:
            return None
        for at, value in reversed(self._believed):
            if newest_at - at > self.windows.gust_over:
                break
            highest = max(highest, value)
        return highest

    def mean(self) -> float | None:
        """Return the mean of the believable values of the mean's window up to the newest one."""
        return self._total / len(self._believed) if self._believed else None

    def mean_of_last(self, span: timedelta) -> float | None:
        """Return the mean of the believable values of this span up to the newest one."""
        found: list[float] = []
        for at, value in reversed(self._believed):
            if self._believed[-1][0] - at > span:
                break
            found.append(value)
        return sum(found) / len(found) if found else None

    def is_stale(self, now: datetime) -> bool:
        """Return whether the newest sample is too old to be used."""
        return self._newest is not None and now - self._newest.at > self._stale_after

    @property
    def _stale_after(self) -> timedelta:
        return self.windows.old_after(self._name)

    def _is_over(self, now: datetime) -> bool:
        """Return whether the oldest sample has had its time."""
        samples = self._believed
        return bool(samples) and (now - samples[0][0] > self.windows.mean_over or len(samples) > MOST_SAMPLES)

    def _jumped(self, before: Sample | None, at: datetime, value: float) -> bool:
        steepest = STEEPEST.get(self._name)
        if before is None or before.value is None or steepest is None:
            return False
        elapsed_s = max(1.0, (at - before.at).total_seconds())
        return abs(value - before.value) > steepest * elapsed_s

    def _quality(self, newest: Sample, now: datetime, *, others_vary: bool) -> Quality:
        if self._recalled:
            return Quality.BEFORE_RESTART
        if self.is_stale(now):
            return Quality.STALE
        if self._impossible:
            return Quality.IMPOSSIBLE
        return Quality.FROZEN if self._is_frozen(newest, others_vary=others_vary) else Quality.GOOD

    def _is_frozen(self, newest: Sample, *, others_vary: bool) -> bool:
        above = ALIVE_ABOVE.get(self._name)
        if above is None or newest.value is None or self.changed_at is None or self._equal < FROZEN_SAMPLES:
            return False
        lasts = newest.at - self.changed_at >= FROZEN_AFTER
        return lasts and (newest.value > above or others_vary)
