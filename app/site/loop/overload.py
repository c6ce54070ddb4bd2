"""Whether the controller has more to do than it can, judged from how late its ticks come."""

from collections.abc import Callable
from datetime import datetime, timedelta

from app.alarms.conditions import SITE, Condition
from app.base.message import say, with_format

CODE = "overloaded"
LATE_MS = 30.0
WINDOW = timedelta(seconds=1)
FEWEST_LATE = 3
BEGINS_AT = 0.05
BEGINS_AFTER = 2
ENDS_BELOW = 0.01
ENDS_AFTER = 10
"""So many windows in a row: a pause of the computer is no overload, and one that comes and goes is one."""


class Overload:
    """Looks at the ticks of a second at a time; `changed` hears when an overload begins and when it ends."""

    def __init__(self, changed: Callable[["Overload"], None]) -> None:
        self._changed = changed
        self.active = False
        self.share = 0.0
        self._began_at: datetime | None = None
        self._ticks = self._late = self._streak = 0

    def count(self, late_ms: float, now: datetime) -> None:
        """Take in one tick that began so late."""
        self._ticks += 1
        self._late += late_ms > LATE_MS
        if self._began_at is None:
            self._began_at = now
        elif now - self._began_at >= WINDOW:
            self._judge(self._late / self._ticks, self._late)
            self._began_at, self._ticks, self._late = now, 0, 0

    def condition(self) -> Condition | None:
        """Return what is to be told, None unless there is an overload."""
        if not self.active:
            return None
        text = say(
            "{value} % of the ticks of a second began more than {late_ms} ms late.",
            value=with_format(100.0 * self.share, ".0f"),
            late_ms=with_format(LATE_MS, ".0f"),
        )
        return Condition(CODE, None, SITE, text)

    def _judge(self, share: float, late: int) -> None:
        """Judge a window: what speaks against the present state must last for some of them."""
        if self.active:
            self._streak = self._streak + 1 if share < ENDS_BELOW else 0
            enough = ENDS_AFTER
        else:
            self._streak = self._streak + 1 if share >= BEGINS_AT and late >= FEWEST_LATE else 0
            enough = BEGINS_AFTER
        if self._streak >= enough:
            self.active, self.share, self._streak = not self.active, share, 0
            self._changed(self)
