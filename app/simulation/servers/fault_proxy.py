"""A proxy between master and device that makes things go wrong on purpose, over TCP and serial lines."""

import asyncio
import signal
import sys
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import replace
from datetime import timedelta
from threading import Thread

from app.base.clock import Clock, SystemClock
from app.base.message import N_, say
from app.modbus.line import Line, SerialLine, TcpLine
from app.modbus.listening_line import ListeningLine
from app.modbus.pty_line import serial_end
from app.modbus.rtu_frame import reply_length, request_length
from app.modbus.wire_faults import (
    LATE_MS,
    MEANINGS,
    TCP_HEAD,
    Framing,
    Script,
    Step,
    WireFault,
    parse_script,
    spoiled,
)
from app.simulation.servers.sim_server import parse_address
from app.tracker.settings.config import SerialConfig

SOUND = Step(WireFault.CLEAR)
MOST_PENDING = 64
FORGET_AFTER_S = 0.05
TRY_AGAIN = timedelta(seconds=0.5)

Length = Callable[[bytes], int | None]


class FaultProxy:
    """Passes requests from `near`, the master's side, to `far`, the device's, and replies back.

    The script says with every request what happens to it. `requests` counts them. A side that vanishes is
    opened again when it is back.
    """

    def __init__(
        self, near: Line, far: Line, framing: Framing, clock: Clock, script: Script | None = None
    ) -> None:
        self.requests = 0
        self._near = near
        self._far = far
        self._framing = framing
        self._clock = clock
        self._script = script or Script()
        self._asked, self._answered = bytearray(), bytearray()
        self._pending: dict[bytes, Step] = {}
        self._held = b""
        self._turn = 0
        self._asked_at_s = self._answered_at_s = self._free_at_s = 0.0
        self._reaching = False
        self._tasks: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Open both sides, or raise `OSError`; a device that is not there yet is looked for again."""
        if not await self._near.open(self._from_master, self._near_lost):
            raise OSError(say("The proxy cannot listen. {advice}", advice=self._near.advice))
        await self._far.open(self._from_device, _nothing)

    def play(self, text: str) -> None:
        """Play another script from now on, or raise `ValueError`."""
        self._script = parse_script(text, self._framing)

    async def close(self) -> None:
        """Close both sides."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._near.close()
        self._far.close()

    def _from_master(self, data: bytes) -> None:
        now_s = asyncio.get_running_loop().time()
        if now_s - self._asked_at_s > FORGET_AFTER_S:
            self._asked.clear()
        self._asked_at_s = now_s
        self._asked += data
        length = _tcp_length if self._framing is Framing.TCP else request_length
        for request in _frames(self._asked, length):
            self.requests += 1
            step = self._script.next()
            if step.fault is WireFault.BLACK_HOLE:
                continue
            while len(self._pending) >= MOST_PENDING:
                self._pending.pop(next(iter(self._pending)))
            self._pending[self._key(request)] = step
            if self._far.is_open:
                self._ask(request)
            elif not self._reaching:
                self._reaching = True
                self._spawn(self._reach(request))

    def _from_device(self, data: bytes) -> None:
        now_s = asyncio.get_running_loop().time()
        if now_s - self._answered_at_s > FORGET_AFTER_S:
            self._answered.clear()
        self._answered_at_s = now_s
        self._answered += data
        length = _tcp_length if self._framing is Framing.TCP else reply_length
        for reply in _frames(self._answered, length):
            self._answer(reply, self._pending.pop(self._key(reply), SOUND))

    def _answer(self, reply: bytes, step: Step) -> None:
        """Let a reply go to the master as the step says."""
        self._turn += 1
        match step.fault:
            case WireFault.DROP:
                return
            case WireFault.MERGE:
                self._held += reply
            case WireFault.RESET | WireFault.CLOSE:
                if isinstance(self._near, ListeningLine):
                    self._near.cut(reset=step.fault is WireFault.RESET)
            case WireFault.DELAY:
                late_s = (LATE_MS if step.amount is None else step.amount) / 1000.0
                self._send(reply, late_s)
            case _:
                self._send(spoiled(reply, step, self._framing, self._turn))

    def _send(self, reply: bytes, late_s: float = 0.0) -> None:
        """Send now or later. RTU replies keep their order, as one device cannot overtake itself."""
        loop = asyncio.get_running_loop()
        due_s = loop.time() + late_s
        if self._framing is Framing.RTU:
            due_s = self._free_at_s = max(self._free_at_s + 1e-6, due_s)
        if due_s <= loop.time():
            self._put(reply)
        else:
            loop.call_at(due_s, self._put, reply)

    def _put(self, reply: bytes) -> None:
        held, self._held = self._held, b""
        if self._near.is_open:
            with suppress(OSError):
                self._near.write(held + reply)

    def _key(self, frame: bytes) -> bytes:
        """Return what a reply has in common with its request: transaction number, or unit with RTU."""
        return frame[:2] if self._framing is Framing.TCP else frame[:1]

    def _ask(self, request: bytes) -> None:
        """Send to the device; a request that a vanished line does not take is lost, as on a real one."""
        with suppress(OSError):
            self._far.write(request)

    async def _reach(self, request: bytes) -> None:
        """Open the device's side and send what was asked; until then other requests are lost."""
        try:
            if await self._far.open(self._from_device, _nothing):
                self._ask(request)
        finally:
            self._reaching = False

    def _near_lost(self) -> None:
        self._spawn(self._come_back())

    async def _come_back(self) -> None:
        """Open the master's side again as soon as it is there."""
        opened = False
        while not opened:
            await self._clock.sleep_until(self._clock.now() + TRY_AGAIN)
            opened = await self._near.open(self._from_master, self._near_lost)

    def _spawn(self, doing: Coroutine[None, None, None]) -> None:
        task = asyncio.create_task(doing)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


