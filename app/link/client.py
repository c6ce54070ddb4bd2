"""The panel's end of the link: connects again by itself, queues nothing, says at once when it is down."""

import asyncio
import itertools
from collections.abc import AsyncIterator
from contextlib import suppress
from datetime import timedelta
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Self, assert_never

from app.clock import Clock, SystemClock
from app.link.codec import (
    Answer,
    Ask,
    Detailed,
    Done,
    Execute,
    FrameBroken,
    Look,
    Measured,
    Pong,
    Refused,
    Request,
    Seen,
    Telling,
    Told,
    Watch,
    decode_telling,
    encode_request,
    ends_motion,
    let_go,
    read_body,
)
from app.link.lanes import Lanes
from app.link.messages import (
    MachineUnreachable,
    Order,
    SaveRecording,
    SiteCommand,
    SiteDetail,
    StopAll,
    Update,
)
from app.link.metrics import MachineMetrics
from app.link.outlet import Outlet
from app.link.record_orders import AddRecordPhoto, SignRecord
from app.link.whole import Whole, with_tracker
from app.tracker.commands import EndJog, Jog, Stop
from app.tracker.snapshot import SiteSnapshot, Snapshot

RECONNECT_AFTER = timedelta(milliseconds=300)
SILENCE_S = 1.5
ANSWER_S = 1.0
STORED_ANSWER_S = 5.0
LONG_ANSWER_S = 30.0
MOST_WAITING = 256

DOWN = (
    "The controller service does not answer; nothing was done. "
    "Wait until the page shows live values again, or check that the service runs."
)
TOO_LATE = (
    "The controller service did not answer in time; it may or may not have carried this out. "
    "Look at the live values before you try again."
)


