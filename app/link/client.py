"""The panel's end of the link: connects again by itself, queues nothing, says at once when it is down."""

import asyncio
import itertools
from collections.abc import AsyncIterator
from contextlib import closing, suppress
from datetime import timedelta
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Self

from app.base.clock import Clock, SystemClock
from app.base.message import say
from app.link.codec import (
    Answer,
    Ask,
    Detailed,
    Details,
    Done,
    Execute,
    Look,
    Measured,
    Request,
    Seen,
    Told,
    Unasked,
    Watch,
    stop_path,
)
from app.link.connection import DOWN, TOO_LATE, Connection, ConnectionEnded
from app.link.details import Received
from app.link.lanes import Lanes
from app.link.messages import (
    MachineUnreachable,
    Order,
    SiteDetail,
    Update,
)
from app.link.metrics import MachineMetrics
from app.link.outlet import Outlet
from app.link.whole import Whole, with_tracker
from app.tracker.commands.commands import Jog
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.tracker.values.order_spec import AT_ONCE_S, STORED_S

SILENCE_S = 1.5
CATCH_UP_S = 0.05
"""So long the answer to a stop waits for the snapshot that shows it, which comes behind everything else."""
MOST_WAITING = 256


class LinkClient:
    """The machine over the wire; `async with LinkClient(path) as machine` connects and lets go."""

    def __init__(self, path: Path, clock: Clock | None = None) -> None:
        self._clock = clock or SystemClock()
        self._main = Connection(
            path, self._clock, hear=self._hear, begin=self._begin, end=self._mark_down, silence_s=SILENCE_S
        )
        self._stop_lane = Connection(stop_path(path), self._clock)
        self._outlet = Outlet()
        self._whole = Whole()
        self._details = Received()
        self._asked_again = False
        self._watched: frozenset[str] = frozenset()
        self._stops: Lanes[SiteSnapshot] = Lanes(self._clock)
        self._numbers = itertools.count(1)

    async def start(self) -> None:
        """Begin to connect; returns at once, whether the machine is there or not."""
        self._main.start()
        self._stop_lane.start()

    async def close(self) -> None:
        """Let go of the machine; whoever waits is told that it is unreachable."""
        await self._main.close()
        await self._stop_lane.close()

    async def __aenter__(self) -> Self:
        await self.start()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order and return the snapshot after it; somebody's stops never pile up."""
        if not order.command.spec.ends_motion:
            return self._after(await self._ask(self._request(order), order.command.spec.within_s))
        alike = (order.command, order.tracker_id, order.actor, order.via, order.address)
        return await self._stops.ask(alike, partial(self._stop, order))

    async def _stop(self, order: Order) -> SiteSnapshot:
        """Send a stop by the lane that nothing else is on, or by the common one while that is down."""
        request, patience_s = self._request(order), order.command.spec.within_s
        if not self._stop_lane.up:
            return self._after(await self._main.ask(request, patience_s))
        try:
            answer = await self._stop_lane.ask(request, patience_s)
        except ConnectionEnded:
            return self._after(await self._main.ask(request, patience_s))
        if isinstance(answer, Done) and answer.sequence is not None:
            await self._catch_up(answer.sequence)
        return self._after(answer)

    async def _catch_up(self, sequence: int) -> None:
        """Return once a snapshot was heard, or when it has been waited for long enough."""
        with suppress(TimeoutError), closing(self._outlet.listen()) as heard:
            async with asyncio.timeout(CATCH_UP_S):
                update = await heard.next()
                while update is not None and update.snapshot.sequence < sequence:
                    update = await heard.next()

    def _request(self, order: Order) -> Execute:
        patience_s = order.command.spec.within_s
        good_for_s = order.command.lease.total_seconds() if isinstance(order.command, Jog) else patience_s
        now_s = asyncio.get_running_loop().time()
        return Execute(
            next(self._numbers),
            order.command,
            order.actor,
            order.tracker_id,
            order.key,
            order.issued_at,
            now_s + good_for_s,
            order.via,
            order.address,
            order.epoch,
            order.rank,
            now_s,
        )

    def _after(self, answer: Answer) -> SiteSnapshot:
        """Return the site as an order left it."""
        if not isinstance(answer, Done):
            raise _out_of_place(answer)
        site = self._whole.snapshot
        if site is None:
            raise MachineUnreachable(TOO_LATE)
        return site if answer.tracker is None else with_tracker(site, answer.tracker)

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now, with what may be asked of it."""
        answer = await self._ask(Look(next(self._numbers), tracker_id), AT_ONCE_S)
        if not isinstance(answer, Seen):
            raise _out_of_place(answer)
        return answer.tracker

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        """Have snapshots of these trackers told with their actions, also after the link was down."""
        self._watched = tracker_ids
        self._main.send(Watch(next(self._numbers), tracker_ids))

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        answer = await self._ask(Ask(next(self._numbers), "detail"), STORED_S)
        if not isinstance(answer, Detailed):
            raise _out_of_place(answer)
        try:
            return self._details.whole(answer)
        except KeyError as error:
            raise MachineUnreachable(TOO_LATE) from error

    async def metrics(self) -> MachineMetrics:
        """Return what the machine counts about itself."""
        answer = await self._ask(Ask(next(self._numbers), "metrics"), AT_ONCE_S)
        if not isinstance(answer, Measured):
            raise _out_of_place(answer)
        return answer.metrics

    async def ping(self) -> timedelta:
        """Return how long the machine took to answer."""
        begun = self._clock.now()
        await self._ask(Ask(next(self._numbers), "ping"), AT_ONCE_S)
        return self._clock.now() - begun

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot, None before the first or while the link is down."""
        return self._outlet.latest

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the link goes down."""
        return self._outlet.subscribe()

    async def _ask(self, request: Request, patience_s: float) -> Answer:
        if self._outlet.latest is None or self._main.waiting >= MOST_WAITING:
            raise MachineUnreachable(DOWN)
        return await self._main.ask(request, patience_s)

    def _begin(self) -> None:
        if self._watched:
            self._main.send(Watch(next(self._numbers), self._watched))

    def _hear(self, told: Unasked) -> None:
        if isinstance(told, Details):
            self._details.take(told)
        else:
            self._take(told)

    def _take(self, told: Told) -> None:
        """Merge what was told into the whole; after a gap ask for everything once."""
        if told.after is None:
            self._asked_again = False
        elif not self._whole.follows(told) and not self._asked_again:
            self._asked_again = True
            self._main.send(Ask(next(self._numbers), "again"))
        taken = self._whole.take(told)
        if taken is not None:
            arrivals = told.tracker_ids is not None
            self._outlet.publish(taken.snapshot, taken.events, taken.changed, arrivals=arrivals)

    def _mark_down(self) -> None:
        self._whole, self._details, self._asked_again = Whole(), Received(), False
        self._outlet.end()


def _out_of_place(answer: Answer) -> MachineUnreachable:
    return MachineUnreachable(
        say(
            "The controller service sent {tell} in reply to another request; update both processes.",
            tell=repr(answer.tell),
        )
    )
