"""How often a tracker is asked whose drive shares a line, how long it may take, and when it counts as lost.

All three follow from the turn of the line: how long it takes until every device on it was asked and told.
"""

from dataclasses import dataclass
from datetime import timedelta
from math import ceil

from app.base.message import N_, say, with_format
from app.modbus.line_turn import LineTurn
from app.tracker.memory.observation import SILENCE
from app.tracker.settings.config import DriveKind
from app.tracker.values.reason import Reason

READ_SHARE = 0.8
LINE_WITHIN_S = 0.45
"""A serial line has its own pace. With this and a period of 0.1 s one missed reading loses no drive."""
ON_A_LINE = (DriveKind.MODBUS_RTU, DriveKind.MODBUS_RTU_OVER_TCP)
FULL = 0.8
"""Turns take this share of the time at most: some replies are late, and stops and hands come in between."""
CALMER = 1.3
"""A turn must be so much shorter before the drives are asked more often again."""
WITHIN_TURNS = 2.0
MISSED_ONCE = 1.5
OLDEST_S, OLDEST_PERIODS = 1.0, 3.0


def short_watchdog(watchdog_s: float | None, period_s: float) -> Reason | None:
    """Return that a drive stops by itself between two commands of a controller; None if it does not."""
    if watchdog_s is None or period_s <= FULL * watchdog_s:
        return None
    return Reason(
        "watchdog_short",
        say(
            "The drive stops automatically after {watchdog_s} s without a command, and this "
            "controller sends a command every {period_s} s.",
            watchdog_s=with_format(watchdog_s, "g"),
            period_s=with_format(period_s, "g"),
        ),
        say(
            "Set its watchdog to at least {period_s} s, or set HELIOPANEL_TICK_MS to {full} or less.",
            period_s=with_format(period_s / FULL, "g"),
            full=with_format(FULL * watchdog_s * 1000.0, ".0f"),
        ),
    )


@dataclass(frozen=True, slots=True)
class Pace:
    """A drive is asked at every so many ticks, may take `within_s`, and is lost after `silence`."""

    every: int
    within_s: float
    silence: timedelta = SILENCE


class LinePace:
    """The pace of one drive, kept in step with the turn of its line."""

    def __init__(self, kind: DriveKind, period: timedelta) -> None:
        self._period_s = period.total_seconds()
        self._alone_s = self._period_s * READ_SHARE
        if kind in ON_A_LINE:
            self._alone_s = max(self._alone_s, LINE_WITHIN_S)
        self.pace = Pace(1, self._alone_s)
        self._turn: LineTurn | None = None
        self._watchdog_s: float | None = None

    def follow(self, turn: LineTurn | None, watchdog_s: float | None) -> None:
        """Take in how the line is shared now."""
        self._turn, self._watchdog_s = turn, watchdog_s
        if turn is None or turn.devices < 2:
            self.pace = Pace(1, self._alone_s)
            return
        every = self._every(turn.turn_s, watchdog_s)
        within_s = max(self._alone_s, WITHIN_TURNS * turn.turn_s)
        period_s = every * self._period_s
        silence_s = min(period_s + MISSED_ONCE * within_s, max(OLDEST_S, OLDEST_PERIODS * period_s))
        self.pace = Pace(every, within_s, max(SILENCE, timedelta(seconds=silence_s)))

    def notice(self, name: str) -> Reason | None:
        """Return that a drive is asked less often than trackers tick, or too seldom; None if it is not."""
        turn, watchdog_s = self._turn, self._watchdog_s
        if against := short_watchdog(watchdog_s, self._period_s):
            return against
        if turn is None or turn.devices < 2:
            return None
        if watchdog_s is not None and turn.turn_s > watchdog_s:
            return Reason(
                "line_too_slow",
                say(
                    "The line of {name} takes {turn_s} s to reach its {devices} drives, and each stops "
                    "automatically after {watchdog_s} s without a command.",
                    name=name,
                    turn_s=with_format(turn.turn_s, ".1f"),
                    devices=turn.devices,
                    watchdog_s=with_format(watchdog_s, "g"),
                ),
                N_("Move some of the drives to another line, or increase their watchdog times."),
            )
        if self.pace.every == 1:
            return None
        return Reason(
            "line_shared",
            say(
                "The drive of {name} shares its line with {devices} others and is polled every {every} s.",
                name=name,
                devices=turn.devices - 1,
                every=with_format(self.pace.every * self._period_s, ".1f"),
            ),
            N_("Raise the baud rate, or move some of the drives to another line."),
        )

    def _every(self, turn_s: float, watchdog_s: float | None) -> int:
        """Return at how many ticks a turn has room, of which the drives' watchdogs allow only so many."""
        needed = max(1, ceil(turn_s / FULL / self._period_s))
        if needed < self.pace.every:
            needed = min(self.pace.every, max(1, ceil(turn_s * CALMER / FULL / self._period_s)))
        most = needed if watchdog_s is None else max(1, int(FULL * watchdog_s / self._period_s + 1e-9))
        return min(needed, most)
