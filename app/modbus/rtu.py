"""The wire of a Modbus RTU bus: silence between frames, and no reply taken for another request's.

RTU has no transaction number. After a reply that was lost or damaged its request may still be answered, so
the line is kept silent first, and then a device must answer a question that no late reply can fit: a read of
another length. Devices answer in order, so whatever comes after that answer belongs to what was asked after.
"""

import asyncio
from contextlib import suppress
from struct import unpack_from

from app.base.message import N_, NOTHING, Message
from app.modbus.line import Line
from app.modbus.reply import EXCEPTION_BIT, BadReply
from app.modbus.rtu_frame import CRC_BYTES, is_whole, request_frame, sealed
from app.modbus.wire import Ask, Broken, GivenUp, Refused, Timing, Unanswered

SILENT_CHARACTERS = 3.5
SHORTEST_SILENCE_S, GATEWAY_SILENCE_S = 0.00175, 0.0005
WARY_SILENCE_S = 0.025
"""After damage a shorter silence proves nothing: USB adapters hand bytes over every 16 ms by default."""
WARY_FOR_S = 1.0
"""So long after the last damage every device is asked warily; later only those with a reply still to come."""
BROKEN_OFF_S = 0.1
TURNAROUND_S = 0.03
NEVER_SILENT_S, STOP_SPEAKS_AFTER_S = 0.1, 0.02
MOST_PROBES = 16


