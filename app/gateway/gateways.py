"""All of the machine's other doors together: begun with it, ended with it, never in its way."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Protocol

import structlog

from app.clock import Clock
from app.gateway.door import Door
from app.gateway.mqtt import MqttGateway
from app.gateway.outbox import Outbox
from app.gateway.sunspec import SunSpecTcp
from app.link.messages import Order, SiteDetail, Update
from app.link.metrics import GatewayMetrics, GatewayStatus, MachineMetrics
from app.settings import Settings
from app.store.store import Reader
from app.tracker.snapshot import SiteSnapshot

OUTBOX_NAME = "mqtt-outbox.json"

log = structlog.get_logger(__name__)


class Gateway(Protocol):
    """One door."""

    async def run(self) -> None:
        """Serve until cancelled."""

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""


class MeteredDoor(Door, Protocol):
    """A machine that also counts."""

    async def metrics(self) -> MachineMetrics:
        """Return the counters."""


class Gateways:
    """Runs every door that the settings open, and is the machine for the panel, with the doors' metrics."""

    def __init__(self, machine: MeteredDoor, clock: Clock, settings: Settings, reader: Reader) -> None:
        self._machine = machine
        self._open, self._off = _doors(machine, clock, settings, reader)
        self._tasks: list[asyncio.Task[None]] = []

    def start(self) -> None:
        """Open the doors."""
        for gateway in self._open:
            task = asyncio.create_task(gateway.run(), name=gateway.metrics().name)
            task.add_done_callback(_log_end)
            self._tasks.append(task)

    async def close(self) -> None:
        """Close the doors."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order."""
        return await self._machine.execute(order)

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        return await self._machine.detail()

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot."""
        return self._machine.latest()

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the machine ends."""
        return self._machine.updates()

    async def metrics(self) -> MachineMetrics:
        """Return the machine's counters and how its doors are doing."""
        gateways = (*(gateway.metrics() for gateway in self._open), *self._off)
        return replace(await self._machine.metrics(), gateways=gateways)


def _doors(
    machine: Door, clock: Clock, settings: Settings, reader: Reader
) -> tuple[tuple[Gateway, ...], tuple[GatewayMetrics, ...]]:
    """Return the doors that are open, and what is told of those that are not."""
    opened: list[Gateway] = []
    off: list[GatewayMetrics] = []
    if settings.sunspec_port is not None:
        opened.append(SunSpecTcp(machine, clock, settings))
    else:
        off.append(_off("SunSpec over Modbus TCP", "SUNSPEC_PORT"))
    if settings.mqtt_host is not None:
        outbox = Outbox(reader, settings.data_dir / OUTBOX_NAME)
        opened.append(MqttGateway(machine, clock, settings, outbox))
    else:
        off.append(_off("MQTT", "MQTT_HOST"))
    return tuple(opened), tuple(off)


def _off(name: str, variable: str) -> GatewayMetrics:
    return GatewayMetrics(name, GatewayStatus.OFF, f"set HELIOPANEL_{variable} to open it")


def _log_end(task: asyncio.Task[None]) -> None:
    """Say that a door is shut by an error nobody foresaw; the machine goes on."""
    if not task.cancelled() and task.exception() is not None:
        log.error("gateway_ended", gateway=task.get_name(), error=repr(task.exception()))
