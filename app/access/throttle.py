"""How long to wait after wrong passwords: longer with every one, never longer than 30 s, never for ever."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.base.clock import is_within

LONGEST = timedelta(seconds=30)
FORGOTTEN_AFTER = timedelta(hours=24)
FREE = 2
"""So many mistakes cost nothing: people mistype."""


@dataclass(frozen=True, slots=True)
class Failures:
    """How often in a row something was wrong for one account or one address, and when last."""

    count: int
    last_at: datetime


def delay(failures: Failures) -> timedelta:
    """Return how long after the last failure the next try is looked at: 1, 2, 4 ... 30 s."""
    beyond = failures.count - FREE
    return min(timedelta(seconds=2.0 ** min(beyond - 1, 10)), LONGEST) if beyond > 0 else timedelta()


def one_more(failures: Failures | None, now: datetime) -> Failures:
    """Return the failures after one more; those of yesterday are forgotten, those of the future count."""
    fresh = failures is None or now - failures.last_at > FORGOTTEN_AFTER
    return Failures(1 if fresh or failures is None else failures.count + 1, now)


def wait_left(failures: Iterable[Failures], now: datetime) -> timedelta:
    """Return how long to wait before another try is looked at, zero where none is needed.

    A failure that lies in the future, because the clock was ahead, makes nobody wait.
    """
    waits = [one.last_at + delay(one) - now for one in failures if is_within(one.last_at, now, LONGEST)]
    return max([wait for wait in waits if wait > timedelta()], default=timedelta())
