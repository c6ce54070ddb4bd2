"""The SunSpec gateway: one map, served over Modbus TCP and on a serial line."""

import asyncio
from contextlib import suppress
from datetime import timedelta

from app.base.budget import Budget
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, NOTHING, plain, say, told_by
from app.base.settings import Settings
from app.gateway.sunspec_device import SERIAL, SunSpecDevice
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.modbus.clients import Limits
from app.modbus.line import SerialLine
from app.modbus.rtu_server import RtuServer
from app.modbus.server import ModbusServer
from app.tracker.settings.config import Parity, SerialConfig

TCP, RTU = N_("SunSpec over Modbus TCP"), N_("SunSpec over Modbus RTU")
TRY_AGAIN = timedelta(seconds=10)
LIMITS = Limits(most=16, requests_per_s=200.0, burst=50, idle_s=600.0)
"""Enough to read and write 100 trackers every second; a control system that asks faster is slowed down."""

log = get_logger()


class SunSpecTcp:
    """Listens on one port; a port that is taken is tried again every ten seconds."""

    def __init__(self, device: SunSpecDevice, clock: Clock, settings: Settings) -> None:
        self._clock = clock
        self._host = settings.sunspec_host
        self._port = settings.sunspec_port or 0
        self._server = ModbusServer(
            device, settings.sunspec_unit_id, respond=device.respond, limits=LIMITS, clock=clock
        )
        self._listening = False
        self._error = NOTHING

    @property
    def port(self) -> int:
        """Return the port, 0 before it listens on a free one."""
        return self._port

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""
        status = GatewayStatus.LISTENING if self._listening else GatewayStatus.FAILED
        where = plain(f"{self._host}:{self._port}")
        return GatewayMetrics(TCP, status, where, self._server.client_count, self._error)

    async def run(self) -> None:
        """Serve until cancelled."""
        try:
            while not self._listening:
                await self._listen()
            await asyncio.Event().wait()
        finally:
            self._listening = False
            await self._server.close()

    async def _listen(self) -> None:
        try:
            self._port = await self._server.start(self._host, self._port)
        except OSError as error:
            self._error = say(
                "SunSpec cannot listen on {host} port {port}: {strerror}. Stop the program that uses "
                "the port, or choose another with HELIOPANEL_SUNSPEC_PORT.",
                host=self._host,
                port=self._port,
                strerror=error.strerror,
            )
            log.error("sunspec_not_listening", reason=self._error)
            await self._clock.sleep_until(self._clock.now() + TRY_AGAIN)
        else:
            self._listening, self._error = True, NOTHING


class SunSpecRtu:
    """Serves a serial line; one that is not there or vanishes is tried again every ten seconds."""

    def __init__(self, device: SunSpecDevice, clock: Clock, settings: Settings) -> None:
        self._device = device
        self._clock = clock
        self._unit = settings.sunspec_unit_id
        self._serial = SerialConfig(
            settings.sunspec_serial_port or "", settings.sunspec_baud_rate, Parity(settings.sunspec_parity)
        )
        self._serving = False
        self._error = NOTHING

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""
        status = GatewayStatus.LISTENING if self._serving else GatewayStatus.FAILED
        line = self._serial
        where = say(
            "{port}, {baud_rate} baud, parity {parity}",
            port=line.port,
            baud_rate=line.baud_rate,
            parity=line.parity,
        )
        return GatewayMetrics(RTU, status, where, error=self._error)

    async def run(self) -> None:
        """Serve until cancelled."""
        while True:
            server = RtuServer(
                {self._unit: self._device},
                SerialLine(self._serial),
                respond=self._respond,
                budget=Budget(self._clock, per_s=LIMITS.requests_per_s or 1.0, burst=LIMITS.burst),
            )
            try:
                await server.start()
                self._serving, self._error = True, NOTHING
                await server.until_lost()
                self._error = N_("The serial line was lost.")
            except OSError as error:
                self._error = say("{error} Heliopanel retries automatically.", error=told_by(error))
            finally:
                self._serving = False
                with suppress(OSError):
                    await server.close()
            log.error("sunspec_not_on_line", reason=self._error)
            await self._clock.sleep_until(self._clock.now() + TRY_AGAIN)

    async def _respond(self, request: bytes, _: str) -> bytes:
        return await self._device.respond(request, SERIAL)
