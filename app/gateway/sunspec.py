"""The SunSpec gateway: one map, served over Modbus TCP and, if asked for, on a serial line."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import timedelta

import structlog

from app.clock import Clock
from app.drives.modbus_server import ModbusServer
from app.gateway.door import Door
from app.gateway.sunspec_device import SunSpecDevice
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.settings import Settings

TRY_AGAIN = timedelta(seconds=10)

log = structlog.get_logger(__name__)


class SunSpecTcp:
    """Listens on one port; a port that is taken is tried again every ten seconds."""

    def __init__(self, door: Door, clock: Clock, settings: Settings) -> None:
        self._door = door
        self._clock = clock
        self._host = settings.sunspec_host
        self._port = settings.sunspec_port or 0
        self._device = SunSpecDevice(
            door, clock, unit=settings.sunspec_unit, write_hosts=settings.sunspec_write_hosts
        )
        self._server = ModbusServer(
            self._device, settings.sunspec_unit, respond=self._device.respond, most_clients=16
        )
        self._listening = False
        self._error = ""

    @property
    def port(self) -> int:
        """Return the port, once it listens."""
        return self._port

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""
        status = GatewayStatus.LISTENING if self._listening else GatewayStatus.FAILED
        where = f"{self._host}:{self._port}"
        return GatewayMetrics(
            "SunSpec over Modbus TCP", status, where, self._server.client_count, self._error
        )

    async def run(self) -> None:
        """Serve until cancelled."""
        async with self._served():
            while True:
                async for update in self._door.updates():
                    await self._device.controls.calibrations.follow(update)
                await self._clock.sleep_until(self._clock.now() + TRY_AGAIN)

    @asynccontextmanager
    async def _served(self) -> AsyncIterator[None]:
        try:
            await self._listen()
            yield
        finally:
            self._listening = False
            await self._server.close()

    async def _listen(self) -> None:
        while not self._listening:
            try:
                self._port = await self._server.start(self._host, self._port)
                self._listening, self._error = True, ""
            except OSError as error:
                self._error = (
                    f"It cannot listen on {self._host} port {self._port}: {error.strerror}. Stop the program "
                    "that uses the port, or choose another with HELIOPANEL_SUNSPEC_PORT."
                )
                log.error("sunspec_not_listening", reason=self._error)
                await self._clock.sleep_until(self._clock.now() + TRY_AGAIN)
