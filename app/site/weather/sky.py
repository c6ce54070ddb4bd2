"""The sun over the site, for trackers that may follow different algorithms."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.sun.events import next_rise
from app.sun.position import Algorithm, InstantRefused, Location, SunPosition, sun_position
from app.sun.spa import AlgorithmMissing

NO_DAWN_FOR = timedelta(hours=1)
UNKNOWN = (InstantRefused, AlgorithmMissing)


@dataclass(frozen=True, slots=True)
class _Dawn:
    """A sunrise that was worked out: for whom, how long it counts, and where the sun will be."""

    location: Location
    algorithm: Algorithm
    since: datetime
    until: datetime
    sun: SunPosition | None

    def answers(self, location: Location, at: datetime) -> bool:
        """Return whether this is also the next sunrise of a place at an instant."""
        same_place = location is self.location or location == self.location
        return same_place and self.since <= at < self.until


class Sky:
    """Works out sun and next sunrise; a sunrise is kept until it is over or the question changes."""

    def __init__(self) -> None:
        self._dawns: dict[Algorithm, _Dawn] = {}

    def sun(self, location: Location | None, algorithm: Algorithm, at: datetime) -> SunPosition | None:
        """Return where the sun stands, None without a location, or where the algorithm does not tell."""
        if location is None:
            return None
        try:
            return sun_position(algorithm, location, at)
        except UNKNOWN:
            return None

    def dawn(self, location: Location | None, algorithm: Algorithm, at: datetime) -> SunPosition | None:
        """Return where the sun will rise next, None if it does not within two days."""
        if location is None:
            return None
        known = self._dawns.get(algorithm)
        if known is None or not known.answers(location, at):
            known = _next_dawn(location, algorithm, at)
            self._dawns[algorithm] = known
        return known.sun


def _next_dawn(location: Location, algorithm: Algorithm, at: datetime) -> _Dawn:
    try:
        rise = next_rise(algorithm, location, at)
    except UNKNOWN:
        rise = None
    if rise is None:
        return _Dawn(location, algorithm, at, at + NO_DAWN_FOR, None)
    return _Dawn(location, algorithm, at, rise, sun_position(algorithm, location, rise))