class RtuWire:
    """A line with devices that take turns. Requests in flight are never cancelled, only given up by time.

    A gateway that did not answer is connected to anew, as nothing else shows that a connection is dead.
    """

    def __init__(self, line: Line) -> None:
        self._line = line
        self._character_s = line.character_s
        self._is_gateway = line.character_s == 0.0
        shortest_s = GATEWAY_SILENCE_S if self._is_gateway else SHORTEST_SILENCE_S
        self._silence_s = max(SILENT_CHARACTERS * line.character_s, shortest_s)
        self._buffer = bytearray()
        self._flying: Ask | None = None
        self._echo: bytes | None = None
        self._reply: asyncio.Future[bytes] | None = None
        self._waking: asyncio.Future[None] | None = None
        self._ending: asyncio.TimerHandle | None = None
        self._hurrying: asyncio.TimerHandle | None = None
        self._heard_at_s = self._sent_at_s = self._quiet_until_s = self._wary_until_s = 0.0
        self._rest_s = 0.0
        self._urgent = self._hurried = False
        self._last: Ask | None = None
        self._unsettled: dict[int, set[int]] = {}
        self._readable: dict[int, tuple[int, int]] = {}
        self._lost: dict[int, int] = {}
        self._lives = 0

    @property
    def connected(self) -> bool:
        """Return whether the line is open."""
        return self._line.is_open

    @property
    def advice(self) -> str:
        """Return what to check when there is no connection."""
        return self._line.advice

    def epoch(self, unit: int) -> int:
        """Return a number that grows with every life of the line and every lost reply of this device."""
        return self._lives + self._lost.get(unit, 0)

    async def connect(self) -> bool:
        """Open the line, and return whether that worked."""
        opened = await self._line.open(self._received, self._on_lost)
        if opened:
            self._lives += 1
            self._heard_at_s = asyncio.get_running_loop().time()
        return opened

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        """Return the registers of the reply; raise `Broken`, `Unanswered` or `Refused`."""
        self._urgent, self._hurried = urgent, False
        await self._silence(ask.unit, urgent=urgent)
        if ask.unit in self._unsettled and not urgent:
            await self._settle(ask, timing)
            if self._hurried:
                raise GivenUp
            await self._silence(ask.unit, urgent=False)
        return await self._send(ask, timing, urgent=urgent)

    def hurry(self) -> None:
        """End the wait for a silence at once, and for a reply if it does not begin soon."""
        self._hurried = True
        if self._waking is not None and not self._waking.done() and not self._urgent:
            self._waking.set_exception(GivenUp())
        elif self._reply is not None and self._hurrying is None:
            self._wait_less()

    def close(self) -> None:
        """Close the line."""
        if self._line.is_open:
            self._lives += 1
            self._line.close()

    async def _send(self, ask: Ask, timing: Timing, *, urgent: bool = False) -> list[int]:
        loop = asyncio.get_running_loop()
        frame = request_frame(ask)
        self._buffer.clear()
        self._flying = self._last = ask
        self._echo = _echo(ask) if urgent else None
        self._reply = loop.create_future()
        self._sent_at_s = loop.time() + len(frame) * self._character_s
        reply_s = (ask.wanted.length + CRC_BYTES) * self._character_s
        self._ending = loop.call_at(self._sent_at_s + timing.timeout_s + reply_s, self._time_out)
        if self._hurried:
            self._wait_less()
        try:
            self._line.write(frame)
            reply = await self._reply
        except (Unanswered, OSError) as missing:
            self._lose(ask)
            self._keep_silent(self._sent_at_s + timing.silence_s)
            if isinstance(missing, OSError):
                self.close()
                raise Broken(N_("the line accepted no request")) from missing
            if self._is_gateway and not isinstance(missing, GivenUp):
                self.close()
            raise
        except BadReply as bad:
            self._lose(ask)
            raise Broken(self._echoed(frame) or str(bad)) from bad
        finally:
            self._flying = self._reply = None
            self._calm()
        self._rest_s = timing.rest_s
        return self._decoded(ask, reply)

    def _decoded(self, ask: Ask, reply: bytes) -> list[int]:
        if reply[1] & EXCEPTION_BIT:
            raise Refused(reply[2])
        if ask.words:
            return []
        self._readable[ask.unit] = ask.address, max(ask.count, self._readable.get(ask.unit, (0, 0))[1])
        return list(unpack_from(f">{ask.count}H", reply, 3))

    async def _settle(self, ask: Ask, timing: Timing) -> None:
        """Have a device answer what no late reply fits, or raise; after that it is in step again."""
        unsettled = self._unsettled[ask.unit]
        address, most = self._readable.get(ask.unit, (ask.address, 0 if ask.words else ask.count))
        counts = [count for count in range(1, min(most, MOST_PROBES) + 1) if count not in unsettled]
        if counts:
            with suppress(Refused):
                await self._send(Ask(ask.unit, address, counts[0]), timing)
                self._unsettled.pop(ask.unit, None)
                return
        await self._silence(ask.unit, urgent=False)
        self._keep_silent(asyncio.get_running_loop().time() + timing.silence_s)
        heard_at_s = self._heard_at_s
        await self._silence(ask.unit, urgent=False)
        if self._heard_at_s != heard_at_s:
            raise Broken(N_("a late reply arrived"))
        self._unsettled.pop(ask.unit, None)

    async def _silence(self, unit: int, *, urgent: bool) -> None:
        """Wait until the line was silent long enough; a stop waits neither for late replies nor for noise."""
        loop = asyncio.get_running_loop()
        begun_s = loop.time()
        while True:
            now_s = loop.time()
            is_wary = unit in self._unsettled or now_s < self._wary_until_s
            wary_s = WARY_SILENCE_S if is_wary and not urgent else 0.0
            spoken_s = max(self._heard_at_s + wary_s, self._sent_at_s)
            due_s = spoken_s + max(self._silence_s, self._rest_s)
            quiet_s = begun_s if urgent else max(begun_s, self._quiet_until_s)
            if now_s >= max(due_s, quiet_s):
                return
            if now_s - quiet_s > (STOP_SPEAKS_AFTER_S if urgent else NEVER_SILENT_S):
                if urgent:
                    return
                raise Broken(N_("the line is never silent: there is noise, or another master"))
            await self._sleep_until(max(due_s, quiet_s))

    async def _sleep_until(self, due_s: float) -> None:
        loop = asyncio.get_running_loop()
        self._waking = loop.create_future()
        timer = loop.call_at(due_s, _wake, self._waking)
        try:
            await self._waking
        finally:
            timer.cancel()
            self._waking = None

    def _received(self, data: bytes) -> None:
        self._heard_at_s = asyncio.get_running_loop().time()
        ask, reply = self._flying, self._reply
        if ask is None or reply is None or reply.done():
            if self._last is not None:
                self._lose(self._last)
            return
        self._buffer += data
        if self._echo is not None and self._echo in self._buffer:
            reply.set_result(self._echo)
            return
        try:
            if is_whole(bytes(self._buffer), ask.wanted):
                reply.set_result(bytes(self._buffer))
                return
        except BadReply as bad:
            if self._echo is None:
                reply.set_exception(bad)
            return
        self._expect_more()

    def _expect_more(self) -> None:
        """End the wait if the rest of a reply that has begun does not come."""
        if self._echo is not None:
            return
        if self._ending is not None:
            self._ending.cancel()
        loop = asyncio.get_running_loop()
        self._ending = loop.call_later(BROKEN_OFF_S + self._silence_s, self._break_off)

    def _break_off(self) -> None:
        self._fail(BadReply(N_("the reply was incomplete")))

    def _time_out(self) -> None:
        self._fail(Unanswered())

    def _wait_less(self) -> None:
        loop = asyncio.get_running_loop()
        self._hurrying = loop.call_at(self._sent_at_s + TURNAROUND_S, self._give_up)

    def _give_up(self) -> None:
        if not self._buffer:
            self._fail(GivenUp())

    def _on_lost(self) -> None:
        self._lives += 1
        self._fail(BadReply(N_("the line was lost")))

    def _fail(self, why: Exception) -> None:
        if self._reply is not None and not self._reply.done():
            self._reply.set_exception(why)

    def _lose(self, ask: Ask) -> None:
        """Note that a request of this device may still be answered."""
        unsettled = self._unsettled.setdefault(ask.unit, set())
        if len(unsettled) >= MOST_PROBES:
            unsettled.clear()
        unsettled.add(0 if ask.words else ask.count)
        self._wary_until_s = asyncio.get_running_loop().time() + WARY_FOR_S
        self._lost[ask.unit] = self._lost.get(ask.unit, 0) + 1

    def _keep_silent(self, until_s: float) -> None:
        self._quiet_until_s = max(self._quiet_until_s, until_s)

    def _echoed(self, frame: bytes) -> Message:
        if self._buffer and frame.startswith(bytes(self._buffer[: len(frame)])):
            return N_("the adapter echoes what it receives: switch its echo off")
        return NOTHING

    def _calm(self) -> None:
        for timer in (self._ending, self._hurrying):
            if timer is not None:
                timer.cancel()
        self._ending = self._hurrying = None


def _echo(ask: Ask) -> bytes | None:
    """Return the whole reply to a write, known beforehand: it is found even behind another's late reply."""
    wanted = ask.wanted
    return sealed(bytes((wanted.unit, wanted.function)) + wanted.begins) if ask.words else None


def _wake(waking: "asyncio.Future[None]") -> None:
    if not waking.done():
        waking.set_result(None)
