"""One bus: one owner task, one request at a time, the urgent ones first; a handle for every device on it."""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from enum import IntEnum
from heapq import heapify, heappop, heappush

from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, Message, join, say, told_by, with_format
from app.modbus.device_exceptions import UNREACHABLE, refusal
from app.modbus.errors import DriveError, DriveSilent
from app.modbus.line_turn import LineTurn, Part
from app.modbus.silences import Silences
from app.modbus.wire import Ask, Broken, GivenUp, Refused, Timing, Unanswered, Wire

FIRST_DELAY = timedelta(milliseconds=100)
LONGEST_DELAY = timedelta(seconds=1)
MOST_WAITING = 200
AGAIN_AFTER_S = 0.05


class Priority(IntEnum):
    """Who goes first when several wait."""

    STOP = 0
    JOG = 1
    COMMAND = 2
    POLL = 3


@dataclass(order=True, slots=True)
class _Job:
    priority: Priority
    number: int
    unit: "BusUnit" = field(compare=False)
    ask: Ask = field(compare=False)
    ticket: int | None = field(compare=False)
    what: str = field(compare=False)
    answer: "asyncio.Future[list[int]]" = field(compare=False)


NOT_AGAIN = N_("The request is not repeated.")

log = get_logger()


class BusUnit:
    """One device on a bus. Replies are checked byte by byte, writes are never sent twice.

    `ticket` changes with every new connection, every lost reply and every stop: a write that was issued
    under an older one is not sent, so that nothing moves before the state has been read again.
    """

    def __init__(
        self,
        name: str,
        unit: int,
        timing: Timing,
        find_bus: Callable[[], "Bus"],
        *,
        reckoned_s: float = 0.0,
    ) -> None:
        self.unit = unit
        self.timing = timing
        self.part = Part(reckoned_s)
        self._name = name
        self._find_bus = find_bus
        self._bus: Bus | None = None
        self._stops = 0
        self._closed = False

    def __str__(self) -> Message:
        return say("{name} unit {unit}", name=self._name, unit=self.unit)

    @property
    def ticket(self) -> int:
        """Return the number under which a write may be sent."""
        return self._stops + (0 if self._bus is None else self._bus.epoch(self.unit))

    @property
    def unit_count(self) -> int:
        """Return how many devices share the bus, this one included."""
        return 1 if self._bus is None else self._bus.unit_count

    @property
    def line_turn(self) -> LineTurn:
        """Return how the bus is shared, and this device's part of a turn."""
        turn_s = self.part.takes_s if self._bus is None else self._bus.turn_s
        return LineTurn(self.unit_count, turn_s, self.part.reckoned_s)

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        """Return holding registers, or raise `DriveError`; a damaged reply is asked for once more."""
        return await self._submit(priority, Ask(self.unit, address, count), None, what)

    async def write(
        self,
        address: int,
        words: Sequence[int],
        *,
        what: str,
        ticket: int | None,
        priority: Priority = Priority.COMMAND,
    ) -> None:
        """Write holding registers in one frame, once, or raise `DriveError`; `ticket` None always goes."""
        await self._submit(priority, Ask(self.unit, address, len(words), tuple(words)), ticket, what)

    async def stop(self, address: int, words: Sequence[int], *, what: str) -> None:
        """Write ahead of everything that waits, and drop this device's writes that wait.

        A stop is sent even if its caller gives up waiting; a newer one takes its place.
        """
        self._stops += 1
        if self._bus is not None:
            self._bus.overtake(self)
        await self._submit(Priority.STOP, Ask(self.unit, address, len(words), tuple(words)), None, what)

    async def close(self) -> None:
        """Let go of the bus, which closes with its last device; who still waits is told."""
        if self._closed:
            return
        self._closed = True
        if self._bus is not None:
            await self._bus.leave(self)

    async def _submit(self, priority: Priority, ask: Ask, ticket: int | None, what: str) -> list[int]:
        if self._closed:
            raise DriveSilent(say("The connection to the drive at {self} was closed.", self=self))
        if self._bus is None:
            self._bus = self._find_bus()
            self._bus.join(self)
        return await self._bus.submit(self, priority, ask, ticket, what)


