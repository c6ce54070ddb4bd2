"""All of the machine's other doors together: begun with it, ended with it, never in its way."""

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from typing import Protocol

from app.base.clock import Clock
from app.base.lasting import begun
from app.base.logs import get_logger
from app.base.message import N_, NOTHING, Message, say
from app.base.settings import Settings
from app.base.startup import late
from app.gateway.notices import post_webhook, send_mail
from app.gateway.notifier import Deliver, Notifier
from app.gateway.outbox import Outbox
from app.gateway.ports import MQTT_NAME, Door
from app.gateway.sunspec import RTU, TCP, SunSpecRtu, SunSpecTcp
from app.gateway.sunspec_device import SERIAL, SunSpecDevice
from app.link.messages import Order, SiteDetail, Update
from app.link.metrics import GatewayMetrics, GatewayStatus, MachineMetrics
from app.link.outlet import Listener
from app.store.store import Reader
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.tracker.values.notifications import Channel

TELL_AGAIN_S = 1.0
OUTBOX_NAME = "mqtt-outbox.json"

CHANNELS: tuple[tuple[str, Channel, Deliver], ...] = (
    (N_("Webhook"), Channel.WEBHOOK, post_webhook),
    ("E-mail", Channel.MAIL, send_mail),
)

log = get_logger()


class Gateway(Protocol):
    """One door."""

    async def run(self) -> None:
        """Serve until cancelled."""

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""


class MeteredDoor(Door, Protocol):
    """A machine that also counts, and tells who listens what changed."""

    def listen(self) -> Listener:
        """Return a new subscriber of its updates."""

    async def watch(self, tracker_ids: frozenset[str], who: object = None) -> None:
        """Have snapshots of these trackers told with their actions, as long as one who watches them does."""

    async def metrics(self) -> MachineMetrics:
        """Return the counters."""


class Gateways:
    """Runs every door that the settings open, and is the machine for the panel, with the doors' metrics."""

    def __init__(self, machine: MeteredDoor, clock: Clock, settings: Settings, reader: Reader) -> None:
        self._machine = machine
        self._clock = clock
        device = SunSpecDevice(
            machine, clock, unit=settings.sunspec_unit_id, write_hosts=settings.sunspec_write_hosts
        )
        self._sunspec = device
        self._writes = writes(settings)
        self._open: list[Gateway] = []
        self._off: list[GatewayMetrics] = []
        self._notifiers: list[Notifier] = []
        self._tasks: list[asyncio.Task[None]] = []
        self._add(TCP, "SUNSPEC_PORT", settings.sunspec_port, lambda: SunSpecTcp(device, clock, settings))
        self._add(
            RTU,
            "SUNSPEC_SERIAL_PORT",
            settings.sunspec_serial_port,
            lambda: SunSpecRtu(device, clock, settings),
        )
        outbox = Outbox(reader, settings.data_dir / OUTBOX_NAME)
        self._add(
            MQTT_NAME,
            "MQTT_HOST",
            settings.mqtt_host,
            lambda: late("app.gateway.mqtt").MqttGateway(machine, clock, settings, outbox),
        )
        for name, channel, deliver in CHANNELS:
            sent = Outbox(reader, settings.data_dir / f"{channel}-outbox.json")
            self._notifiers.append(Notifier(name, channel, deliver, machine, clock, settings, sent))

    def _add(self, name: str, variable: str, wanted: object, make: Callable[[], Gateway]) -> None:
        """Make a door if the settings want it, else note how it is opened."""
        if wanted is None:
            off = say("set HELIOPANEL_{variable} to enable it", variable=variable)
            self._off.append(GatewayMetrics(name, GatewayStatus.OFF, off))
        else:
            self._open.append(make())

    def start(self) -> None:
        """Open the doors."""
        for gateway in (*self._open, *self._notifiers):
            self._tasks.append(begun(gateway.metrics().name, gateway.run, self._clock))
        if self._open:
            self._tasks.append(begun(N_("SunSpec controls"), self._sunspec.follow, self._clock))

    async def close(self) -> None:
        """Close the doors; one that goes on, because an error came together with its end, is told again."""
        while pending := [task for task in self._tasks if not task.done()]:
            for task in pending:
                task.cancel()
            await asyncio.wait(pending, timeout=TELL_AGAIN_S)

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order."""
        return await self._machine.execute(order)

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        return await self._machine.detail()

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot."""
        return self._machine.latest()

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now, with what may be asked of it."""
        return await self._machine.tracker(tracker_id)

    async def watch(self, tracker_ids: frozenset[str], who: object = None) -> None:
        """Have snapshots of these trackers told with their actions."""
        await self._machine.watch(tracker_ids, who)

    def listen(self) -> Listener:
        """Return a new subscriber of the machine's updates."""
        return self._machine.listen()

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the machine ends."""
        return self._machine.updates()

    async def metrics(self) -> MachineMetrics:
        """Return the machine's counters and how its doors are doing."""
        sent = tuple(notifier.metrics() for notifier in self._notifiers)
        doors = (gateway.metrics() for gateway in self._open)
        told = (replace(door, writes=self._writes.get(door.name, NOTHING)) for door in doors)
        gateways = (*told, *self._off, *sent)
        return replace(await self._machine.metrics(), gateways=gateways)


def writes(settings: Settings) -> dict[str, Message]:
    """Return for every door that takes orders who may give them."""
    hosts = [host for host in settings.sunspec_write_hosts if host != SERIAL]
    commands = say(
        "Any client that may publish below {mqtt_base_topic} at the broker may send commands.",
        mqtt_base_topic=settings.mqtt_base_topic,
    )
    return {
        TCP: say("{hosts} may write; all other hosts can only read.", hosts=", ".join(hosts))
        if hosts
        else N_("No host may write."),
        RTU: N_("The master on the line may write.")
        if SERIAL in settings.sunspec_write_hosts
        else N_("No host may write."),
        MQTT_NAME: commands if settings.mqtt_commands else N_("No commands are accepted."),
    }
