"""Hold-to-run as the panel judges it: how late a heartbeat is, and which presses are dead.

The machine judges the lease itself; here only what the machine cannot know is taken off: how long the
heartbeat was on its way from the browser.
"""

from collections import OrderedDict
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum

from app.tracker.commands import JOG_LEASE

LATEST_HEARTBEAT = timedelta(milliseconds=120)
SLOWEST_ROUND_TRIP = timedelta(milliseconds=240)
CLOCK_DRIFT = 2e-4
MOST_DEAD = 10_000


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


class Presses:
    """The presses of one connection."""

    def __init__(self, delay: LinkDelay, dead: Dead) -> None:
        self._delay = delay
        self._dead = dead
        self._live: dict[str, tuple[str, int]] = {}

    def judge(self, beat: Heartbeat) -> tuple[Verdict, timedelta]:
        """Return what to do with a heartbeat, and for `RENEW` the lease that is left of it.

        A press begins only once the page knows a round trip: then a message of this connection has come
        quickly, and what a frozen link delivers late is known by that. Before, all may be equally late.
        """
        extra = self._delay.beyond_best(beat.sent_ms, beat.arrived)
        if beat.press_id in self._dead:
            return Verdict.DEAD, timedelta()
        known = self._live.get(beat.press_id)
        if known is not None and beat.sequence <= known[1]:
            return Verdict.IGNORE, timedelta()
        if known is None and beat.round_trip is None:
            return Verdict.UNMEASURED, timedelta()
        if extra > LATEST_HEARTBEAT or _too_slow(beat.round_trip):
            return (Verdict.TOO_SLOW if known is None else Verdict.IGNORE), timedelta()
        self._live[beat.press_id] = (beat.tracker_id, beat.sequence)
        return Verdict.RENEW, JOG_LEASE - extra

    def end(self, press_id: str) -> None:
        """Let a press be dead for ever."""
        self._live.pop(press_id, None)
        self._dead.bury(press_id)

    def end_all(self) -> list[tuple[str, str]]:
        """End every press of the connection; return their trackers and ids."""
        ended = [(tracker_id, press_id) for press_id, (tracker_id, _) in self._live.items()]
        for _, press_id in ended:
            self.end(press_id)
        return ended


def _too_slow(round_trip: timedelta | None) -> bool:
    return round_trip is not None and round_trip > SLOWEST_ROUND_TRIP
