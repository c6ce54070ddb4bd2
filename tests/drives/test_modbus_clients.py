"""Clients of a Modbus server that flood it, take no answers, or sit there and say nothing."""

import asyncio
import socket
from collections import Counter
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from struct import pack

import pytest

from app.base.budget import Budget
from app.base.clock import VirtualClock
from app.modbus.clients import Limits
from app.modbus.line import SerialLine
from app.modbus.pty_line import PtyLine
from app.modbus.rtu_frame import sealed
from app.modbus.rtu_server import RtuServer
from app.modbus.server import ModbusServer
from app.tracker.settings.config import Parity, SerialConfig
from tests.captured_logs import capture_logs
from tests.drives.proxied import Registers as AnyRegisters
from tests.fault_result import VIRTUAL, FaultResult
from tests.patience import eventually

READ = pack(">HHHBBHH", 7, 0, 6, 1, 3, 0, 125)
REPLY_BYTES = 259
READ_RTU = sealed(pack(">BBHH", 1, 3, 0, 125))


@dataclass
class Registers(AnyRegisters):
    """A device that notes in which turn of the loop it was asked."""

    unit: int = 1
    turn: int = 0
    asked: Counter[int] = field(default_factory=Counter)

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        self.asked[self.turn] += 1
        return super().read_registers(function, address, count)

    async def count_turns(self) -> None:
        """Count the turns of the loop: what else this process has to do runs once in each."""
        while True:
            self.turn += 1
            await asyncio.sleep(0)

    async def until_asked(self, count: int) -> None:
        await eventually(lambda: self.asked.total() >= count)


@asynccontextmanager
async def served(
    limits: Limits, clock: VirtualClock | None = None
) -> AsyncIterator[tuple[ModbusServer, Registers, int]]:
    registers = Registers()
    server = ModbusServer(registers, limits=limits, clock=clock)
    port = await server.start("127.0.0.1", 0)
    try:
        yield server, registers, port
    finally:
        await server.close()


@asynccontextmanager
async def flooding(port: int) -> AsyncIterator[asyncio.Task[None]]:
    """A client that sends reads as fast as they are taken and never takes an answer; it ends when cut off."""
    loop = asyncio.get_running_loop()
    with socket.socket() as client:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        client.setblocking(False)
        await loop.sock_connect(client, ("127.0.0.1", port))

        async def send() -> None:
            with suppress(ConnectionError):
                while True:
                    await loop.sock_sendall(client, READ * 200)

        sending = asyncio.create_task(send())
        try:
            yield sending
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)


async def opened(port: int, host: str = "127.0.0.1") -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    return await asyncio.open_connection("127.0.0.1", port, local_addr=(host, 0))


