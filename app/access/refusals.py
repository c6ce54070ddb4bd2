"""Who was turned away, for the record: within bounds, so that a flood fills neither disk nor memory."""

from collections import OrderedDict
from dataclasses import dataclass
from datetime import datetime, timedelta
from threading import Lock

from app.access.events import AccessEvent
from app.access.principal import Principal
from app.base.clock import is_within
from app.base.message import say

BURST = 60
ONE_MORE_EVERY = timedelta(minutes=3)
TELL_EVERY = timedelta(hours=1)
"""So at most 564 entries on the first day and 504 on each later one, whatever is sent."""

SAME_WITHIN = timedelta(minutes=1)
MOST_REMEMBERED = 500
LEFT_OUT = "refusals_left_out"
LONGEST_WHY = 300


@dataclass(slots=True)
class Repeated:
    """The same refusal: when it was recorded last, and how often it came since."""

    at: datetime
    count: int = 0


class Refusals:
    """Takes every refusal, from any thread, and hands out those that are to be written."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._allowance = Allowance(BURST, ONE_MORE_EVERY)
        self._seen: OrderedDict[tuple[str, ...], Repeated] = OrderedDict()
        self._waiting: list[AccessEvent] = []
        self._left_out = 0
        self._told_at: datetime | None = None

    def note(self, action: str, who: Principal, thing: str, why: str, now: datetime) -> None:
        """Take a refusal; the same one again within a minute is only counted."""
        with self._lock:
            more = self._repeats((action, who.actor, who.address, thing), now)
            if more is None:
                return
            if not self._allowance.take(now):
                self._left_out += 1 + more
                return
            told = why if len(why) <= LONGEST_WHY else why[:LONGEST_WHY]
            if more:
                told = say("{why} ({more} more times before)", why=told, more=more)
            event = AccessEvent(
                now, who.actor[:100], who.via.value, who.address[:64], action, thing[:100], told
            )
            self._waiting.append(event)

    def leave_out(self) -> None:
        """Count something that was not recorded elsewhere because there was too much of it."""
        with self._lock:
            self._left_out += 1

    def take(self, now: datetime) -> list[AccessEvent]:
        """Return what is to be written now, with how many refusals were left out before."""
        with self._lock:
            due, self._waiting = self._waiting, []
            told = self._told_at is not None and is_within(self._told_at, now, TELL_EVERY)
            if self._left_out and not told:
                self._told_at = now
                result = say("{left_out} refusals were not recorded individually.", left_out=self._left_out)
                due.append(AccessEvent(now, "nobody", "nobody", "", LEFT_OUT, "panel", result))
                self._left_out = 0
            return due

    def _repeats(self, key: tuple[str, ...], now: datetime) -> int | None:
        """Return how often this came unrecorded before, None if it is only to be counted now."""
        seen = self._seen.get(key)
        if seen is not None and is_within(seen.at, now, SAME_WITHIN):
            seen.count += 1
            return None
        self._seen[key] = Repeated(now)
        self._seen.move_to_end(key)
        if len(self._seen) > MOST_REMEMBERED:
            _, oldest = self._seen.popitem(last=False)
            self._left_out += oldest.count
        return seen.count if seen else 0


class Allowance:
    """A number of entries at once, and one more every so often."""

    def __init__(self, most: int, every: timedelta) -> None:
        self._most = most
        self._every = every
        self._left = float(most)
        self._at: datetime | None = None

    def take(self, now: datetime) -> bool:
        """Return whether one more may be written, and count it."""
        if self._at is not None and now > self._at:
            self._left = min(self._most, self._left + (now - self._at) / self._every)
        self._at = now
        if self._left < 1:
            return False
        self._left -= 1
        return True
