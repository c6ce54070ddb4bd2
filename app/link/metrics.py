"""What the machine counts about itself, as plain data; the panel makes the text of it."""

from dataclasses import dataclass, field
from enum import StrEnum

from app.base.message import NOTHING, Message

LATENESS_BOUNDS_MS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)


@dataclass(frozen=True, slots=True)
class TrackerMetrics:
    """Counters of one tracker since the machine started.

    `lateness_counts` are the ticks no later than each of `LATENESS_BOUNDS_MS`, not cumulative, the
    last one beyond all of them.
    """

    ticks: int
    read_failures: int
    write_failures: int
    lateness_counts: tuple[int, ...]
    lateness_sum_ms: float
    lateness_max_ms: float


@dataclass(frozen=True, slots=True)
class Lateness:
    """Ticks of any tracker that began no later than this, and later than the bound before."""

    at_most_ms: float
    ticks: int


class GatewayStatus(StrEnum):
    """How one of the machine's other doors is doing."""

    OFF = "off"
    LISTENING = "listening"
    CONNECTING = "connecting"
    CONNECTED = "connected"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class GatewayMetrics:
    """One other door: where it is, who uses it, what went wrong last, what waits, who may write."""

    name: str
    status: GatewayStatus
    where: Message = NOTHING
    clients: int = 0
    error: Message = NOTHING
    waiting: int = 0
    writes: Message = NOTHING


@dataclass(frozen=True, slots=True)
class MachineMetrics:
    """Counters and queue lengths of the whole machine."""

    boot_id: str
    uptime_s: float
    trackers: dict[str, TrackerMetrics] = field(default_factory=dict)
    link_clients: int = 0
    orders: int = 0
    orders_refused: int = 0
    events: int = 0
    events_waiting: int = 0
    samples_waiting: int = 0
    store_queue: int = 0
    store_failures: int = 0
    resident_bytes: int = 0
    lateness: tuple[Lateness, ...] = ()
    overloaded: bool = False
    gateways: tuple[GatewayMetrics, ...] = ()
