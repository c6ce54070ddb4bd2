"""Hold-to-run as the panel judges it: how late a heartbeat is, and which presses are dead.

The machine judges the lease itself; here only what the machine cannot know is taken off: how long the
heartbeat was on its way from the browser.
"""

from collections import OrderedDict
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum
from typing import NamedTuple

from app.tracker.commands.commands import JOG_LEASE

LATEST_HEARTBEAT = timedelta(milliseconds=120)
SLOWEST_ROUND_TRIP = timedelta(milliseconds=240)
CLOCK_DRIFT = 2e-4
MOST_DEAD = 10_000
MOST_LIVE = 8
"""So many presses a connection has at most; one more ends the oldest, which its lease ends too."""


class LinkDelay:
    """The delay beyond the quickest message of this connection, from the clock of the browser.

    The browser's clock may drift by 200 parts in a million against ours, so the quickest message is
    forgotten as slowly as that.
    """

    def __init__(self) -> None:
        self._best: timedelta | None = None
        self._at: datetime | None = None

    def beyond_best(self, sent_ms: float, arrived: datetime) -> timedelta:
        """Return by how much a message that was sent at `sent_ms` came later than the quickest one."""
        offset = timedelta(seconds=arrived.timestamp()) - timedelta(milliseconds=sent_ms)
        if self._best is None or self._at is None:
            self._best = offset
        else:
            self._best = min(offset, self._best + (arrived - self._at) * CLOCK_DRIFT)
        self._at = arrived
        return offset - self._best


class Dead:
    """Presses that have ended once, on any connection; the oldest are forgotten beyond 10,000."""

    def __init__(self) -> None:
        self._presses: OrderedDict[str, None] = OrderedDict()

    def bury(self, press_id: str) -> None:
        """Remember that a press has ended."""
        self._presses[press_id] = None
        if len(self._presses) > MOST_DEAD:
            self._presses.popitem(last=False)

    def __contains__(self, press_id: str) -> bool:
        return press_id in self._presses


class Verdict(StrEnum):
    """What a heartbeat is worth."""

    RENEW = "renew"
    IGNORE = "ignore"
    DEAD = "dead"
    TOO_SLOW = "too_slow"
    UNMEASURED = "unmeasured"


@dataclass(frozen=True, slots=True)
class Heartbeat:
    """One sign of life of a held key, as it arrived."""

    press_id: str
    tracker_id: str
    sequence: int
    sent_ms: float
    arrived: datetime
    round_trip: timedelta | None = None


class _Held(NamedTuple):
    tracker_id: str
    sequence: int
    until: datetime


class Presses:
    """The presses of one connection; one that was not renewed in time is dead, as it is for the machine."""

    def __init__(self, delay: LinkDelay, dead: Dead) -> None:
        self._delay = delay
        self._dead = dead
        self._live: dict[str, _Held] = {}

    def judge(self, beat: Heartbeat) -> tuple[Verdict, timedelta]:
        """Return what to do with a heartbeat, and for `RENEW` the lease that is left of it.

        A press begins only once the page knows a round trip: then a message of this connection has come
        quickly, and what a frozen link delivers late is known by that. Before, all may be equally late.
        """
        extra = self._delay.beyond_best(beat.sent_ms, beat.arrived)
        self._bury_overdue(beat.arrived)
        if beat.press_id in self._dead:
            return Verdict.DEAD, timedelta()
        known = self._live.get(beat.press_id)
        if known is not None and beat.sequence <= known.sequence:
            return Verdict.IGNORE, timedelta()
        if known is None and beat.round_trip is None:
            return Verdict.UNMEASURED, timedelta()
        if extra > LATEST_HEARTBEAT or _too_slow(beat.round_trip):
            return (Verdict.TOO_SLOW if known is None else Verdict.IGNORE), timedelta()
        if known is None and len(self._live) >= MOST_LIVE:
            self.end(next(iter(self._live)))
        lease = JOG_LEASE - extra
        self._live[beat.press_id] = _Held(beat.tracker_id, beat.sequence, beat.arrived + lease)
        return Verdict.RENEW, lease

    def end(self, press_id: str) -> bool:
        """Let a press be dead for ever; return whether it was one of this connection and lived."""
        self._dead.bury(press_id)
        return self._live.pop(press_id, None) is not None

    def end_all(self, now: datetime) -> list[tuple[str, str]]:
        """End every press that is still held; return their trackers and ids."""
        self._bury_overdue(now)
        ended = [(held.tracker_id, press_id) for press_id, held in self._live.items()]
        for _, press_id in ended:
            self.end(press_id)
        return ended

    def _bury_overdue(self, now: datetime) -> None:
        for press_id in [press_id for press_id, held in self._live.items() if held.until <= now]:
            self.end(press_id)


def _too_slow(round_trip: timedelta | None) -> bool:
    return round_trip is not None and round_trip > SLOWEST_ROUND_TRIP
