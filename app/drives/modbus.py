"""The Modbus TCP master: one connection, one owner task, one request at a time, the urgent ones first."""

import asyncio
import logging
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from enum import IntEnum
from heapq import heapify, heappop, heappush

import structlog
from pymodbus.client import AsyncModbusTcpClient
from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU

from app.clock import Clock
from app.drives.drive import DriveError, DriveRefused, DriveSilent
from app.drives.modbus_reply import BadReply, Wanted, is_complete, wanted_read, wanted_write

TIMEOUT = timedelta(milliseconds=300)
FIRST_DELAY = timedelta(milliseconds=100)
LONGEST_DELAY = timedelta(seconds=1)
MOST_WAITING = 200


class Priority(IntEnum):
    """Who goes first when several wait."""

    STOP = 0
    JOG = 1
    COMMAND = 2
    POLL = 3


@dataclass(frozen=True, slots=True)
class Address:
    """Where a device is: host, TCP port, unit."""

    host: str
    port: int
    unit: int

    def __str__(self) -> str:
        return f"{self.host}:{self.port} unit {self.unit}"


@dataclass(order=True, slots=True)
class _Job:
    priority: Priority
    number: int
    address: int = field(compare=False)
    count: int = field(compare=False)
    words: tuple[int, ...] = field(compare=False)
    ticket: int | None = field(compare=False)
    what: str = field(compare=False)
    answer: "asyncio.Future[list[int]]" = field(compare=False)


EXCEPTIONS = {
    1: "does not know this function",
    2: "has no such register",
    3: "does not accept this value",
    4: "reports a failure of its own",
    5: "needs more time for this",
    6: "is busy",
    10: "cannot be reached through its gateway",
    11: "does not answer its gateway",
}
PERMANENT = (1, 2, 3)
UNREACHABLE = (10, 11)

log = structlog.get_logger(__name__)


