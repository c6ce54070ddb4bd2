"""A small Modbus TCP server: function codes 1 to 6, 15, 16 and 23, requests answered in their order."""

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from struct import error, pack, unpack_from
from typing import Protocol

from app.base.clock import Clock, SystemClock
from app.base.message import say
from app.modbus.clients import Client, Clients, Limits

MOST_BITS, MOST_REGISTERS, MOST_WRITTEN_BITS, MOST_WRITTEN_REGISTERS = 2000, 125, 1968, 123
LONGEST_LENGTH = 260
COIL_ON = 0xFF00


class Refusal(Exception):
    """The request is answered with this Modbus exception code."""

    def __init__(self, code: int) -> None:
        super().__init__(say("Modbus exception {code}", code=code))
        self.code = code


ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3


class Device(Protocol):
    """What stands behind the server. Every call raises `Refusal(ILLEGAL_ADDRESS)` for what is not mapped."""

    def read_bits(self, function: int, address: int, count: int) -> list[bool]:
        """Return coils (function 1) or discrete inputs (2)."""

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        """Return holding (function 3) or input registers (4)."""

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        """Write coils."""

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        """Write holding registers, all or none."""

    async def let_out(self, reply: bytes) -> bytes | None:
        """Return what is sent for a reply; None for silence. A sound device returns the reply as it is."""


Respond = Callable[[bytes, str], Awaitable[bytes]]
"""Returns the reply to one request, function code first; it is told the host that asks, and may take time."""


class ModbusServer:
    """Answers for its devices' unit ids; requests for any other are not answered, as on a bus.

    `others` are further devices by their unit ids, as behind a gateway. `respond` answers in the devices'
    place where an answer takes time. Between two replies everything else in this process has its turn.
    """

    def __init__(
        self,
        device: Device,
        unit: int = 1,
        *,
        others: Mapping[int, Device] | None = None,
        respond: Respond | None = None,
        limits: Limits | None = None,
        clock: Clock | None = None,
    ) -> None:
        self._devices = {**(others or {}), unit: device}
        self._respond = respond
        self._clients = Clients(self._answer_one, limits or Limits(), clock or SystemClock())
        self._server: asyncio.Server | None = None

    @property
    def client_count(self) -> int:
        """Return how many clients are connected."""
        return len(self._clients)

    async def start(self, host: str, port: int) -> int:
        """Listen, and return the port."""
        self._server = await asyncio.start_server(self._clients.admit, host, port)
        return int(self._server.sockets[0].getsockname()[1])

    async def close(self) -> None:
        """Stop listening and close every connection."""
        if self._server is not None:
            self._server.close()
        await self._clients.close()
        if self._server is not None:
            await self._server.wait_closed()

    async def _answer_one(self, client: Client) -> bool:
        """Answer the next request; return False if what came is no Modbus TCP and the line must be cut."""
        transaction, protocol, length, unit = unpack_from(">HHHB", await client.begin(7))
        if protocol != 0 or not 2 <= length <= LONGEST_LENGTH:
            return False
        request = await client.rest(length - 1)
        device = self._devices.get(unit)
        if device is None:
            return True
        body = answer(device, request) if self._respond is None else await self._respond(request, client.host)
        reply = await device.let_out(pack(">HHHB", transaction, 0, len(body) + 1, unit) + body)
        if reply is not None:
            await client.send(reply)
        return True


def answer(device: Device, request: bytes) -> bytes:
    """Return the reply to one request, function code first; an exception reply where it cannot be done."""
    function = request[0]
    try:
        act = ACTIONS.get(function)
        if act is None:
            raise Refusal(ILLEGAL_FUNCTION)
        return bytes((function,)) + act(device, function, request[1:])
    except Refusal as refusal:
        return bytes((function | 0x80, refusal.code))
    except (error, IndexError, ValueError):
        return bytes((function | 0x80, ILLEGAL_VALUE))


def _read_bits(device: Device, function: int, body: bytes) -> bytes:
    address, count = _span(body, MOST_BITS)
    bits = device.read_bits(function, address, count)
    packed = bytes(
        sum(1 << place for place, bit in enumerate(bits[start : start + 8]) if bit)
        for start in range(0, count, 8)
    )
    return bytes((len(packed),)) + packed


def _read_registers(device: Device, function: int, body: bytes) -> bytes:
    address, count = _span(body, MOST_REGISTERS)
    return pack(f">B{count}H", 2 * count, *device.read_registers(function, address, count))


def _write_bit(device: Device, function: int, body: bytes) -> bytes:
    address, value = unpack_from(">HH", body)
    if value not in (0, COIL_ON) or len(body) != 4:
        raise Refusal(ILLEGAL_VALUE)
    device.write_bits(address, [value == COIL_ON])
    return body


def _write_register(device: Device, function: int, body: bytes) -> bytes:
    address, value = unpack_from(">HH", body)
    if len(body) != 4:
        raise Refusal(ILLEGAL_VALUE)
    device.write_registers(address, [value])
    return body


def _write_bits(device: Device, function: int, body: bytes) -> bytes:
    address, count = _span(body, MOST_WRITTEN_BITS)
    values = body[5:]
    if body[4] != len(values) or len(values) != (count + 7) // 8:
        raise Refusal(ILLEGAL_VALUE)
    device.write_bits(address, [bool(values[place // 8] >> place % 8 & 1) for place in range(count)])
    return body[:4]


def _write_registers(device: Device, function: int, body: bytes) -> bytes:
    address, count = _span(body, MOST_WRITTEN_REGISTERS)
    device.write_registers(address, _words(body[4:], count))
    return body[:4]


def _read_write_registers(device: Device, function: int, body: bytes) -> bytes:
    address, count = _span(body[4:], MOST_WRITTEN_REGISTERS)
    device.write_registers(address, _words(body[8:], count))
    return _read_registers(device, 3, body[:4])


def _span(body: bytes, most: int) -> tuple[int, int]:
    address, count = unpack_from(">HH", body)
    if not 1 <= count <= most:
        raise Refusal(ILLEGAL_VALUE)
    if address + count > 0x10000:
        raise Refusal(ILLEGAL_ADDRESS)
    return address, count


def _words(body: bytes, count: int) -> list[int]:
    """Return the words behind a byte count that must fit."""
    if body[0] != 2 * count or len(body) != 1 + 2 * count:
        raise Refusal(ILLEGAL_VALUE)
    return list(unpack_from(f">{count}H", body, 1))


ACTIONS = {
    1: _read_bits,
    2: _read_bits,
    3: _read_registers,
    4: _read_registers,
    5: _write_bit,
    6: _write_register,
    15: _write_bits,
    16: _write_registers,
    23: _read_write_registers,
}
