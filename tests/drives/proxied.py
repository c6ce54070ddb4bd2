"""Devices behind a fault proxy, on every kind of wire, and what arrives there."""

import asyncio
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from app.drives.connections.buses import Buses
from app.modbus.line import Line, SerialLine, TcpLine
from app.modbus.listening_line import ListeningLine
from app.modbus.pty_line import PtyLine
from app.modbus.rtu_server import RtuServer
from app.modbus.server import Device, ModbusServer
from app.modbus.wire import Timing
from app.modbus.wire_faults import Framing
from app.simulation.servers.fault_proxy import FaultProxy
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from tests.drives.rigs import pending_tasks
from tests.patient_loop import LoopClock

BAUD_RATE = 19_200
TIMING = Timing(0.2)
STOP_REGISTER = 33
UNITS = (7, 8)
NOBODY: Mapping[int, Device] = {}


@dataclass
class Registers:
    """A device whose every register holds a number that no other register and no other unit has."""

    unit: int
    written: list[tuple[int, list[int]]] = field(default_factory=list)

    def words(self, address: int, count: int) -> list[int]:
        return [(address + place) * 3 + 1000 * self.unit for place in range(count)]

    def read_bits(self, function: int, address: int, count: int) -> list[bool]:
        return [False] * count

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        return self.words(address, count)

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        raise NotImplementedError

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        self.written.append((address, list(words)))

    async def let_out(self, reply: bytes) -> bytes | None:
        return reply


class Noting(FaultProxy):
    """A proxy that notes when stops arrive."""

    stopped_at_s: tuple[float, ...] = ()

    def _from_master(self, data: bytes) -> None:
        if bytes((6, 0, STOP_REGISTER)) in data:
            self.stopped_at_s = (*self.stopped_at_s, asyncio.get_running_loop().time())
        super()._from_master(data)


@dataclass
class Bench:
    """Two devices, and others that a test brings along, on one bus behind a proxy."""

    proxy: Noting
    buses: Buses
    config: DriveConfig
    devices: dict[int, Registers]

    def right(self, unit: int, address: int, count: int) -> list[int]:
        return self.devices[unit].words(address, count)


@asynccontextmanager
async def tcp_bench(others: Mapping[int, Device] = NOBODY) -> AsyncIterator[Bench]:
    devices = {unit: Registers(unit) for unit in UNITS}
    server = ModbusServer(devices[7], 7, others={8: devices[8], **others})
    port = await server.start("127.0.0.1", 0)
    near = ListeningLine("127.0.0.1", 0)
    proxy = Noting(near, TcpLine("127.0.0.1", port), Framing.TCP, LoopClock())
    await proxy.start()
    try:
        yield Bench(proxy, Buses(LoopClock()), DriveConfig(DriveKind.MODBUS_TCP, port=near.port), devices)
    finally:
        await proxy.close()
        await server.close()


@asynccontextmanager
async def rtu_bench(others: Mapping[int, Device] = NOBODY) -> AsyncIterator[Bench]:
    """A serial line that keeps the pace of 19200 baud."""
    with TemporaryDirectory() as folder:
        serial = SerialConfig(str(Path(folder) / "near"), BAUD_RATE)
        near = PtyLine(Path(serial.port), serial.bits / serial.baud_rate)
        far_name = str(Path(folder) / "far")
        async with _rtu(near, SerialLine(SerialConfig(far_name)), PtyLine(Path(far_name)), others) as found:
            proxy, devices = found
            config = DriveConfig(DriveKind.MODBUS_RTU, serial=serial)
            yield Bench(proxy, Buses(LoopClock()), config, devices)


@asynccontextmanager
async def gateway_bench(others: Mapping[int, Device] = NOBODY) -> AsyncIterator[Bench]:
    near, behind = ListeningLine("127.0.0.1", 0), ListeningLine("127.0.0.1", 0)
    async with _rtu(near, None, behind, others) as (proxy, devices):
        config = DriveConfig(DriveKind.MODBUS_RTU_OVER_TCP, port=near.port)
        yield Bench(proxy, Buses(LoopClock()), config, devices)


@asynccontextmanager
async def _rtu(
    near: Line, far: Line | None, behind: PtyLine | ListeningLine, others: Mapping[int, Device]
) -> AsyncIterator[tuple[Noting, dict[int, Registers]]]:
    devices = {unit: Registers(unit) for unit in UNITS}
    server = RtuServer({**devices, **others}, behind)
    await server.start()
    if isinstance(behind, ListeningLine):
        far = TcpLine("127.0.0.1", behind.port)
    assert far is not None
    proxy = Noting(near, far, Framing.RTU, LoopClock())
    await proxy.start()
    try:
        yield proxy, devices
    finally:
        await proxy.close()
        await server.close()
    assert not pending_tasks()


BENCHES = {"tcp": tcp_bench, "rtu": rtu_bench, "rtu-over-tcp": gateway_bench}