class LinkClient:
    """The machine over the wire; `async with LinkClient(path) as machine` connects and lets go."""

    def __init__(self, path: Path, clock: Clock | None = None) -> None:
        self._path = path
        self._clock = clock or SystemClock()
        self._outlet = Outlet()
        self._whole = Whole()
        self._asked_again = False
        self._watched: frozenset[str] = frozenset()
        self._stops: Lanes[SiteSnapshot] = Lanes(self._clock)
        self._numbers = itertools.count(1)
        self._waiting: dict[int, asyncio.Future[Answer]] = {}
        self._writer: asyncio.StreamWriter | None = None
        self._task: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Begin to connect; returns at once, whether the machine is there or not."""
        if self._task is None:
            self._task = asyncio.create_task(self._keep_connected())

    async def close(self) -> None:
        """Let go of the machine; whoever waits is told that it is unreachable."""
        if self._task is not None:
            self._task.cancel()
            with suppress(asyncio.CancelledError):
                await self._task
            self._task = None

    async def __aenter__(self) -> Self:
        await self.start()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order and return the snapshot after it; somebody's stops never pile up."""
        if not isinstance(order.command, Stop | StopAll | EndJog):
            return await self._execute(order)
        alike = (order.command, order.tracker_id, order.actor, order.via, order.address)
        return await self._stops.ask(alike, partial(self._execute, order))

    async def _execute(self, order: Order) -> SiteSnapshot:
        patience_s = _patience_s(order)
        good_for_s = order.command.lease.total_seconds() if isinstance(order.command, Jog) else patience_s
        request = Execute(
            next(self._numbers),
            order.command,
            order.actor,
            order.tracker_id,
            order.key,
            order.issued_at,
            asyncio.get_running_loop().time() + good_for_s,
            order.via,
            order.address,
            order.epoch,
            order.rank,
        )
        answer = await self._ask(request, patience_s)
        if not isinstance(answer, Done):
            raise _out_of_place(answer)
        site = self._whole.snapshot
        if site is None:
            raise MachineUnreachable(TOO_LATE)
        return site if answer.tracker is None else with_tracker(site, answer.tracker)

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now, with what may be asked of it."""
        answer = await self._ask(Look(next(self._numbers), tracker_id), ANSWER_S)
        if not isinstance(answer, Seen):
            raise _out_of_place(answer)
        return answer.tracker

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        """Have snapshots of these trackers told with their actions, also after the link was down."""
        self._watched = tracker_ids
        if self._writer is not None:
            self._writer.write(encode_request(Watch(next(self._numbers), tracker_ids)))

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        answer = await self._ask(Ask(next(self._numbers), "detail"), ANSWER_S)
        if not isinstance(answer, Detailed):
            raise _out_of_place(answer)
        return answer.detail

    async def metrics(self) -> MachineMetrics:
        """Return what the machine counts about itself."""
        answer = await self._ask(Ask(next(self._numbers), "metrics"), ANSWER_S)
        if not isinstance(answer, Measured):
            raise _out_of_place(answer)
        return answer.metrics

    async def ping(self) -> timedelta:
        """Return how long the machine took to answer."""
        begun = self._clock.now()
        await self._ask(Ask(next(self._numbers), "ping"), ANSWER_S)
        return self._clock.now() - begun

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot, None before the first or while the link is down."""
        return self._outlet.latest

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the link goes down."""
        return self._outlet.subscribe()

    async def _ask(self, request: Request, patience_s: float) -> Answer:
        if self._writer is None or self._outlet.latest is None:
            raise MachineUnreachable(DOWN)
        if len(self._waiting) >= MOST_WAITING and not ends_motion(request):
            raise MachineUnreachable(DOWN)
        answered: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._waiting[request.number] = answered
        self._writer.write(encode_request(request))
        try:
            async with asyncio.timeout(patience_s):
                answer = await answered
        except TimeoutError as error:
            raise MachineUnreachable(TOO_LATE) from error
        finally:
            self._waiting.pop(request.number, None)
        if isinstance(answer, Refused):
            raise answer.problem.error()
        return answer

    async def _keep_connected(self) -> None:
        while True:
            try:
                await self._converse()
            except (OSError, EOFError, FrameBroken):
                pass
            finally:
                self._mark_down()
            await self._clock.sleep_until(self._clock.now() + RECONNECT_AFTER)

    async def _converse(self) -> None:
        reader, writer = await asyncio.open_unix_connection(self._path)
        self._writer = writer
        if self._watched:
            await self.watch(self._watched)
        try:
            while True:
                async with asyncio.timeout(SILENCE_S):
                    body = await read_body(reader)
                self._hear(decode_telling(body))
        finally:
            await let_go(writer)

    def _hear(self, telling: Telling) -> None:
        match telling:
            case Told():
                self._take(telling)
            case Done() | Detailed() | Seen() | Measured() | Pong() | Refused():
                answered = self._waiting.get(telling.number)
                if answered is not None and not answered.done():
                    answered.set_result(telling)
            case _:
                assert_never(telling)

    def _take(self, told: Told) -> None:
        """Merge what was told into the whole; after a gap ask for everything once."""
        if told.after is None:
            self._asked_again = False
        elif not self._whole.follows(told) and not self._asked_again and self._writer is not None:
            self._asked_again = True
            self._writer.write(encode_request(Ask(next(self._numbers), "again")))
        taken = self._whole.take(told)
        if taken is not None:
            arrivals = told.tracker_ids is not None
            self._outlet.publish(taken.snapshot, taken.events, taken.changed, arrivals=arrivals)

    def _mark_down(self) -> None:
        self._writer = None
        self._whole, self._asked_again = Whole(), False
        self._outlet.end()
        for answered in self._waiting.values():
            if not answered.done():
                answered.set_exception(MachineUnreachable(TOO_LATE))


def _patience_s(order: Order) -> float:
    """Return how long to wait: what is stored may have to wait for a slow disk."""
    if isinstance(order.command, SaveRecording | AddRecordPhoto | SignRecord):
        return LONG_ANSWER_S
    return STORED_ANSWER_S if isinstance(order.command, SiteCommand) else ANSWER_S


def _out_of_place(answer: Answer) -> MachineUnreachable:
    return MachineUnreachable(
        f"The controller service answered with {answer.tell!r} to another question; update both processes."
    )
