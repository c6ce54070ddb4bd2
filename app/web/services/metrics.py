"""What the machine and the panel count, as Prometheus reads it."""

from collections.abc import Iterable, Iterator, Mapping

from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import generate_latest
from prometheus_client.utils import floatToGoString

from app.link.metrics import (
    LATENESS_BOUNDS_MS,
    GatewayMetrics,
    GatewayStatus,
    MachineMetrics,
    TrackerMetrics,
)

GAUGES = {
    "uptime_s": "Seconds since the machine started.",
    "link_clients": "Panels that are connected to the machine.",
    "events_waiting": "Events that wait for a slow reader of the link.",
    "samples_waiting": "Recorded samples that wait to be stored.",
    "store_queue": "Writes that wait for the database.",
    "resident_bytes": "Memory of the machine's process.",
    "overloaded": "Whether the controller leaves out what is not motion because its ticks come late.",
}
COUNTERS = {
    "orders": "Orders that the machine got.",
    "orders_refused": "Orders that were refused.",
    "events": "Events that happened.",
    "store_failures": "Writes that the database refused.",
}
TRACKER_COUNTERS = {
    "ticks": "Control ticks.",
    "read_failures": "Drive readings that failed.",
    "write_failures": "Drive commands that failed.",
}

LATENESS = "heliopanel_tick_lateness_seconds"
BOUNDS = (*(f"{bound / 1000:g}" for bound in LATENESS_BOUNDS_MS), "+Inf")


class _Given:
    """Metrics that are already there."""

    def __init__(self, metrics: Iterable[Metric]) -> None:
        self._metrics = tuple(metrics)

    def collect(self) -> Iterator[Metric]:
        """Yield them."""
        yield from self._metrics


def exposition(machine: MachineMetrics | None, viewers: int) -> bytes:
    """Return everything in the text format; without a machine, `heliopanel_machine_up` is 0."""
    if machine is None:
        return _written(_panel(machine, viewers))
    site = _written([*_panel(machine, viewers), *_machine(machine)])
    trackers = "".join(_tracker_lines(machine.trackers)).encode()
    return site + trackers + _written(_gateways(machine.gateways))


def _written(metrics: Iterable[Metric]) -> bytes:
    registry = CollectorRegistry(auto_describe=False)
    registry.register(_Given(metrics))
    return generate_latest(registry)


def _panel(machine: MachineMetrics | None, viewers: int) -> Iterator[Metric]:
    yield _gauge("machine_up", "Whether the machine answers the panel.", 0.0 if machine is None else 1.0)
    yield _gauge("viewers", "Readers of the live stream.", float(viewers))


def _machine(machine: MachineMetrics) -> Iterator[Metric]:
    for name, text in GAUGES.items():
        yield _gauge(name, text, float(getattr(machine, name)))
    for name, text in COUNTERS.items():
        yield CounterMetricFamily(f"heliopanel_{name}", text, value=float(getattr(machine, name)))


def _tracker_lines(trackers: Mapping[str, TrackerMetrics]) -> Iterator[str]:
    """Yield what is counted of each tracker.

    A thousand trackers have 15,000 lines: written here they take a tenth of what the library takes for them.
    """
    labels = {tracker_id: f'tracker="{_escaped(tracker_id)}"' for tracker_id in trackers}
    for name, text in TRACKER_COUNTERS.items():
        family = f"heliopanel_tracker_{name}_total"
        yield f"# HELP {family} {text}\n# TYPE {family} counter\n"
        for tracker_id, tracker in trackers.items():
            yield f"{family}{{{labels[tracker_id]}}} {_number(getattr(tracker, name))}\n"
    yield f"# HELP {LATENESS} How late control ticks were.\n# TYPE {LATENESS} histogram\n"
    for tracker_id, tracker in trackers.items():
        yield from _lateness_lines(labels[tracker_id], tracker)


def _lateness_lines(label: str, tracker: TrackerMetrics) -> Iterator[str]:
    """Yield one tracker's ticks no later than each bound, all of them, and their lateness together."""
    count = 0
    for bound, more in zip(BOUNDS, tracker.lateness_counts, strict=False):
        count += more
        yield f'{LATENESS}_bucket{{le="{bound}",{label}}} {_number(count)}\n'
    yield f"{LATENESS}_count{{{label}}} {_number(count)}\n"
    yield f"{LATENESS}_sum{{{label}}} {_number(tracker.lateness_sum_ms / 1000)}\n"


def _number(value: float) -> str:
    return str(floatToGoString(value))  # type: ignore[no-untyped-call] # the library leaves it untyped


def _escaped(label: str) -> str:
    return label.replace("\\", r"\\").replace("\n", r"\n").replace('"', r"\"")


def _gateways(gateways: Iterable[GatewayMetrics]) -> Iterator[Metric]:
    """Yield the doors that are meant to be open."""
    up = GaugeMetricFamily("heliopanel_gateway_up", "Whether an integration is at work.", labels=["gateway"])
    waiting = GaugeMetricFamily(
        "heliopanel_gateway_waiting", "Messages that an integration still has to send.", labels=["gateway"]
    )
    for one in gateways:
        if one.status is not GatewayStatus.OFF:
            works = one.status in (GatewayStatus.LISTENING, GatewayStatus.CONNECTED)
            up.add_metric([one.name], float(works))
            waiting.add_metric([one.name], float(one.waiting))
    yield from (up, waiting)


def _gauge(name: str, text: str, value: float) -> Metric:
    return GaugeMetricFamily(f"heliopanel_{name}", text, value=value)
