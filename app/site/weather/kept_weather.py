"""The last weather on disk: what a controller must know of it after it was killed."""

import asyncio
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from app.base.instants import Instant
from app.base.logs import get_logger
from app.base.twins import Twins
from app.tracker.protections.guarding import wind_of
from app.tracker.protections.wind_stow import is_high
from app.tracker.settings.protections import WindProtection
from app.tracker.weather.weather import RANGES, Quality, Reading, Sensed, is_possible

CALM_EVERY = timedelta(minutes=10)
"""How often weather is written that demands nothing which the weather on disk does not."""
SOON_ENOUGH, ALONG = timedelta(minutes=4), timedelta(seconds=3)
"""From this age on it goes along with samples, within so long of them: a file system writes more about
a change than the change itself, and about both at once."""
ROOM = 16_000
WIND = "wind_mps"

log = get_logger()


@dataclass(frozen=True, slots=True)
class KeptValue:
    """One value, when it was measured by the site's clock, and who sent it."""

    value: float
    at: Instant
    source: str


@dataclass(frozen=True, slots=True)
class KeptWeather:
    """The newest report and the newest value of everything; instants are those of the site's clock.

    `winds` are those of every wind sensor, gust and mean what trackers were told. `unheard_since` is since
    when lives of the controller have heard nothing, None: this one has.
    """

    reported_at: Instant
    source: str
    quantities: dict[str, KeptValue] = field(default_factory=dict)
    winds: tuple[KeptValue, ...] = ()
    gust_mps: float | None = None
    mean_mps: float | None = None
    unheard_since: Instant | None = None


FORM = TypeAdapter(KeptWeather)


class WeatherFile:
    """Keeps the newest weather: at once what demands more than the one on disk does, calm weather seldom."""

    def __init__(self, path: Path | None) -> None:
        self._twins = None if path is None else Twins(path, ROOM)
        self._stored: KeptWeather | None = None
        self._stored_at: datetime | None = None
        self._syncing: asyncio.Future[None] | None = None

    def recall(self, site_time: datetime) -> KeptWeather | None:
        """Return what was kept, None if nothing was; that nothing is heard counts from now on."""
        contents = [] if self._twins is None else self._twins.read()
        found = next((_judged(one) for one in contents if one), None)
        if found is not None and found.unheard_since is None:
            found = replace(found, unheard_since=site_time)
        return found

    def keep(
        self,
        kept: KeptWeather | None,
        now: datetime,
        limits: Iterable[WindProtection],
        samples_at: datetime | None = None,
    ) -> None:
        """Have this kept if it matters or if it is time; it outlives a kill at once.

        What matters is synced, and outlives a power cut soon; calm weather reaches the disk with what
        else goes there. `samples_at` is when samples went to the disk last.
        """
        if self._twins is None or kept is None:
            return
        matters = self._matters(kept, limits)
        if matters or self._is_due(now, samples_at):
            self._write(self._twins, kept, synced=matters)
            self._stored_at = now

    def _is_due(self, now: datetime, samples_at: datetime | None) -> bool:
        if self._stored_at is None:
            return True
        age = now - self._stored_at
        goes_along = samples_at is not None and now - samples_at <= ALONG
        return age >= (SOON_ENOUGH if goes_along else CALM_EVERY)

    async def written(self) -> None:
        """Return once what was kept outlives a power cut, as far as the disk can do that."""
        while self._syncing is not None:
            syncing, self._syncing = self._syncing, None
            await asyncio.gather(syncing, return_exceptions=True)

    async def close(self, kept: KeptWeather | None) -> None:
        """Keep the last that is known."""
        if self._twins is not None and kept is not None and kept != self._stored:
            self._write(self._twins, kept, synced=True)
        await self.written()

    def _matters(self, kept: KeptWeather, limits: Iterable[WindProtection]) -> bool:
        """Return whether it demands a stow that the one on disk does not, or is the first of this life."""
        stored = self._stored
        if stored is None or (stored.unheard_since is None) is not (kept.unheard_since is None):
            return True
        return any(_is_high(one, kept) and not _is_high(one, stored) for one in limits)

    def _write(self, twins: Twins, kept: KeptWeather, *, synced: bool) -> None:
        try:
            twins.write(0, FORM.dump_json(kept))
        except (OSError, ValueError) as error:
            log.warning("weather_not_kept", reason=str(error))
            return
        self._stored = kept
        if synced:
            self._syncing = asyncio.get_running_loop().run_in_executor(None, _sync, twins)


def _is_high(limits: WindProtection, kept: KeptWeather) -> bool:
    """Return whether a tracker with these limits is to be stowed if it knows only this."""
    wind = Reading(kept.gust_mps, Quality.BEFORE_RESTART)
    return limits.enabled and is_high(limits, wind_of(Sensed(wind, wind_mean_mps=kept.mean_mps), limits))


def _judged(content: bytes) -> KeptWeather | None:
    """Return what was kept without what is impossible, which the log tells; None: nothing can be used."""
    try:
        kept = FORM.validate_json(content)
    except ValidationError as error:
        log.warning("kept_weather_set_aside", reason=str(error.errors(include_url=False)[0]["msg"]))
        return None
    possible = {name: one for name, one in kept.quantities.items() if _is_possible(name, one.value)}
    winds = tuple(one for one in kept.winds if _is_possible(WIND, one.value))
    gust_mps, mean_mps = (
        None if one is None or not _is_possible(WIND, one) else one for one in (kept.gust_mps, kept.mean_mps)
    )
    judged = replace(kept, quantities=possible, winds=winds, gust_mps=gust_mps, mean_mps=mean_mps)
    if judged != kept:
        log.warning("kept_weather_set_aside", reason="impossible values")
    return judged


def _is_possible(name: str, value: float) -> bool:
    return name in RANGES and is_possible(name, value)


def _sync(twins: Twins) -> None:
    try:
        twins.sync()
    except OSError as error:
        log.warning("weather_not_kept", reason=str(error))
