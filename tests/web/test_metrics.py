"""What is counted of each tracker is written as the library for it would write it."""

from itertools import accumulate

from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, HistogramMetricFamily
from prometheus_client.exposition import generate_latest

from app.link.metrics import LATENESS_BOUNDS_MS, MachineMetrics, TrackerMetrics
from app.web.services.metrics import BOUNDS, LATENESS, TRACKER_COUNTERS, exposition

COUNTS = tuple(range(3, len(LATENESS_BOUNDS_MS) + 4))
TRACKERS = {
    "T1": TrackerMetrics(12_345_678, 0, 2, COUNTS, 1234.5, 3.0),
    'odd "name"\\\n': TrackerMetrics(1, 1, 1, COUNTS, 0.0, 0.0),
}


class Library:
    """The same families, made of the library's parts."""

    def collect(self) -> list[CounterMetricFamily | HistogramMetricFamily]:
        families: list[CounterMetricFamily | HistogramMetricFamily] = []
        for name, text in TRACKER_COUNTERS.items():
            family = CounterMetricFamily(f"heliopanel_tracker_{name}", text, labels=["tracker"])
            for tracker_id, tracker in TRACKERS.items():
                family.add_metric([tracker_id], float(getattr(tracker, name)))
            families.append(family)
        late = HistogramMetricFamily(LATENESS, "How late control ticks were.", labels=["tracker"])
        for tracker_id, tracker in TRACKERS.items():
            counts = map(float, accumulate(tracker.lateness_counts))
            buckets = list(zip(BOUNDS, counts, strict=True))
            late.add_metric([tracker_id], buckets, sum_value=tracker.lateness_sum_ms / 1000)
        return [*families, late]


def test_trackers_are_written_as_the_library_writes_them() -> None:
    registry = CollectorRegistry(auto_describe=False)
    registry.register(Library())
    written = exposition(MachineMetrics("b", 12.5, TRACKERS), 3).decode()
    assert generate_latest(registry).decode() in written