def make_proxy(
    near: str, far: str, framing: Framing, script: str, serial: SerialConfig, *, paced: bool
) -> FaultProxy:
    """Return a proxy between two places, each `HOST:PORT` or a serial port; raise `ValueError` if unclear."""
    near_line = (
        ListeningLine(*parse_address(near))
        if _is_address(near)
        else serial_end(replace(serial, port=near), paced=paced)
    )
    far_line = TcpLine(*parse_address(far)) if _is_address(far) else SerialLine(replace(serial, port=far))
    if framing is Framing.TCP and not (_is_address(near) and _is_address(far)):
        raise ValueError(
            N_("Modbus TCP needs HOST:PORT on both sides; on a serial line choose --frames rtu.")
        )
    return FaultProxy(near_line, far_line, framing, SystemClock(), parse_script(script, framing))


def run_fault_proxy(proxy: FaultProxy, where: str) -> None:
    """Run a proxy until SIGTERM or SIGINT; every line on the standard input is a new script."""
    asyncio.run(_run(proxy, where))


async def _run(proxy: FaultProxy, where: str) -> None:
    ended = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, ended.set)
    await proxy.start()
    _say(
        say(
            "Fault proxy {where}. Type a fault and press Enter; type clear to end it, or help "
            "for the list. Press Ctrl-C to exit.",
            where=where,
        )
    )

    def listen() -> None:
        for line in sys.stdin:
            loop.call_soon_threadsafe(_obey, proxy, line.strip())

    Thread(target=listen, name=N_("standard input"), daemon=True).start()
    await ended.wait()
    await proxy.close()


def _obey(proxy: FaultProxy, line: str) -> None:
    if line == "help":
        _say("\n".join(f"{fault:18} {meaning}" for fault, meaning in MEANINGS.items()))
        return
    try:
        proxy.play(line)
    except ValueError as error:
        _say(str(error))
    else:
        _say(say("{value} (after {requests} requests)", value=line or "clear", requests=proxy.requests))


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def _frames(buffer: bytearray, length_of: Length) -> list[bytes]:
    """Take the whole frames off a buffer; what is no frame goes with the next silence of the line."""
    frames = []
    while (length := length_of(bytes(buffer))) is not None and len(buffer) >= length:
        frames.append(bytes(buffer[:length]))
        del buffer[:length]
    return frames


def _tcp_length(begin: bytes) -> int | None:
    return TCP_HEAD + int.from_bytes(begin[4:6], "big") if len(begin) >= TCP_HEAD else None


def _is_address(text: str) -> bool:
    return text.rpartition(":")[2].isdecimal()


def _nothing() -> None:
    """Do nothing when the device's side is lost: it is opened again with the next request."""
