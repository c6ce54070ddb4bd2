"""For how long a sensor that is known has not been read well."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.tracker.settings.protections import Reaction


@dataclass(frozen=True, slots=True)
class Doubt:
    """Since when a sensor is bad (None: it is well or not there), and whether that is reacted to."""

    since: datetime | None = None
    ripe: bool = False


WELL = Doubt()


def step(state: Doubt, *, good: bool, known: bool, after_s: float, now: datetime) -> Doubt:
    """Return the doubt after one look at a sensor; one that is neither seen nor required is not missed."""
    if good or not known:
        return WELL
    since = state.since or now
    return Doubt(since, now - since >= timedelta(seconds=after_s))


def demands(doubt: Doubt, wanted: Reaction, *reactions: Reaction) -> bool:
    """Return whether a doubt calls for one of these reactions."""
    return doubt.ripe and wanted in reactions
