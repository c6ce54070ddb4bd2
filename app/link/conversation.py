"""One panel at the machine's end of the link: its stream of orders and updates, and its lane for stops."""

import asyncio
from collections.abc import Callable
from dataclasses import replace
from typing import Protocol, assert_never

from app.base.budget import Budget
from app.base.clock import give_way
from app.base.logs import get_logger
from app.base.message import N_
from app.link.codec import (
    Ask,
    Done,
    Execute,
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
    decode_stop,
    encode_telling,
    ends_motion,
    problem_of,
    read_body,
)
from app.link.details import Sent, answer
from app.link.messages import Machine, Order, Update
from app.link.metrics import MachineMetrics
from app.link.outlet import Listener
from app.tracker.state.snapshot import SiteSnapshot

MOST_REQUESTS = 256
MOST_UNSENT_BYTES = 64 * 1024 * 1024
REQUESTS_PER_S, MOST_AT_ONCE = 1000.0, 500
"""What one conversation may ask, stops aside: twenty held keys are 400 requests a second."""
LATE = Problem(
    ProblemKind.FAILED,
    N_("The controller service received this request too late and did not carry it out. Try again."),
)
BUSY = Problem(
    ProblemKind.FAILED,
    N_("The controller service has too many requests at once; this request was not carried out."),
)

log = get_logger()


class MeteredMachine(Machine, Protocol):
    """A machine that also counts, and tells who listens what changed."""

    def listen(self) -> Listener:
        """Return a new subscriber of its updates."""

    async def watch(self, tracker_ids: frozenset[str], who: object = None) -> None:
        """Have snapshots of these trackers told with their actions, as long as one who watches them does."""

    async def metrics(self) -> MachineMetrics:
        """Return the counters."""


class _Stream:
    """What is sent to one panel; it is cut off when it does not take it."""

    def __init__(self, machine: MeteredMachine, writer: asyncio.StreamWriter) -> None:
        self._machine = machine
        self._writer = writer
        self._tasks: set[asyncio.Task[None]] = set()

    def _begin(self, request: Request) -> None:
        task = asyncio.create_task(self._answer(request))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _answer(self, request: Request) -> None:
        try:
            if isinstance(request, Execute):
                at_s = asyncio.get_running_loop().time()
                if at_s > request.good_until_s and not ends_motion(request):
                    answer: Telling = Refused(request.number, LATE)
                else:
                    order = request.order(at_s)
                    answer = self._done(request.number, order, await self._machine.execute(order))
            else:
                answer = await self._reply(request)
        except Exception as error:
            problem = problem_of(error)
            if problem.kind is ProblemKind.FAILED:
                log.exception("order_failed", request=request.do)
            answer = Refused(request.number, problem)
        try:
            self._tell_what_waits()
            self._put(encode_telling(answer))
        except Exception:
            log.exception("link_not_told", request=request.do, action="the panel connects anew")
            self._writer.transport.abort()

    async def _reply(self, request: Ask | Look | Watch) -> Telling:
        raise TypeError(request)

    def _tell_what_waits(self) -> None:
        """Tell what an order changed before it is answered, so that whoever gave it sees its effect."""

    def _done(self, number: int, order: Order, site: SiteSnapshot) -> Done:
        if site is self._machine.latest():
            return Done(number, None, site.sequence)
        about = order.tracker_id or getattr(order.command, "tracker_id", None)
        return Done(number, next((one for one in site.trackers if one.tracker_id == about), None))

    def _put(self, frame: bytes) -> None:
        if self._writer.transport.get_write_buffer_size() > MOST_UNSENT_BYTES:
            self._drop()
        elif not self._writer.is_closing():
            self._writer.write(frame)

    def _drop(self) -> None:
        """Cut off a client that does not take what it is told."""
        log.warning("link_client_too_slow")
        self._writer.transport.abort()


class StopLane(_Stream):
    """A panel's lane for stops: nothing else comes this way, and nothing is told on it but their answers."""

    async def run(self, reader: asyncio.StreamReader) -> None:
        """Carry out stops until the panel leaves; one that was begun is carried to its end."""
        try:
            while True:
                self._begin(decode_stop(await read_body(reader)))
                await give_way()
        finally:
            await asyncio.gather(*self._tasks, return_exceptions=True)


class Conversation(_Stream):
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
        super().__init__(machine, writer)
        self._reader = machine.listen()
        self._encode = encode
        self._client_count = client_count
        self._budget = budget
        self._take_within_s = take_within_s
        self._details, self._detailing = Sent(), asyncio.Lock()

    async def run(self, reader: asyncio.StreamReader) -> None:
        """Answer and tell until the client leaves; an order that was begun is carried to its end."""
        telling = asyncio.create_task(self._keep_telling())
        try:
            while True:
                request = decode_request(await read_body(reader))
                if self._has_room(request):
                    self._begin(request)
                else:
                    self._put(encode_telling(Refused(request.number, BUSY)))
                await give_way()
        finally:
            telling.cancel()
            await asyncio.gather(telling, *self._tasks, return_exceptions=True)
            self._reader.close()
            await self._machine.watch(frozenset(), self)

    def _has_room(self, request: Request) -> bool:
        """Return whether a request may be begun: not too many at once or in a second; a stop always."""
        return ends_motion(request) or (len(self._tasks) < MOST_REQUESTS and self._budget.spend())

    async def _keep_telling(self) -> None:
        """Tell updates; whatever ends it ends the conversation: a panel that hears nothing must know."""
        try:
            await self._tell()
        except OSError:
            pass
        except Exception:
            log.exception("link_not_told", action="the panel connects anew")
        finally:
            self._writer.close()

    async def _tell(self) -> None:
        while (update := await self._reader.next()) is not None:
            self._put(self._encode(update))
            try:
                async with asyncio.timeout(self._take_within_s):
                    await self._writer.drain()
            except TimeoutError:
                self._drop()
                return

    def _tell_what_waits(self) -> None:
        """Tell what an order changed before it is answered, so that whoever gave it sees its effect."""
        while (update := self._reader.take()) is not None:
            self._put(self._encode(update))

    async def _reply(self, request: Ask | Look | Watch) -> Telling:
        match request:
            case Look():
                return Seen(request.number, await self._machine.tracker(request.tracker_id))
            case Watch():
                await self._machine.watch(request.tracker_ids, self)
                return Pong(request.number)
            case Ask():
                return await self._tell_of(request)
            case _:
                assert_never(request)

    async def _tell_of(self, asked: Ask) -> Telling:
        match asked.do:
            case "detail":
                return await self._detail(asked.number)
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

    async def _detail(self, number: int) -> Telling:
        """Tell what has changed and return the answer; one question after the other, and ticks between."""
        async with self._detailing:
            detail = await self._machine.detail()
            for part in self._details.parts(detail):
                self._put(encode_telling(part))
                await give_way()
        return answer(number, detail)
