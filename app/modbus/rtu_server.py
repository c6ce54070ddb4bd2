"""A small Modbus RTU server: one device or several on one line, requests answered in their order."""

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from datetime import timedelta
from struct import pack

from app.base.budget import Budget
from app.base.clock import Clock, give_way
from app.base.message import N_, say
from app.modbus.line import Line
from app.modbus.rtu_frame import LONGEST, is_sealed, request_length, sealed
from app.modbus.server import Device, Respond, answer

FORGET_AFTER_S = 0.02
TRY_AGAIN = timedelta(seconds=0.5)
MOST_WAITING = 16
MASTER = N_("the serial line")


class RtuServer:
    """Answers for the unit ids of its devices; everything else on the line is left alone, broadcasts too.

    `respond` answers in the devices' place where an answer takes time. `budget` sets the master's pace; of
    what comes faster a few requests wait, and the rest is lost as on a line that is too slow.
    """

    def __init__(
        self,
        devices: Mapping[int, Device],
        line: Line,
        *,
        respond: Respond | None = None,
        budget: Budget | None = None,
    ) -> None:
        self._devices = devices
        self._line = line
        self._respond = respond
        self._budget = budget
        self._buffer = bytearray()
        self._requests: asyncio.Queue[bytes] = asyncio.Queue(MOST_WAITING)
        self._forgetting: asyncio.TimerHandle | None = None
        self._serving: asyncio.Task[None] | None = None
        self._lost = asyncio.Event()

    async def start(self) -> None:
        """Open the line and begin to answer, or raise `OSError`."""
        if not await self._line.open(self._received, self._lost.set):
            raise OSError(say("The serial line cannot be opened. {advice}", advice=self._line.advice))
        self._serving = asyncio.create_task(self._serve())

    async def until_lost(self) -> None:
        """Return when the line has vanished."""
        await self._lost.wait()

    async def stay(self, clock: Clock) -> None:
        """Open the line again whenever it has vanished and is back, until cancelled."""
        while True:
            await self._lost.wait()
            await clock.sleep_until(clock.now() + TRY_AGAIN)
            self._lost.clear()
            if not await self._line.open(self._received, self._lost.set):
                self._lost.set()

    async def close(self) -> None:
        """Stop answering and close the line."""
        self._forget()
        self._line.close()
        serving, self._serving = self._serving, None
        if serving is not None:
            serving.cancel()
            await asyncio.gather(serving, return_exceptions=True)

    def _received(self, data: bytes) -> None:
        self._buffer += data
        if self._forgetting is not None:
            self._forgetting.cancel()
            self._forgetting = None
        while not self._requests.full() and (request := self._taken()) is not None:
            self._requests.put_nowait(request)
        if self._requests.full():
            self._buffer.clear()
        if self._buffer:
            self._forgetting = asyncio.get_running_loop().call_later(FORGET_AFTER_S, self._forget)

    def _taken(self) -> bytes | None:
        """Take a whole request with a right checksum off the buffer; the rest goes with the next silence."""
        length = request_length(bytes(self._buffer))
        if length is None or len(self._buffer) < length:
            if len(self._buffer) > LONGEST:
                self._buffer.clear()
            return None
        request = bytes(self._buffer[:length])
        if not is_sealed(request):
            return None
        del self._buffer[:length]
        return request

    def _forget(self) -> None:
        if self._forgetting is not None:
            self._forgetting.cancel()
            self._forgetting = None
        self._buffer.clear()

    async def _serve(self) -> None:
        while True:
            if self._budget is not None:
                await self._budget.wait()
            request = await self._requests.get()
            reply = await self._answer(request)
            if reply is not None and self._line.is_open:
                with suppress(OSError):
                    self._line.write(reply)
            await give_way()

    async def _answer(self, request: bytes) -> bytes | None:
        unit, body = request[0], request[1:-2]
        device = self._devices.get(unit)
        if device is None:
            return None
        done = answer(device, body) if self._respond is None else await self._respond(body, MASTER)
        head = pack(">HHHB", 0, 0, len(done) + 1, unit)
        reply = await device.let_out(head + done)
        return None if reply is None else _as_rtu(reply)


def _as_rtu(reply: bytes) -> bytes:
    """Return a reply in TCP's form as an RTU frame; a wrong transaction number becomes a wrong checksum."""
    frame = sealed(reply[6:])
    return frame if reply[:2] == b"\x00\x00" else frame[:-1] + bytes((frame[-1] ^ 0x01,))
