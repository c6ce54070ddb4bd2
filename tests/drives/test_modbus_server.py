"""The Modbus server of the simulated drive, asked by pymodbus and by hand."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from struct import pack, unpack_from

import pytest
from pymodbus.client import AsyncModbusTcpClient

from app.base.clock import VirtualClock
from app.drives.profile import load_profile
from app.simulation.faults import Fault, FaultKind
from app.simulation.servers.sim_server import serve
from app.simulation.sim_training import FIRST
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import Axis
from app.tracker.values.motion import DriveCommand, Velocity
from tests.drives.rigs import CONFIG, START


@asynccontextmanager
async def served() -> AsyncIterator[tuple[SimulatedDrive, int]]:
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock)
    server, port = await serve("127.0.0.1", 0, load_profile("simulated-plc"), machine, clock, unit=17)
    try:
        yield machine, port
    finally:
        await server.close()


@asynccontextmanager
async def asking() -> AsyncIterator[tuple[AsyncModbusTcpClient, SimulatedDrive]]:
    async with served() as (machine, port):
        client = AsyncModbusTcpClient("127.0.0.1", port=port, timeout=0.3, retries=0, reconnect_delay=0)
        await client.connect()
        try:
            yield client, machine
        finally:
            client.close()
            await asyncio.sleep(0)


@asynccontextmanager
async def by_hand() -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter, SimulatedDrive]]:
    async with served() as (machine, port):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        try:
            yield reader, writer, machine
        finally:
            writer.close()
            await asyncio.sleep(0)


def frame(transaction: int, body: bytes, unit: int = 17) -> bytes:
    return pack(">HHHB", transaction, 0, len(body) + 1, unit) + body


async def reply_to(reader: asyncio.StreamReader) -> tuple[int, int, bytes]:
    header = await asyncio.wait_for(reader.readexactly(7), 1.0)
    transaction, _, length, unit = unpack_from(">HHHB", header)
    return transaction, unit, await reader.readexactly(length - 1)


async def test_registers_are_read_by_both_functions() -> None:
    async with asking() as (client, _):
        holding = await client.read_holding_registers(0, count=40, device_id=17)
        inputs = await client.read_input_registers(0, count=2, device_id=17)
        assert holding.registers[:2] == inputs.registers == [0x4850, 1]
        assert holding.registers[8:12] == [1, 36864, 0, 36600]
        assert holding.registers[17] == 500
        words = (await client.read_holding_registers(FIRST, count=8, device_id=17)).registers
        assert words[4:] == [0, 12400, 0, 6600], "where the panel really points"


async def test_bits_are_read_by_both_functions() -> None:
    async with asking() as (client, machine):
        machine.obey(DriveCommand(azimuth=Velocity(1.0)))
        machine.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.ELEVATION))
        bits = (await client.read_discrete_inputs(0, count=32, device_id=17)).bits
        assert [place for place, bit in enumerate(bits) if bit] == [0, 16 + 4]
        assert not any((await client.read_coils(0, count=1, device_id=17)).bits)


async def test_the_stop_coil_stops_by_both_functions() -> None:
    async with asking() as (client, machine):
        for write in (client.write_coil(0, True, device_id=17), client.write_coils(0, [True], device_id=17)):
            machine.obey(DriveCommand(azimuth=Velocity(1.0)))
            assert not (await write).isError()
            assert machine.command == DriveCommand()


async def test_registers_are_written_by_all_three_functions() -> None:
    async with asking() as (client, machine):
        await client.write_register(21, 1, device_id=17)
        await client.write_registers(22, [0, 1500], device_id=17)
        assert machine.command.azimuth == Velocity(1.5)
        found = await client.readwrite_registers(
            read_address=20, read_count=4, write_address=22, values=[0, 700], device_id=17
        )
        assert machine.command.azimuth == Velocity(0.7)
        assert found.registers == [0, 1, 0, 700], "the write comes before the read"


REFUSED = {
    "an address behind the map": (pack(">BHH", 3, 56, 1), 2),
    "a span over a gap": (pack(">BHH", 3, 38, 14), 2),
    "a span over the last address": (pack(">BHH", 3, 0xFFFF, 2), 2),
    "input registers without a map": (pack(">BHH", 4, 700, 1), 2),
    "a coil that is not there": (pack(">BHH", 1, 1, 1), 2),
    "a discrete input that is not there": (pack(">BHH", 2, 30, 3), 2),
    "writing what can only be read": (pack(">BHH", 6, 8, 1), 2),
    "writing over the end": (pack(">BHHBHH", 16, 33, 2, 4, 1, 1), 2),
    "writing a coil that is not there": (pack(">BHH", 5, 3, 0xFF00), 2),
    "no registers": (pack(">BHH", 3, 0, 0), 3),
    "too many registers": (pack(">BHH", 3, 0, 126), 3),
    "half a coil": (pack(">BHH", 5, 0, 0x1234), 3),
    "a byte count that does not fit": (pack(">BHHBH", 16, 20, 1, 4, 1), 3),
    "a short request": (pack(">BH", 3, 0), 3),
    "a long request": (pack(">BHHB", 6, 20, 1, 0), 3),
    "a motion that does not exist": (pack(">BHH", 6, 21, 7), 3),
    "a day that does not exist": (pack(">BHHB6H", 16, 50, 6, 12, 2026, 2, 30, 0, 0, 0), 3),
    "a fault that does not exist": (pack(">BHHB4H", 16, FIRST, 4, 8, 99, 0, 0, 0), 3),
    "a function that does not exist": (bytes((43, 14, 1, 0)), 1),
}


async def test_what_cannot_be_done_is_answered_with_its_exception() -> None:
    async with by_hand() as (reader, writer, machine):
        for name, (request, code) in REFUSED.items():
            writer.write(frame(7, request))
            assert await reply_to(reader) == (7, 17, bytes((request[0] | 0x80, code))), name
            assert machine.command == DriveCommand(), "a refused write changes nothing"


async def test_pipelined_requests_are_answered_in_their_order() -> None:
    async with by_hand() as (reader, writer, _):
        writer.write(b"".join(frame(number, pack(">BHH", 3, number % 20, 1)) for number in range(50)))
        assert [(await reply_to(reader))[0] for _ in range(50)] == list(range(50))


async def test_a_request_in_pieces_is_put_together() -> None:
    async with by_hand() as (reader, writer, _):
        for byte in frame(1, pack(">BHH", 3, 0, 1)):
            writer.write(bytes((byte,)))
            await writer.drain()
        assert (await reply_to(reader))[2] == b"\x03\x02\x48\x50"
        writer.write(frame(1, pack(">BHH", 3, 0, 1), unit=18) + frame(2, pack(">BHH", 3, 0, 1)))
        assert (await reply_to(reader))[:2] == (2, 17), "another unit is not answered"


@pytest.mark.parametrize(
    "noise", [b"GET / HTTP/1.1\r\n", pack(">HHHB", 1, 0, 300, 17), pack(">HHHB", 1, 0, 1, 17)]
)
async def test_what_is_not_modbus_ends_the_connection(noise: bytes) -> None:
    async with by_hand() as (reader, writer, _):
        writer.write(noise)
        assert await asyncio.wait_for(reader.read(), 1.0) == b""
