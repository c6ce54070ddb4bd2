"""Drives all trackers of a controller: every tick begins at its instant, and no drive delays another tracker.

Each tracker has a phase of its own within the period, so that ticks are spread over it. A turn is some
of what was asked for, then ends of leases, then what is due longest. A drive that answers at once is driven
here; every other one has its tick in a task beside, and until that has ended no second tick of it begins.
"""

import asyncio
from collections import deque
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from datetime import datetime, timedelta
from functools import partial
from heapq import heappop, heappush
from typing import Any, Protocol

from app.base.clock import Clock, give_way
from app.base.logs import get_logger
from app.site.loop.overload import Overload
from app.site.loop.tick_lateness import MILLISECOND, FineLateness

SLOT = timedelta(milliseconds=5)
GOLDEN = 0.6180339887498949
"""Multiples of it, without their whole part, lie spread evenly however many there are."""
MOST_ASKED_AT_ONCE, MOST_DUE_AT_ONCE = 8, 32
"""So many ticks at most before everything else that waits for the loop (a stop, a heartbeat) has its turn."""
GRACE = timedelta(milliseconds=10)
"""So long a tick may outlast the end of a lease before the drive is stopped beside it."""

log = get_logger()


class Ticking(Protocol):
    """What is driven: one tracker."""

    @property
    def answers_at_once(self) -> bool:
        """Return whether a tick never waits for anything."""

    def tick(self, scheduled: datetime | None) -> Coroutine[Any, Any, None]:
        """Return one tick; `scheduled` is the instant it is for, None where it was asked for."""

    def deadline(self) -> datetime | None:
        """Return the instant by which it must tick again, if that comes before the period is over."""

    async def outlasted(self) -> None:
        """Do what cannot wait for a tick that is still in flight, if the deadline it is for has passed."""


@dataclass(slots=True, eq=False)
class Slot:
    """One tracker's place: when it is due, its deadline that is watched, and its tick in flight."""

    ticking: Ticking
    number: int
    phase: timedelta
    deadline: datetime | None = None
    flight: asyncio.Task[None] | None = None
    asked: bool = False
    gone: bool = False


Entry = tuple[datetime, int, Slot]


