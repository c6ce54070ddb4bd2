"""How late ticks come, as a histogram."""

from bisect import bisect_left
from dataclasses import dataclass, field
from datetime import timedelta

from app.link.metrics import LATENESS_BOUNDS_MS, TrackerMetrics


@dataclass(slots=True)
class TickCounter:
    """Counts ticks, how late they were, and what the drive did not do."""

    ticks: int = 0
    read_failures: int = 0
    write_failures: int = 0
    counts: list[int] = field(default_factory=lambda: [0] * (len(LATENESS_BOUNDS_MS) + 1))
    sum_ms: float = 0.0
    max_ms: float = 0.0

    def late(self, by: timedelta) -> None:
        """Count one scheduled tick that began this long after its time."""
        late_ms = max(0.0, by / timedelta(milliseconds=1))
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
