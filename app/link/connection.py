"""One stream from the panel to the machine: it connects again by itself, whatever ended it."""

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import suppress
from datetime import timedelta
from pathlib import Path
from typing import Any

from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_
from app.link.codec import (
    Answer,
    FrameBroken,
    Refused,
    Request,
    Unasked,
    decode_telling,
    encode_request,
    let_go,
    read_body,
)
from app.link.messages import MachineUnreachable

RECONNECT_AFTER = timedelta(milliseconds=300)
LAST_LOOK_S = 0.1
"""The end of a silence, left to what has come already: a loop that was busy judges only after it has read."""

DOWN = N_(
    "The controller service does not answer; nothing was done. Wait until the page shows live "
    "values again, or check that the service is running."
)
TOO_LATE = N_(
    "The controller service did not answer in time; it may or may not have carried out the "
    "request. Check the live values before you try again."
)

log = get_logger()


class ConnectionEnded(MachineUnreachable):
    """The stream ended while its answer was waited for."""


class Connection:
    """A stream of requests and their answers; what is told unasked goes to `hear`.

    `begin` is called when it is up, `end` whenever it is down. With `silence_s` it counts as down when
    nothing was heard for so long.
    """

    def __init__(
        self,
        path: Path,
        clock: Clock,
        *,
        hear: Callable[[Unasked], None] = lambda told: None,
        begin: Callable[[], None] = lambda: None,
        end: Callable[[], None] = lambda: None,
        silence_s: float | None = None,
    ) -> None:
        self._path = path
        self._clock = clock
        self._hear, self._begin, self._end = hear, begin, end
        self._silence_s = silence_s
        self._writer: asyncio.StreamWriter | None = None
        self._waiting: dict[int, asyncio.Future[Answer]] = {}
        self._task: asyncio.Task[None] | None = None

    @property
    def up(self) -> bool:
        """Return whether there is somebody at the other end."""
        return self._writer is not None

    @property
    def waiting(self) -> int:
        """Return how many requests are not answered yet."""
        return len(self._waiting)

    def start(self) -> None:
        """Begin to connect; returns at once, whether the machine is there or not."""
        if self._task is None:
            self._task = asyncio.create_task(self._keep_connected(), name="link")

    async def close(self) -> None:
        """Let go of the machine; whoever waits is told that it is unreachable."""
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task

    def send(self, request: Request) -> None:
        """Send what needs no answer, if somebody is there."""
        if self._writer is not None:
            self._writer.write(encode_request(request))

    async def ask(self, request: Request, patience_s: float) -> Answer:
        """Return the answer, or raise what the machine raised, or `MachineUnreachable`."""
        if self._writer is None:
            raise MachineUnreachable(DOWN)
        answered: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._waiting[request.number] = answered
        try:
            self._writer.write(encode_request(request))
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
                await self._marking_down(self._converse())
            except (OSError, EOFError):
                pass
            except FrameBroken as error:
                log.warning("link_dropped", link=self._path.name, reason=str(error))
            except Exception:
                log.exception("link_dropped", link=self._path.name)
            await self._clock.sleep_until(self._clock.now() + RECONNECT_AFTER)

    async def _marking_down(self, conversation: Coroutine[Any, Any, None]) -> None:
        try:
            await conversation
        finally:
            self._writer = None
            for answered in self._waiting.values():
                if not answered.done():
                    answered.set_exception(ConnectionEnded(TOO_LATE))
            self._end()

    async def _converse(self) -> None:
        reader, writer = await asyncio.open_unix_connection(self._path)
        self._writer = writer
        try:
            self._begin()
            while True:
                telling = decode_telling(await self._read(reader))
                if isinstance(telling, Unasked):
                    self._hear(telling)
                else:
                    self._take(telling)
        finally:
            await let_go(writer)

    async def _read(self, reader: asyncio.StreamReader) -> bytes:
        """Return the next body; raise `TimeoutError` when nothing was heard for too long."""
        if self._silence_s is None:
            return await read_body(reader)
        loop = asyncio.get_running_loop()
        async with asyncio.timeout(None) as patience:
            last_look = loop.call_later(
                self._silence_s - LAST_LOOK_S, lambda: patience.reschedule(loop.time() + LAST_LOOK_S)
            )
            try:
                return await read_body(reader)
            finally:
                last_look.cancel()

    def _take(self, answer: Answer) -> None:
        answered = self._waiting.get(answer.number)
        if answered is not None and not answered.done():
            answered.set_result(answer)
