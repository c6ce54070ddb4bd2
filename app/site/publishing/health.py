"""What the machine counts about itself, as shares of the last minute."""

import os
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path

from app.alarms.conditions import Condition, SiteHealth
from app.link.metrics import LATENESS_BOUNDS_MS, TrackerMetrics

EVERY = timedelta(seconds=10)
STATM = Path("/proc/self/statm")
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")
SAMPLES = 7
LATE_FROM = LATENESS_BOUNDS_MS.index(100.0) + 1
FEWEST_TICKS = 50


@dataclass(slots=True)
class HealthWatch:
    """Samples the counters of every tracker and the free disk; the shares are over the samples kept."""

    disk_free: Callable[[], int | None]
    _samples: deque[dict[str, TrackerMetrics]] = field(default_factory=lambda: deque(maxlen=SAMPLES))
    _sampled_at: datetime | None = None
    _disk_free_bytes: int | None = None
    _late_share: float | None = None
    _unread_shares: dict[str, float] = field(default_factory=dict)

    def look(
        self,
        now: datetime,
        counters: Callable[[], dict[str, TrackerMetrics]],
        *,
        store_behind: bool,
        troubles: tuple[Condition, ...],
    ) -> SiteHealth:
        """Return how the machine is doing; the counters are read when it is time for a sample."""
        if self._sampled_at is None or now - self._sampled_at >= EVERY:
            self._sampled_at = now
            self._samples.append(counters())
            self._disk_free_bytes = self.disk_free()
            self._late_share, self._unread_shares = self._late(), self._unread()
        return SiteHealth(
            store_behind, self._disk_free_bytes, self._late_share, self._unread_shares, troubles
        )

    def _late(self) -> float | None:
        newest, oldest = self._samples[-1], self._samples[0]
        both = newest.keys() & oldest.keys()
        ticks = sum(sum(newest[one].lateness_counts) - sum(oldest[one].lateness_counts) for one in both)
        late = sum(_late(newest[one]) - _late(oldest[one]) for one in both)
        return late / ticks if ticks >= FEWEST_TICKS else None

    def _unread(self) -> dict[str, float]:
        newest, oldest = self._samples[-1], self._samples[0]
        found = {}
        for one in newest.keys() & oldest.keys():
            ticks = newest[one].ticks - oldest[one].ticks
            if ticks >= FEWEST_TICKS:
                found[one] = (newest[one].read_failures - oldest[one].read_failures) / ticks
        return found


def resident_bytes() -> int | None:
    """Return the memory that this process has in use, None where the system does not tell."""
    try:
        return int(STATM.read_text().split()[1]) * PAGE_BYTES
    except OSError:
        return None


def _late(counted: TrackerMetrics) -> int:
    return sum(counted.lateness_counts[LATE_FROM:])
