"""Removes what is too old, by an instant that follows the site's clock only as far as the machine runs.

A clock that was ahead, by a dead battery or a slip of the finger, must not make everything old at once.
"""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import partial

from app.base.message import say, with_format
from app.site.state.model import SiteModel
from app.tracker.memory.memory import AgesFrom
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.actors import CONTROLLER

EVERY = timedelta(days=1)
COUNTED_EVERY = timedelta(hours=1)
MOST_A_DAY = 2
"""So many days a day of running makes older at most: time without power is made up for, a leap is not."""


@dataclass(frozen=True, slots=True)
class Limits:
    """How old day recordings and journal entries may get, and how many other recordings are kept."""

    recordings: timedelta = timedelta(days=400)
    journal: timedelta = timedelta(days=1825)
    recordings_max: int = 500


def counted(ages: AgesFrom, ran: timedelta) -> AgesFrom:
    """Return the ages after the machine has run so much longer on a clock that is trusted."""
    return replace(ages, ran_s=ages.ran_s + ran.total_seconds())


def moved(ages: AgesFrom, shown: datetime) -> AgesFrom | None:
    """Return the ages after a day of running, by a clock that shows this; None: it has not run for a day."""
    ran = timedelta(seconds=ages.ran_s)
    return AgesFrom(min(ages.at + MOST_A_DAY * ran, shown)) if ran >= EVERY else None


class Retention:
    """Counts the time that the machine runs on a clock that is trusted; what is too old goes once a day."""

    def __init__(self, model: SiteModel, limits: Limits) -> None:
        self._model = model
        self._limits = limits
        self._since = model.clock.now()

    def beat(self) -> None:
        """Count on; with a clock that is not trusted nothing gets older.

        What an order changes of the site is not to be overtaken by what the site was before: it waits.
        """
        model, now = self._model, self._model.clock.now()
        if model.timekeeper.reasons():
            self._since = now
        if now - self._since < COUNTED_EVERY or model.changing.locked():
            return
        ages = counted(model.state.ages_from or AgesFrom(model.now()), now - self._since)
        self._since = now
        due = moved(ages, model.now())
        model.state = replace(model.state, ages_from=due or ages)
        model.ledger.post_site(model.state, ())
        if due is not None:
            self._prune(due.at)

    def _prune(self, at: datetime) -> None:
        writer, limits = self._model.ledger.writer, self._limits
        if writer is not None:
            self._model.ledger.hand_over()
            before, oldest = at - limits.recordings, at - limits.journal
            writer.post(lambda store: store.prune(days_before=before, keep=limits.recordings_max))
            writer.post(lambda store: store.prune_history(oldest, partial(self._pruned, oldest)))

    def _pruned(self, oldest: datetime, entries: int) -> Event:
        """Return the event that says what retention removed."""
        text = say(
            "Retention removed {entries} journal entries from before {oldest}.",
            entries=entries,
            oldest=with_format(oldest, "%Y-%m-%d"),
        )
        return self._model.event(EventKind.JOURNAL_PRUNED, text, CONTROLLER, entries=entries)