async def is_answered(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bool:
    """Ask once and return whether there was a reply; False says that the connection was closed."""
    try:
        writer.write(READ)
        await asyncio.wait_for(reader.readexactly(REPLY_BYTES), 5.0)
    except (ConnectionError, asyncio.IncompleteReadError):
        return False
    return True


@pytest.mark.real_time
@pytest.mark.parametrize("clients", [1, 4])
async def test_between_two_replies_to_a_flood_everything_else_has_its_turn(clients: int) -> None:
    async with served(Limits()) as (_, registers, port):
        counting = asyncio.create_task(registers.count_turns())
        floods = [flooding(port) for _ in range(clients)]
        for flood in floods:
            await flood.__aenter__()
        await registers.until_asked(2000)
        for flood in floods:
            await flood.__aexit__(None, None, None)
        counting.cancel()
    assert max(registers.asked.values()) <= clients


@pytest.mark.fault(88)
async def test_a_client_that_takes_no_replies_is_cut_off(fault: FaultResult) -> None:
    loop = asyncio.get_running_loop()
    async with served(Limits()) as (server, _, port):
        began_s = loop.time()
        with capture_logs() as logged:
            async with flooding(port) as sending, asyncio.timeout(30):
                await sending
        cut_off_s = loop.time() - began_s
        assert Limits().take_s <= cut_off_s <= Limits().take_s + Limits().rest_s
        assert server.client_count == 0
        assert [(line["event"], line["host"]) for line in logged] == [("modbus_client_dropped", "127.0.0.1")]
        fault.noticed(cut_off_s, VIRTUAL)
        fault.shows_nothing("no one else is held up; the log names the host")
        again = await opened(port)
        assert await is_answered(*again)
        again[1].close()
        fault.recovers("automatic: the client connects again")


async def test_a_client_that_asks_faster_than_it_may_is_slowed_down() -> None:
    clock = VirtualClock(datetime(2027, 6, 21, 9, 40, tzinfo=UTC))
    async with served(Limits(requests_per_s=10.0, burst=5), clock) as (_, registers, port):
        reader, writer = await opened(port)
        writer.write(READ * 20)
        await registers.until_asked(5)
        await asyncio.sleep(0.05)
        assert registers.asked.total() == 5
        for seconds, asked in ((0.1, 6), (0.1, 7), (60.0, 12)):
            clock.advance(timedelta(seconds=seconds))
            await registers.until_asked(asked)
            await asyncio.sleep(0.05)
            assert registers.asked.total() == asked
        await reader.readexactly(12 * REPLY_BYTES)
        writer.close()


async def test_the_longest_idle_client_gives_way_to_a_new_one() -> None:
    async with served(Limits(most=3)) as (server, _, port):
        first, second, third = [await opened(port) for _ in range(3)]
        assert await is_answered(*first)
        assert await is_answered(*third)
        fourth = await opened(port)
        assert await is_answered(*fourth)
        assert await asyncio.wait_for(second[0].read(), 5.0) == b"", "it was quiet for longest"
        for client in (first, third, fourth):
            assert await is_answered(*client)
        assert server.client_count == 3
        for _, writer in (first, second, third, fourth):
            writer.close()


async def test_a_host_with_many_connections_does_not_push_out_another() -> None:
    async with served(Limits(most=4)) as (_, _, port):
        scada = await opened(port)
        crowd = [await opened(port, "127.0.0.2") for _ in range(20)]
        assert await is_answered(*scada)
        for _, writer in (scada, *crowd):
            writer.close()


@pytest.mark.parametrize("sent", [b"", READ[:4], READ[:9]], ids=["nothing", "half a header", "half a body"])
async def test_a_client_that_says_nothing_more_is_closed(sent: bytes) -> None:
    async with served(Limits(idle_s=0.1, rest_s=0.1)) as (server, _, port):
        reader, writer = await opened(port)
        writer.write(sent)
        assert await asyncio.wait_for(reader.read(), 5.0) == b""
        writer.close()
        await eventually(lambda: not server.client_count)


async def test_a_client_that_vanished_is_looked_for_by_the_system() -> None:
    async with served(Limits()) as (server, _, port):
        reader, writer = await opened(port)
        assert await is_answered(reader, writer)
        connection = next(iter(server._clients._quiet.values())).writer.get_extra_info("socket")
        assert connection.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
        options = (socket.TCP_KEEPIDLE, socket.TCP_KEEPINTVL, socket.TCP_KEEPCNT)
        idle_s, interval_s, count = (connection.getsockopt(socket.IPPROTO_TCP, one) for one in options)
        assert idle_s + interval_s * count <= 60
        writer.close()


async def test_a_master_that_floods_a_serial_line_and_reads_nothing_changes_nothing(tmp_path: Path) -> None:
    clock = VirtualClock(datetime(2027, 6, 21, 9, 40, tzinfo=UTC))
    name, registers = tmp_path / "line", Registers()
    master = PtyLine(name)
    await master.open(lambda _: None, lambda: None)
    line = SerialLine(SerialConfig(str(name), 115_200, Parity.NONE))
    budget = Budget(clock, per_s=10.0, burst=5)
    server = RtuServer({1: registers}, line, budget=budget)
    await server.start()
    try:
        for _ in range(200):
            with suppress(BlockingIOError):
                master.write(READ_RTU * 64)
            await asyncio.sleep(0)
        await registers.until_asked(5)
        await asyncio.sleep(0.05)
        assert registers.asked.total() == 5
        clock.advance(timedelta(seconds=0.1))
        await registers.until_asked(6)
        await asyncio.sleep(0.05)
        assert registers.asked.total() == 6
    finally:
        await server.close()
        master.close()


async def test_a_client_that_is_accepted_while_the_server_closes_is_cut_off() -> None:
    here, there = socket.socketpair()
    _, writer = await asyncio.open_connection(sock=here)
    async with served(Limits()) as (server, _, _):
        pass
    server._clients.admit(asyncio.StreamReader(), writer)
    assert await asyncio.to_thread(there.recv, 1) == b""
    assert server.client_count == 0
    there.close()
