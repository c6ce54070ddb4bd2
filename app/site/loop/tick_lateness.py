"""How late ticks come: of each tracker as a coarse histogram, of all together as a fine one."""

from bisect import bisect_left
from collections import Counter
from dataclasses import dataclass, field
from datetime import timedelta
from math import ceil, log

from app.link.metrics import LATENESS_BOUNDS_MS, Lateness, TrackerMetrics

FINEST_MS = 0.05
STEP = 1.02
"""Each bound of the fine histogram lies two per cent above the one before, so exact are its percentiles."""
MILLISECOND = timedelta(milliseconds=1)


@dataclass(slots=True)
class TickCounter:
    """Counts ticks, how late they were, and what the drive did not do."""

    ticks: int = 0
    read_failures: int = 0
    write_failures: int = 0
    counts: list[int] = field(default_factory=lambda: [0] * (len(LATENESS_BOUNDS_MS) + 1))
    sum_ms: float = 0.0
    max_ms: float = 0.0

    def late(self, late_ms: float) -> None:
        """Count one scheduled tick that began so many milliseconds after its time."""
        self.counts[bisect_left(LATENESS_BOUNDS_MS, late_ms)] += 1
        self.sum_ms += late_ms
        self.max_ms = max(self.max_ms, late_ms)

    def metrics(self) -> TrackerMetrics:
        """Return the counters as plain data."""
        return TrackerMetrics(
            self.ticks,
            self.read_failures,
            self.write_failures,
            tuple(self.counts),
            self.sum_ms,
            self.max_ms,
        )


class FineLateness:
    """The ticks of all trackers, counted by how late they began."""

    def __init__(self) -> None:
        self._counts: Counter[int] = Counter()

    def count(self, late_ms: float) -> None:
        """Count one scheduled tick that began so many milliseconds after its time."""
        self._counts[0 if late_ms <= FINEST_MS else ceil(log(late_ms / FINEST_MS) / _LOG_STEP)] += 1

    def metrics(self) -> tuple[Lateness, ...]:
        """Return how many ticks were no later than each bound that was needed, not cumulative."""
        return tuple(Lateness(FINEST_MS * STEP**step, self._counts[step]) for step in sorted(self._counts))


_LOG_STEP = log(STEP)
