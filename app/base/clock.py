"""The only module that reads the machine's time."""

import asyncio
import time
from datetime import UTC, datetime, timedelta
from typing import Protocol

NOTHING = timedelta()
SMALL_CORRECTION = timedelta(minutes=5)
"""So far a clock may be put back while that ends nothing: by NTP, or a computer that kept the time itself."""


class Clock(Protocol):
    """A source of aware UTC instants that never go backwards."""

    def now(self) -> datetime:
        """Return the present instant, aware, in UTC."""

    def system_time(self, at: datetime | None = None) -> datetime:
        """Return what the system's clock shows now, or showed `at`, by how it is set now.

        It may be set at any time, by NTP or by hand: it is what is shown, stamped and compared with other
        clocks, and no span is measured by it. What is older than this clock stays as it was stamped.
        """

    async def sleep_until(self, at: datetime) -> None:
        """Return once `now()` is at or after `at`; at once if it is already."""


class SystemClock:
    """The machine's time, anchored once and advanced by the monotonic counter."""

    def __init__(self) -> None:
        self._anchor = datetime.now(UTC)
        self._counter = time.monotonic()

    def now(self) -> datetime:
        """Return the anchored instant plus the monotonic time that has passed since."""
        return self._steady()

    def system_time(self, at: datetime | None = None) -> datetime:
        """Return what the system's clock shows, or showed at an instant since this clock was anchored."""
        return _as_set(at or self.now(), self._anchor, self.drift())

    def drift(self) -> timedelta:
        """Return how far the system's wall clock has moved away from this clock since it was anchored."""
        return datetime.now(UTC) - self._steady()

    def _steady(self) -> datetime:
        return self._anchor + timedelta(seconds=time.monotonic() - self._counter)

    async def sleep_until(self, at: datetime) -> None:
        """Sleep for what is left until `at`."""
        await asyncio.sleep(max(0.0, (at - self.now()).total_seconds()))


class VirtualClock:
    """A clock that moves only when it is told to; sleepers wake in the order of their instants."""

    def __init__(self, start: datetime) -> None:
        self._now = self._anchor = start
        self._drift = NOTHING
        self._sleepers: list[tuple[datetime, asyncio.Event]] = []

    def now(self) -> datetime:
        """Return the instant that this clock was last moved to."""
        return self._now

    def set_system(self, at: datetime) -> None:
        """Set the system's clock, as NTP does; this one goes on from where it is."""
        self._drift = at - self._now

    def system_time(self, at: datetime | None = None) -> datetime:
        """Return what the system's clock shows, or showed at an instant since this clock began."""
        return _as_set(at or self._now, self._anchor, self._drift)

    def drift(self) -> timedelta:
        """Return how far the system's clock was set away from this one."""
        return self._drift

    @property
    def next_wake(self) -> datetime | None:
        """Return the earliest instant that somebody sleeps until, None if nobody does."""
        return min((until for until, _ in self._sleepers), default=None)

    def move_to(self, at: datetime) -> None:
        """Move to `at` (never backwards) and wake everyone who slept until then."""
        if at < self._now:
            raise ValueError(f"A clock never goes backwards: it shows {self._now}, asked for {at}.")
        self._now = at
        if not self._sleepers:
            return
        for until, woken in self._sleepers:
            if until <= at:
                woken.set()
        self._sleepers = [sleeper for sleeper in self._sleepers if sleeper[0] > at]

    def advance(self, by: timedelta) -> None:
        """Move forward by a length of time."""
        self.move_to(self._now + by)

    async def sleep_until(self, at: datetime) -> None:
        """Wait until somebody moves this clock to `at`."""
        if at <= self._now:
            return
        woken = asyncio.Event()
        self._sleepers.append((at, woken))
        await woken.wait()


def _as_set(at: datetime, anchor: datetime, drift: timedelta) -> datetime:
    return at if at < anchor else at + drift


async def give_way() -> None:
    """Let everything else that is due run once: what answers a flood of requests does so between any two."""
    await asyncio.sleep(0)


async def set_or_at(event: asyncio.Event, clock: Clock, until: datetime) -> None:
    """Return once an event is set, or at an instant, whichever comes first."""
    waits = {asyncio.create_task(event.wait()), asyncio.ensure_future(clock.sleep_until(until))}
    try:
        await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for wait in waits:
            wait.cancel()
        await asyncio.gather(*waits, return_exceptions=True)


def is_within(at: datetime, now: datetime, span: timedelta, *, ahead: timedelta = NOTHING) -> bool:
    """Return whether this was less than `span` ago; what lies further in the future than `ahead` was not.

    What was stored, or noted by a clock that is set, may lie there because that clock was ahead: no span that
    guards something lasts until then.
    """
    return -ahead <= now - at < span


def lasts(until: datetime, now: datetime, longest: timedelta) -> bool:
    """Return whether what ends at `until` goes on; what would go on for more than `longest` has ended."""
    return NOTHING < until - now <= longest