class ModbusLink:
    """One device on Modbus TCP. Replies are checked byte by byte, writes are never sent twice.

    Transaction numbers go on across connections, so that a gateway's late reply never fits a new request.
    `ticket` changes with every new connection and every stop: a write that was issued under an older one
    is not sent, so that nothing moves before the state has been read again.
    """

    def __init__(self, address: Address, clock: Clock, timeout: timedelta = TIMEOUT) -> None:
        logging.getLogger("pymodbus").setLevel(logging.CRITICAL + 1)
        self._address = address
        self._clock = clock
        self._timeout_s = timeout.total_seconds()
        self._client: AsyncModbusTcpClient | None = None
        self._wanted: Wanted | None = None
        self._waiting: list[_Job] = []
        self._wake = asyncio.Event()
        self._owner: asyncio.Task[None] | None = None
        self._number = 0
        self._transaction = 0
        self._delay = FIRST_DELAY
        self._next_attempt_at: datetime | None = None
        self._closed = False
        self.ticket = 0

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        """Return holding registers, or raise `DriveError`; a damaged reply is asked for once more."""
        return await self._submit(priority, address, count, (), None, what)

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
        await self._submit(priority, address, len(words), tuple(words), ticket, what)

    async def stop(self, address: int, words: Sequence[int], *, what: str) -> None:
        """Write ahead of everything that waits, and drop the writes that wait.

        A stop is sent even if its caller gives up waiting; a newer one takes its place.
        """
        self.ticket += 1
        self._waiting = [job for job in self._waiting if not job.answer.done()]
        heapify(self._waiting)
        for job in self._waiting:
            if job.words and job.ticket is not None:
                _fail(job, DriveError(f"A stop overtook this: {job.what} was not written."))
        await self._submit(Priority.STOP, address, len(words), tuple(words), None, what)

    async def close(self) -> None:
        """Let go of the connection; who still waits is told."""
        self._closed = True
        if self._owner is not None:
            self._owner.cancel()
            with suppress(asyncio.CancelledError):
                await self._owner
        for job in self._waiting:
            _fail(job, DriveSilent(f"The connection to the drive at {self._address} was closed."))
        self._waiting.clear()
        self._drop()

    async def _submit(
        self,
        priority: Priority,
        address: int,
        count: int,
        words: tuple[int, ...],
        ticket: int | None,
        what: str,
    ) -> list[int]:
        if self._closed:
            raise DriveSilent(f"The connection to the drive at {self._address} was closed.")
        if len(self._waiting) >= MOST_WAITING and priority is not Priority.STOP:
            raise DriveSilent(f"The drive at {self._address} is too slow: {MOST_WAITING} requests wait.")
        if self._owner is None:
            self._owner = asyncio.create_task(self._own(), name=f"modbus {self._address}")
        self._number += 1
        answer: asyncio.Future[list[int]] = asyncio.get_running_loop().create_future()
        heappush(self._waiting, _Job(priority, self._number, address, count, words, ticket, what, answer))
        self._wake.set()
        return await answer

    async def _own(self) -> None:
        """Serve the waiting requests for ever, the most urgent first, one at a time."""
        while True:
            while not self._waiting:
                self._wake.clear()
                await self._wake.wait()
            job = heappop(self._waiting)
            if not job.answer.done() or job.priority is Priority.STOP:
                await self._serve(job)

    async def _serve(self, job: _Job) -> None:
        """Do one request and answer whoever waits for it; whatever goes wrong, the next one is served."""
        try:
            found = await self._carry_out(job)
        except DriveError as error:
            _fail(job, error)
        except asyncio.CancelledError:
            _fail(job, DriveSilent(f"The connection to the drive at {self._address} was closed."))
            raise
        except Exception:
            log.exception("modbus_request_failed", device=str(self._address), what=job.what)
            self._drop()
            _fail(job, DriveError(f"An unexpected error ended a request ({job.what}); the log has it."))
        else:
            if not job.answer.done():
                job.answer.set_result(found)

    async def _carry_out(self, job: _Job) -> list[int]:
        """Do one request; only a read whose connection broke or whose reply was bad is done again, once."""
        try:
            return await self._ask(job)
        except _Broken as broken:
            self._drop()
            if job.words:
                raise DriveError(
                    f"Writing {job.what} to the drive at {self._address} failed: {broken}. "
                    "It is not sent again."
                ) from broken
        try:
            return await self._ask(job)
        except _Broken as broken:
            self._drop()
            raise DriveError(
                f"Reading {job.what} from the drive at {self._address} failed twice: {broken}. "
                "Check the network and that only Modbus TCP is spoken there."
            ) from broken

    async def _ask(self, job: _Job) -> list[int]:
        client = await self._connected(urgent=job.priority is Priority.STOP)
        if job.ticket is not None and job.ticket != self.ticket:
            raise DriveError(
                f"The connection to the drive at {self._address} was renewed or stopped in between: "
                f"{job.what} was not written; its state is read first."
            )
        unit = self._address.unit
        try:
            if not job.words:
                self._wanted = wanted_read(unit, job.count)
                pending = client.read_holding_registers(job.address, count=job.count, device_id=unit)
            elif job.count == 1:
                self._wanted = wanted_write(unit, job.address, job.words)
                pending = client.write_register(job.address, job.words[0], device_id=unit)
            else:
                self._wanted = wanted_write(unit, job.address, job.words)
                pending = client.write_registers(job.address, job.words, device_id=unit)
            return self._checked(await pending, job)
        except BadReply as bad:
            raise _Broken(str(bad)) from bad
        except ModbusException as error:
            self._drop()
            raise DriveSilent(
                f"The drive at {self._address} did not answer within {self._timeout_s:g} s ({job.what}). "
                "Check its power, cable and address."
            ) from error
        finally:
            self._wanted = None

    def _checked(self, reply: ModbusPDU, job: _Job) -> list[int]:
        if not reply.isError():
            if not job.words and len(reply.registers) != job.count:
                raise _Broken(f"{len(reply.registers)} registers came instead of {job.count}")
            return list(reply.registers)
        code = reply.exception_code
        text = EXCEPTIONS.get(code, "answered with an unknown exception")
        sentence = f"The drive at {self._address} {text} (Modbus exception {code}): {job.what}."
        if code in PERMANENT:
            raise DriveRefused(f"{sentence} Check that the profile fits the device.")
        if code in UNREACHABLE:
            raise DriveSilent(sentence)
        raise DriveError(f"{sentence} It is asked again in the next cycle.")

    async def _connected(self, *, urgent: bool) -> AsyncModbusTcpClient:
        """Return a live connection; a new one changes the ticket. Raise `DriveSilent` if there is none."""
        if self._client is not None and self._client.connected:
            return self._client
        self._drop()
        now = self._clock.now()
        if self._next_attempt_at is not None and now < self._next_attempt_at and not urgent:
            raise DriveSilent(self._no_connection())
        client = AsyncModbusTcpClient(
            self._address.host,
            port=self._address.port,
            timeout=self._timeout_s,
            retries=0,
            reconnect_delay=0,
            trace_packet=self._inspect,
            trace_connect=self._notice,
        )
        self._client = client
        if not await client.connect():
            self._drop()
            self._next_attempt_at = now + self._delay
            self._delay = min(LONGEST_DELAY, self._delay * 2)
            raise DriveSilent(self._no_connection())
        client.ctx.next_tid = self._transaction
        self._next_attempt_at, self._delay = None, FIRST_DELAY
        self.ticket += 1
        return client

    def _no_connection(self) -> str:
        return (
            f"There is no connection to the drive at {self._address}. Check its power, cable and address; "
            "the connection is tried again by itself."
        )

    def _inspect(self, sending: bool, data: bytes) -> bytes:
        """Let only the complete, right reply through to the decoder; end the wait at the first wrong byte."""
        if sending or self._client is None:
            return data
        try:
            if self._wanted is None:
                raise BadReply("something came that nobody had asked for")
            complete = is_complete(data, self._wanted, self._client.ctx.request_transaction_id)
        except BadReply as bad:
            self._end_wait(bad)
            return b""
        return data if complete else b""

    def _notice(self, connected: bool) -> None:
        """End the wait for a reply as soon as the connection is lost."""
        if not connected:
            self._end_wait(BadReply("the connection was lost"))

    def _end_wait(self, bad: BadReply) -> None:
        if self._client is None:
            return
        future = self._client.ctx.response_future
        if self._wanted is not None and not future.done():
            future.set_exception(bad)
        else:
            self._drop()

    def _drop(self) -> None:
        client, self._client = self._client, None
        if client is not None:
            self.ticket += 1
            self._transaction = client.ctx.next_tid
            client.close()


class _Broken(Exception):
    """The connection broke or brought a bad reply."""


def _fail(job: _Job, error: DriveError) -> None:
    if not job.answer.done():
        job.answer.set_exception(error)
