"""The machine's end of the link: each order in its own task, updates pushed, every queue bounded."""

import asyncio
import os
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from pathlib import Path
from typing import Protocol, assert_never

import structlog

from app.link.codec import (
    Ask,
    Detailed,
    Done,
    Execute,
    FrameBroken,
    Measured,
    Pong,
    Problem,
    ProblemKind,
    Refused,
    Request,
    Telling,
    Told,
    decode_request,
    encode_telling,
    ends_motion,
    let_go,
    problem_of,
    read_body,
)
from app.link.messages import Machine, Update
from app.link.metrics import MachineMetrics
from app.tracker.snapshot import SiteSnapshot

MOST_REQUESTS = 256
MOST_UNSENT_BYTES = 64 * 1024 * 1024
LATE = Problem(
    ProblemKind.FAILED, "The controller service got this too late and did not carry it out. Try again."
)
BUSY = Problem(
    ProblemKind.FAILED, "The controller service has too many requests at once; this one was not carried out."
)

log = structlog.get_logger(__name__)


class MeteredMachine(Machine, Protocol):
    """A machine that also counts."""

    async def metrics(self) -> MachineMetrics:
        """Return the counters."""


class LinkServer:
    """Serves one machine on a Unix stream socket that only its owner can open."""

    def __init__(self, machine: MeteredMachine, path: Path) -> None:
        self._machine = machine
        self._path = path
        self._server: asyncio.Server | None = None
        self._conversations: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Listen; a socket file left by a crash is replaced."""
        self._path.unlink(missing_ok=True)
        before = os.umask(0o177)
        try:
            self._server = await asyncio.start_unix_server(self._accept, self._path)
        finally:
            os.umask(before)

    async def close(self) -> None:
        """Stop listening and end every conversation."""
        if self._server is not None:
            self._server.close()
        for task in tuple(self._conversations):
            task.cancel()
        await asyncio.gather(*self._conversations, return_exceptions=True)
        self._path.unlink(missing_ok=True)

    def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.create_task(self._converse(reader, writer))
        self._conversations.add(task)
        task.add_done_callback(self._conversations.discard)

    async def _converse(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            await _Conversation(self._machine, writer, self._client_count).run(reader)
        except (EOFError, OSError):
            log.info("link_client_left")
        except FrameBroken as error:
            log.warning("link_client_dropped", reason=str(error))
        finally:
            await let_go(writer)

    def _client_count(self) -> int:
        return len(self._conversations)


class _Conversation:
    """One panel that is connected."""

    def __init__(
        self, machine: MeteredMachine, writer: asyncio.StreamWriter, client_count: Callable[[], int]
    ) -> None:
        self._machine = machine
        self._writer = writer
        self._client_count = client_count
        self._tasks: set[asyncio.Task[None]] = set()
        self._told: SiteSnapshot | None = None

    async def run(self, reader: asyncio.StreamReader) -> None:
        """Answer and tell until the client leaves; an order that was begun is carried to its end."""
        telling = asyncio.create_task(self._tell(self._machine.updates()))
        telling.add_done_callback(lambda _: self._writer.close())
        try:
            while True:
                request = decode_request(await read_body(reader))
                if len(self._tasks) >= MOST_REQUESTS and not ends_motion(request):
                    self._send(Refused(request.number, BUSY))
                    continue
                task = asyncio.create_task(self._answer(request))
                self._tasks.add(task)
                task.add_done_callback(self._tasks.discard)
        finally:
            telling.cancel()
            await asyncio.gather(telling, *self._tasks, return_exceptions=True)

    async def _tell(self, updates: AsyncIterator[Update]) -> None:
        async for update in updates:
            self._send(Told(update))
            self._told = update.snapshot
            await self._writer.drain()

    async def _answer(self, request: Request) -> None:
        try:
            answer = await self._carry_out(request)
        except Exception as error:
            problem = problem_of(error)
            if problem.kind is ProblemKind.FAILED:
                log.exception("order_failed", request=request.do)
            answer = Refused(request.number, problem)
        self._send(answer)

    async def _carry_out(self, request: Request) -> Telling:
        match request:
            case Execute():
                at_s = asyncio.get_running_loop().time()
                if at_s > request.good_until_s and not ends_motion(request):
                    return Refused(request.number, LATE)
                snapshot = await self._machine.execute(request.order(at_s))
                return Done(request.number, None if snapshot is self._told else snapshot)
            case Ask(do="detail"):
                return Detailed(request.number, await self._machine.detail())
            case Ask(do="metrics"):
                metrics = await self._machine.metrics()
                return Measured(request.number, replace(metrics, link_clients=self._client_count()))
            case Ask():
                return Pong(request.number)
            case _:
                assert_never(request)

    def _send(self, telling: Telling) -> None:
        if self._writer.transport.get_write_buffer_size() > MOST_UNSENT_BYTES:
            log.warning("link_client_too_slow")
            self._writer.transport.abort()
        elif not self._writer.is_closing():
            self._writer.write(encode_telling(telling))
