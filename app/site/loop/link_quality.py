"""How a drive's replies come: the time that 99 of 100 readings took, of the newest 300."""

from collections import deque
from datetime import timedelta

from app.tracker.protections.words import LinkQuality

COUNTED = 300
FEWEST = 100
SHARE = 0.99


class RoundTrips:
    """Times from asking a drive to its reply; a reading that failed counts as none."""

    def __init__(self) -> None:
        self._newest: deque[float] = deque(maxlen=COUNTED)
        self._p99_s: float | None = None
        self._counted = 0

    def count(self, took: timedelta) -> None:
        """Take in one good reading; every tenth the figure is made anew."""
        self._newest.append(took.total_seconds())
        self._counted += 1
        if len(self._newest) >= FEWEST and (self._p99_s is None or self._counted % 10 == 0):
            self._p99_s = sorted(self._newest)[int(SHARE * len(self._newest))]

    def quality(self, allowed_s: float) -> LinkQuality | None:
        """Return how replies came, None while too few were counted."""
        return None if self._p99_s is None else LinkQuality(self._p99_s, allowed_s)
