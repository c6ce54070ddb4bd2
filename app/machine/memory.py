"""Watches the memory of this process: an alarm, then a planned restart, but only while all stands still."""

from collections.abc import Callable
from datetime import timedelta
from typing import Protocol

from app.alarms.conditions import MEGABYTE, SITE, Band, Condition
from app.base.clock import Clock
from app.base.message import N_, Message, say, with_format
from app.site.publishing.health import resident_bytes

LOOK_EVERY = timedelta(seconds=10)
EARLIEST = timedelta(minutes=10)
"""A machine that needs so much at once gains nothing by starting again."""
HIGH = Band(0.75, 0.7)


class Watched(Protocol):
    """What is asked of the site."""

    @property
    def rests(self) -> bool:
        """Return whether no tracker moves or means to."""

    def trouble(self, name: str, condition: Condition | None) -> None:
        """Note a condition for the alarms, or with None that it is over."""


class MemoryGuard:
    """Compares what this process holds with its limit; `restart` is told why and ends it in order, once."""

    def __init__(
        self,
        clock: Clock,
        site: Watched,
        limit_bytes: int,
        restart: Callable[[Message], None],
        *,
        resident: Callable[[], int | None] = resident_bytes,
    ) -> None:
        self._clock = clock
        self._site = site
        self._limit_bytes = limit_bytes
        self._restart = restart
        self._resident = resident
        self._begun_at = clock.now()
        self._high = self._ending = False

    async def run(self) -> None:
        """Look every 10 s until the planned restart."""
        while not self._ending:
            self._look(self._resident())
            await self._clock.sleep_until(self._clock.now() + LOOK_EVERY)

    def _look(self, resident: int | None) -> None:
        share = None if resident is None else resident / self._limit_bytes
        self._high = HIGH.holds(share, before=self._high)
        if resident is None or not self._high:
            self._site.trouble("memory", None)
            return
        held_mb, limit_mb = resident / MEGABYTE, self._limit_bytes / MEGABYTE
        text = say(
            "The controller service uses {held_mb} MB of memory; the limit is {limit_mb} MB.",
            held_mb=with_format(held_mb, ".0f"),
            limit_mb=with_format(limit_mb, ".0f"),
        )
        hint = N_(
            "At its limit, the service restarts automatically as soon as every tracker is at standstill."
        )
        self._site.trouble("memory", Condition("memory_high", None, SITE, text, hint))
        if resident >= self._limit_bytes and self._may_restart:
            self._ending = True
            self._restart(
                say("{text} The service restarts now, while every tracker is at standstill.", text=text)
            )

    @property
    def _may_restart(self) -> bool:
        return self._site.rests and self._clock.now() - self._begun_at >= EARLIEST
