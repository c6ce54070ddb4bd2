"""The machine's end of the link: each order in its own task, updates pushed, every queue bounded."""

import asyncio
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Protocol, assert_never

import structlog

from app.budget import Budget
from app.clock import Clock, SystemClock, give_way
from app.link.codec import (
    Ask,
    Detailed,
    Done,
    Execute,
    FrameBroken,
    Look,
    Measured,
    Pong,
    Problem,
    ProblemKind,
    Refused,
    Request,
    Seen,
    Telling,
    Watch,
    decode_request,
    encode_telling,
    ends_motion,
    let_go,
    problem_of,
    read_body,
    told,
)
from app.link.messages import Machine, Order, Update
from app.link.metrics import MachineMetrics
from app.link.outlet import Listener

MOST_REQUESTS = 256
MOST_UNSENT_BYTES = 64 * 1024 * 1024
REQUESTS_PER_S, MOST_AT_ONCE = 1000.0, 500
"""What one conversation may ask, stops aside: twenty held keys are 400 requests a second."""
TAKE_WITHIN_S = 5.0
LATE = Problem(
    ProblemKind.FAILED, "The controller service got this too late and did not carry it out. Try again."
)
BUSY = Problem(
    ProblemKind.FAILED, "The controller service has too many requests at once; this one was not carried out."
)

log = structlog.get_logger(__name__)


class MeteredMachine(Machine, Protocol):
    """A machine that also counts, and tells who listens what changed."""

    def listen(self) -> Listener:
        """Return a new subscriber of its updates."""

    async def watch(self, tracker_ids: frozenset[str], who: object = None) -> None:
        """Have snapshots of these trackers told with their actions, as long as one who watches them does."""

    async def metrics(self) -> MachineMetrics:
        """Return the counters."""


class LinkServer:
    """Serves one machine on a Unix stream socket that only its owner can open."""

    def __init__(
        self,
        machine: MeteredMachine,
        path: Path,
        clock: Clock | None = None,
        *,
        take_within_s: float = TAKE_WITHIN_S,
    ) -> None:
        self._machine = machine
        self._path = path
        self._clock = clock or SystemClock()
        self._take_within_s = take_within_s
        self._server: asyncio.Server | None = None
        self._conversations: set[asyncio.Task[None]] = set()
        self._encoded: tuple[Update, bytes] | None = None

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
            budget = Budget(self._clock, per_s=REQUESTS_PER_S, burst=MOST_AT_ONCE)
            conversation = _Conversation(
                self._machine, writer, lambda: self.client_count, budget, self._take_within_s, self._encode
            )
            await conversation.run(reader)
        except (EOFError, OSError):
            log.info("link_client_left")
        except FrameBroken as error:
            log.warning("link_client_dropped", reason=str(error))
        finally:
            await let_go(writer)

    def _encode(self, update: Update) -> bytes:
        """Return the frame of an update, made once for all who are told the same."""
        if self._encoded is None or self._encoded[0] is not update:
            self._encoded = update, encode_telling(told(update))
        return self._encoded[1]

    @property
    def client_count(self) -> int:
        """Return how many panels are connected."""
        return len(self._conversations)


class _Conversation:
    """One panel that is connected."""

    def __init__(
        self,
        machine: MeteredMachine,
        writer: asyncio.StreamWriter,
        client_count: Callable[[], int],
        budget: Budget,
        take_within_s: float,
        encode: Callable[[Update], bytes],
    ) -> None:
        self._machine = machine
        self._reader = machine.listen()
        self._encode = encode
        self._writer = writer
        self._client_count = client_count
        self._budget = budget
        self._take_within_s = take_within_s
        self._tasks: set[asyncio.Task[None]] = set()

    async def run(self, reader: asyncio.StreamReader) -> None:
        """Answer and tell until the client leaves; an order that was begun is carried to its end."""
        telling = asyncio.create_task(self._tell())
        telling.add_done_callback(lambda _: self._writer.close())
        try:
            while True:
                request = decode_request(await read_body(reader))
                if self._has_room(request):
                    task = asyncio.create_task(self._answer(request))
                    self._tasks.add(task)
                    task.add_done_callback(self._tasks.discard)
                else:
                    self._send(Refused(request.number, BUSY))
                await give_way()
        finally:
            telling.cancel()
            await asyncio.gather(telling, *self._tasks, return_exceptions=True)
            self._reader.close()
            await self._machine.watch(frozenset(), self)

    def _has_room(self, request: Request) -> bool:
        """Return whether a request may be begun: not too many at once or in a second; a stop always."""
        return ends_motion(request) or (len(self._tasks) < MOST_REQUESTS and self._budget.spend())

    async def _tell(self) -> None:
        while (update := await self._reader.next()) is not None:
            self._put(self._encode(update))
            try:
                async with asyncio.timeout(self._take_within_s):
                    await self._writer.drain()
            except TimeoutError:
                self._drop()
                return

    async def _answer(self, request: Request) -> None:
        try:
            answer = await self._carry_out(request)
        except Exception as error:
            problem = problem_of(error)
            if problem.kind is ProblemKind.FAILED:
                log.exception("order_failed", request=request.do)
            answer = Refused(request.number, problem)
        self._tell_what_waits()
        self._send(answer)

    def _tell_what_waits(self) -> None:
        """Tell what an order changed before it is answered, so that whoever gave it sees its effect."""
        while (update := self._reader.take()) is not None:
            self._put(self._encode(update))

    async def _carry_out(self, request: Request) -> Telling:
        match request:
            case Execute():
                at_s = asyncio.get_running_loop().time()
                if at_s > request.good_until_s and not ends_motion(request):
                    return Refused(request.number, LATE)
                return await self._execute(request.number, request.order(at_s))
            case Look():
                return Seen(request.number, await self._machine.tracker(request.tracker_id))
            case Watch():
                await self._machine.watch(request.tracker_ids, self)
                return Pong(request.number)
            case Ask():
                return await self._reply(request)
            case _:
                assert_never(request)

    async def _reply(self, asked: Ask) -> Telling:
        match asked.do:
            case "detail":
                return Detailed(asked.number, await self._machine.detail())
            case "metrics":
                metrics = await self._machine.metrics()
                return Measured(asked.number, replace(metrics, link_clients=self._client_count()))
            case "again":
                self._reader.again()
                return Pong(asked.number)
            case "ping":
                return Pong(asked.number)
            case _:
                assert_never(asked.do)

    async def _execute(self, number: int, order: Order) -> Done:
        site = await self._machine.execute(order)
        if site is self._machine.latest():
            return Done(number, None)
        about = order.tracker_id or getattr(order.command, "tracker_id", None)
        return Done(number, next((one for one in site.trackers if one.tracker_id == about), None))

    def _send(self, telling: Telling) -> None:
        self._put(encode_telling(telling))

    def _put(self, frame: bytes) -> None:
        if self._writer.transport.get_write_buffer_size() > MOST_UNSENT_BYTES:
            self._drop()
        elif not self._writer.is_closing():
            self._writer.write(frame)

    def _drop(self) -> None:
        """Cut off a client that does not take what it is told."""
        log.warning("link_client_too_slow")
        self._writer.transport.abort()
