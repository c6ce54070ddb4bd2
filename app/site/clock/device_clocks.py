"""How far the clocks of the devices that look at the site's pages are from the site's own."""

from datetime import datetime, timedelta
from typing import NamedTuple

from app.base.clock import Clock
from app.tracker.access.location_change import MOST_APART

UNHEARD = timedelta(seconds=150)
"""A page that was not heard of for so long is gone; one that is hidden tells once a minute."""
MOST_DEVICES = 1000


class DeviceClock(NamedTuple):
    """A device of somebody, by how much the site's clock is ahead of it, and when it was heard last."""

    whose: str
    ahead: timedelta
    heard_at: datetime


class DeviceClocks:
    """Those that differ by more than a minute, by page; at most 1,000, the latest."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._pages: dict[str, DeviceClock] = {}

    def heard(self, page: str, whose: str, ahead: timedelta) -> None:
        """Note what a page told of the clock of its device."""
        self._pages.pop(page, None)
        if abs(ahead) > MOST_APART:
            self._pages[page] = DeviceClock(whose, ahead, self._clock.now())
        if len(self._pages) > MOST_DEVICES:
            del self._pages[next(iter(self._pages))]

    def furthest(self) -> DeviceClock | None:
        """Return the one that differs most, None where none that is still heard differs."""
        now = self._clock.now()
        self._pages = {page: one for page, one in self._pages.items() if now - one.heard_at <= UNHEARD}
        return max(self._pages.values(), key=lambda one: abs(one.ahead), default=None)