class Bus:
    """Owns the wire to one bus: a gateway, a device or a serial line, with one device or many."""

    def __init__(self, name: str, wire: Wire, clock: Clock) -> None:
        self.name = name
        self._wire = wire
        self._clock = clock
        self._units: list[BusUnit] = []
        self._waiting: list[_Job] = []
        self._flying: _Job | None = None
        self._wake = asyncio.Event()
        self._owner: asyncio.Task[None] | None = None
        self._number = 0
        self._delay = FIRST_DELAY
        self._next_attempt_at: datetime | None = None
        self._turn_s: float | None = None
        self._silences = Silences()

    @property
    def unit_count(self) -> int:
        """Return how many devices are in use on this bus."""
        return len(self._units)

    @property
    def turn_s(self) -> float:
        """Return how long it takes until every device was asked and told once."""
        if self._turn_s is None:
            self._turn_s = sum(unit.part.takes_s for unit in self._units)
        return self._turn_s

    def unit(self, unit: int, timing: Timing) -> BusUnit:
        """Return a handle for a device on this bus."""
        return BusUnit(self.name, unit, timing, lambda: self)

    def join(self, unit: BusUnit) -> None:
        """Count a device in."""
        self._units.append(unit)
        self._turn_s = None

    @property
    def _stop_waits(self) -> bool:
        return bool(self._waiting) and self._waiting[0].priority is Priority.STOP

    def epoch(self, unit: int) -> int:
        """Return a number that grows whenever it is no longer certain what a device has taken."""
        return self._wire.epoch(unit)

    def overtake(self, unit: BusUnit) -> None:
        """Drop the writes of a device that wait, and shorten the wait for a reply that does not come."""
        self._forget_abandoned(unit)
        for job in self._waiting:
            if job.unit is unit and job.ask.words and job.ticket is not None:
                _fail(job, DriveError(say("A stop had priority: {what} was not written.", what=job.what)))
        if self._flying is not None:
            self._wire.hurry()

    def _forget_abandoned(self, stopped: BusUnit | None = None) -> None:
        """Drop the requests that nobody waits for any more; of stops only those that a newer one replaces."""
        self._waiting = [
            job
            for job in self._waiting
            if not job.answer.done() or (job.priority is Priority.STOP and job.unit is not stopped)
        ]
        heapify(self._waiting)

    async def submit(
        self, unit: BusUnit, priority: Priority, ask: Ask, ticket: int | None, what: str
    ) -> list[int]:
        """Queue a request and return its reply, or raise `DriveError`."""
        if len(self._waiting) >= MOST_WAITING and priority is not Priority.STOP:
            self._forget_abandoned()
        if len(self._waiting) >= MOST_WAITING and priority is not Priority.STOP:
            raise DriveSilent(
                say(
                    "The drive at {unit} is too slow: {most_waiting} requests are waiting.",
                    unit=unit,
                    most_waiting=MOST_WAITING,
                )
            )
        is_busy = self._flying is not None or bool(self._waiting)
        if self._silences.all_silent and is_busy and priority is not Priority.STOP:
            raise _silent(unit)
        if self._owner is None:
            self._owner = asyncio.create_task(self._own(), name=say("modbus {name}", name=self.name))
        self._number += 1
        answer: asyncio.Future[list[int]] = asyncio.get_running_loop().create_future()
        heappush(self._waiting, _Job(priority, self._number, unit, ask, ticket, what, answer))
        self._wake.set()
        return await answer

    async def leave(self, unit: BusUnit) -> None:
        """Tell who waits for a device that it is closed; with the last one the bus closes."""
        closed = DriveSilent(say("The connection to the drive at {unit} was closed.", unit=unit))
        for job in self._waiting:
            if job.unit is unit:
                _fail(job, closed)
        if self._flying is not None and self._flying.unit is unit:
            _fail(self._flying, closed)
        self._units.remove(unit)
        self._silences.forget(unit)
        self._turn_s = None
        if self._units:
            return
        owner, self._owner = self._owner, None
        self._wire.close()
        while owner is not None and not owner.done():  # what it waits for may swallow a cancellation
            owner.cancel()
            await asyncio.wait({owner}, timeout=AGAIN_AFTER_S)

    async def _own(self) -> None:
        """Serve the waiting requests for ever, the most urgent first, one at a time."""
        while True:
            while not self._waiting:
                self._wake.clear()
                await self._wake.wait()
            job = heappop(self._waiting)
            if not job.answer.done() or job.priority is Priority.STOP:
                self._flying = job
                await self._serve(job)
                self._flying = None

    async def _serve(self, job: _Job) -> None:
        """Do one request and answer whoever waits for it; whatever goes wrong, the next one is served."""
        try:
            found = await self._carry_out(job)
        except DriveError as error:
            _fail(job, error)
        except asyncio.CancelledError:
            _fail(job, DriveSilent(say("The connection to the drive at {unit} was closed.", unit=job.unit)))
            raise
        except Exception:
            log.exception("modbus_request_failed", device=str(job.unit), what=job.what)
            self._wire.close()
            _fail(
                job,
                DriveError(say("An unexpected error ended a request ({what}); see the log.", what=job.what)),
            )
        else:
            if not job.answer.done():
                job.answer.set_result(found)

    async def _carry_out(self, job: _Job) -> list[int]:
        """Do one request; a read or a stop whose reply was bad is done again, once; no other write is."""
        try:
            return await self._ask(job)
        except Broken as broken:
            if job.ask.words and job.priority is not Priority.STOP:
                failed = say(
                    "Writing {what} to the drive at {unit} failed: {broken}.",
                    what=job.what,
                    unit=job.unit,
                    broken=told_by(broken),
                )
                raise DriveError(join(" ", (failed, NOT_AGAIN))) from broken
        try:
            return await self._ask(job)
        except Broken as broken:
            verb = N_("Writing") if job.ask.words else N_("Reading")
            failed = say(
                "{verb} {what} failed twice at the drive at {unit}: {broken}.",
                verb=verb,
                what=job.what,
                unit=job.unit,
                broken=told_by(broken),
            )
            raise DriveError(join(" ", (failed, self._wire.advice))) from broken

    async def _ask(self, job: _Job) -> list[int]:
        await self._make_ready(job)
        urgent = job.priority is Priority.STOP
        time = asyncio.get_running_loop().time
        begun_s = time()
        try:
            if not urgent and self._stop_waits:
                raise GivenUp
            found = await self._wire.exchange(job.ask, job.unit.timing, urgent=urgent)
        except Refused as refused:
            if refused.code in UNREACHABLE:
                self._note_silence(job.unit)
            else:
                self._silences.heard(job.unit)
            raise refusal(refused.code, job.unit, job.what) from refused
        except GivenUp as given_up:
            raise DriveSilent(
                say("A stop ended the wait for the drive at {unit} ({what}).", unit=job.unit, what=job.what)
            ) from given_up
        except Unanswered as unanswered:
            self._note_silence(job.unit)
            raise DriveSilent(_unanswered(job)) from unanswered
        self._silences.heard(job.unit)
        job.unit.part.note(job.ask.address, time() - begun_s, written=bool(job.ask.words))
        self._turn_s = None
        return found

    def _note_silence(self, unit: BusUnit) -> None:
        """Note that a device did not answer; if nobody does, who waits is told, and one at a time asks."""
        self._silences.unheard(unit, self._clock.now(), timedelta(seconds=unit.timing.timeout_s))
        if not self._silences.all_silent:
            return
        for job in self._waiting:
            if job.priority is not Priority.STOP:
                _fail(job, _silent(job.unit))

    async def _make_ready(self, job: _Job) -> None:
        """Connect and check that the request may still be sent, or raise `DriveError`."""
        urgent = job.priority is Priority.STOP
        if not urgent and self.unit_count > 1 and self._silences.resting(job.unit, self._clock.now()):
            raise _silent(job.unit)
        if not self._wire.connected:
            await self._connect(job.unit, urgent=urgent)
        if job.ticket is not None and job.ticket != job.unit.ticket:
            raise DriveError(
                say(
                    "The connection to the drive at {unit} was renewed or stopped meanwhile: {what} was "
                    "not written. The drive's state is read first.",
                    unit=job.unit,
                    what=job.what,
                )
            )

    async def _connect(self, unit: BusUnit, *, urgent: bool) -> None:
        """Connect, or raise `DriveSilent`; after a failure not before some time has passed."""
        now = self._clock.now()
        too_soon = self._next_attempt_at is not None and now < self._next_attempt_at and not urgent
        if not too_soon and await self._wire.connect():
            self._next_attempt_at, self._delay = None, FIRST_DELAY
            return
        if not too_soon:
            self._next_attempt_at = now + self._delay
            self._delay = min(LONGEST_DELAY, self._delay * 2)
        missing = say("There is no connection to the drive at {unit}.", unit=unit)
        raise DriveSilent(join(" ", (missing, self._wire.advice)))


def _silent(unit: BusUnit) -> DriveSilent:
    return DriveSilent(
        say("The drive at {unit} does not answer; the request is repeated shortly.", unit=unit)
    )


def _unanswered(job: _Job) -> Message:
    """Return that there was no answer in time, and what to check."""
    missing = say(
        "The drive at {unit} did not answer within {timeout_s} s ({what}).",
        unit=job.unit,
        timeout_s=with_format(job.unit.timing.timeout_s, "g"),
        what=job.what,
    )
    check = say(
        "Check its power and cable, its unit id {unit}, and, on a serial line, the speed and parity.",
        unit=job.unit.unit,
    )
    return join(" ", (missing, check))


def _fail(job: _Job, error: DriveError) -> None:
    if not job.answer.done():
        job.answer.set_exception(error)