class Scheduler:
    """One task for all trackers; what an order changes is looked at when the order has been carried out.

    It is `pressed` while more is to tick than one turn takes.
    """

    def __init__(
        self, clock: Clock, period: timedelta, overloaded: Callable[[Overload], None] = lambda _: None
    ) -> None:
        self.lateness = FineLateness()
        self.overload = Overload(overloaded)
        self.pressed = False
        self._clock = clock
        self._period = period
        self._origin = clock.now()
        self._count = 0
        self._due: list[Entry] = []
        self._deadlines: list[Entry] = []
        self._asked: deque[Slot] = deque()
        self._beside: set[asyncio.Task[None]] = set()
        self._awake = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self._failed = False

    @property
    def alive(self) -> bool:
        """Return whether it runs, and no tick has ended in an error that nobody caught."""
        return self._task is not None and not self._task.done() and not self._failed

    def start(self) -> None:
        """Begin: the phases count from now."""
        self._origin = self._clock.now()
        self._task = asyncio.create_task(self._run(), name="scheduler")

    async def close(self) -> None:
        """End; whoever still ticks is let go of by `remove`."""
        tasks = [task for task in (self._task, *self._beside) if task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def add(self, ticking: Ticking) -> Slot:
        """Have a tracker tick now, and from then on at the instants of its phase."""
        slots = max(1, self._period // SLOT)
        phase = SLOT * int(self._count * GOLDEN % 1.0 * slots)
        slot = Slot(ticking, self._count, phase)
        self._count += 1
        self._put_on(slot, self._origin + phase, self._clock.now())
        self.ask(slot)
        return slot

    async def remove(self, slot: Slot) -> None:
        """End a tracker's ticking, also the tick in flight."""
        slot.gone = True
        if slot.flight is not None:
            slot.flight.cancel()
            await asyncio.gather(slot.flight, return_exceptions=True)

    def ask(self, slot: Slot) -> None:
        """Tick now, or as soon as the tick in flight has ended."""
        if not slot.asked:
            slot.asked = True
            if slot.flight is None:
                self._asked.append(slot)
                self._awake.set()

    def late(self, scheduled: datetime) -> float:
        """Count a tick that begins now and was to begin then; return how late it is, in milliseconds."""
        now = self._clock.now()
        late_ms = max(0.0, (now - scheduled) / MILLISECOND)
        self.lateness.count(late_ms)
        self.overload.count(late_ms, now)
        return late_ms

    def look(self, slot: Slot) -> None:
        """Watch the deadline that the tracker has now: an order may have put it off or brought it nearer."""
        deadline = slot.ticking.deadline()
        if deadline == slot.deadline:
            return
        slot.deadline = deadline
        if deadline is not None:
            heappush(self._deadlines, (deadline, slot.number, slot))
            self._awake.set()

    async def _run(self) -> None:
        while True:
            self._awake.clear()
            self.pressed = self._turn()
            if self.pressed:
                await give_way()
            else:
                await self._wait()

    async def _wait(self) -> None:
        """Wait for the next instant, or until something was asked or has changed."""
        coming = [heap[0][0] for heap in (self._due, self._deadlines) if heap]
        if not coming:
            await self._awake.wait()
            return
        alarm = asyncio.create_task(self._clock.sleep_until(min(coming)))
        alarm.add_done_callback(self._ring)
        try:
            await self._awake.wait()
        finally:
            alarm.remove_done_callback(self._ring)
            alarm.cancel()

    def _ring(self, _: asyncio.Task[None]) -> None:
        self._awake.set()

    def _turn(self) -> bool:
        """Begin what is to tick now, and return whether there may be more.

        What was asked for comes first, but only some of it: a field that is woken at once makes no tick late.
        """
        more_asked = all(self._begin_asked() for _ in range(MOST_ASKED_AT_ONCE))
        more_due = all(self._begin_timed() for _ in range(MOST_DUE_AT_ONCE))
        return more_asked or more_due

    def _begin_asked(self) -> bool:
        if not self._asked:
            return False
        self._begin(self._asked.popleft(), None)
        return True

    def _begin_timed(self) -> bool:
        """Begin the first tick that is due, ends of leases before all others."""
        now = self._clock.now()
        if self._deadlines and self._deadlines[0][0] <= now:
            self._end_lease(*heappop(self._deadlines))
        elif self._due and self._due[0][0] <= now:
            self._begin_due(*heappop(self._due))
        else:
            return False
        return True

    def _begin_due(self, due: datetime, _: int, slot: Slot) -> None:
        if slot.gone:
            return
        self._put_on(slot, due, self._clock.now())
        if slot.flight is None:
            self._begin(slot, due)

    def _put_on(self, slot: Slot, due: datetime, after: datetime) -> None:
        """Have it be due at the first instant of its schedule that comes after another."""
        periods = max(0, (after - due) // self._period + 1)
        heappush(self._due, (due + self._period * periods, slot.number, slot))

    def _end_lease(self, deadline: datetime, _: int, slot: Slot) -> None:
        """Tick at a deadline that still stands, after a tick in flight; see to it that neither hangs."""
        if slot.gone or deadline != slot.deadline:
            return
        slot.deadline = None
        if slot.flight is None:
            self._begin(slot, deadline)
        else:
            slot.asked = True
        if slot.flight is not None:
            beside = asyncio.create_task(self._see_out(slot, deadline + GRACE))
            self._beside.add(beside)
            beside.add_done_callback(self._beside.discard)

    async def _see_out(self, slot: Slot, until: datetime) -> None:
        await self._clock.sleep_until(until)
        if slot.flight is not None and not slot.gone:
            await slot.ticking.outlasted()

    def _begin(self, slot: Slot, scheduled: datetime | None) -> None:
        slot.asked = False
        if slot.gone:
            return
        tick = slot.ticking.tick(scheduled)
        if slot.ticking.answers_at_once:
            _run_at_once(tick)
            self.look(slot)
        else:
            slot.flight = asyncio.create_task(tick)
            slot.flight.add_done_callback(partial(self._landed, slot))

    def _landed(self, slot: Slot, flight: asyncio.Task[None]) -> None:
        slot.flight = None
        if slot.gone or flight.cancelled():
            return
        error = flight.exception()
        if error is not None:
            self._failed = True
            log.critical("tick_ended_in_error", exc_info=error)
            return
        if slot.asked:
            self._asked.append(slot)
            self._awake.set()
        self.look(slot)


def _run_at_once(work: Coroutine[Any, Any, None]) -> None:
    """Run what never waits, without a task of its own."""
    try:
        work.send(None)
    except StopIteration:
        return
    work.close()
    raise RuntimeError("A drive that answers at once has waited.")
