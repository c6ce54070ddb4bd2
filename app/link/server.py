"""The machine's end of the link: each order in its own task, updates pushed, every queue bounded."""

import asyncio
import os
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

from app.base.budget import Budget
from app.base.clock import Clock, SystemClock
from app.base.logs import get_logger
from app.link.codec import FrameBroken, encode_telling, let_go, stop_path, told
from app.link.conversation import (
    MOST_AT_ONCE,
    REQUESTS_PER_S,
    Conversation,
    MeteredMachine,
    StopLane,
)
from app.link.messages import Update

TAKE_WITHIN_S = 5.0

log = get_logger()

Run = Callable[[asyncio.StreamReader, asyncio.StreamWriter], Coroutine[Any, Any, None]]


class LinkServer:
    """Serves one machine on Unix sockets that only their owner can open: one for stops, one for the rest."""

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
        self._servers: list[asyncio.Server] = []
        self._conversations: set[asyncio.Task[None]] = set()
        self._lanes: set[asyncio.Task[None]] = set()
        self._encoded: tuple[Update, bytes] | None = None

    async def start(self) -> None:
        """Listen; socket files left by a crash are replaced."""
        self._remove_files()
        await self._listen(stop_path(self._path), self._take_stops, self._lanes)
        await self._listen(self._path, self._converse, self._conversations)

    async def close(self) -> None:
        """Stop listening and end every conversation."""
        for server in self._servers:
            server.close()
        tasks = (*self._conversations, *self._lanes)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._remove_files()

    def _remove_files(self) -> None:
        for path in (self._path, stop_path(self._path)):
            path.unlink(missing_ok=True)

    async def _listen(self, path: Path, run: Run, tasks: set[asyncio.Task[None]]) -> None:
        def accept(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            task = asyncio.create_task(_until_it_ends(run, reader, writer))
            tasks.add(task)
            task.add_done_callback(tasks.discard)

        before = os.umask(0o177)
        try:
            self._servers.append(await asyncio.start_unix_server(accept, path))
        finally:
            os.umask(before)

    async def _converse(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        budget = Budget(self._clock, per_s=REQUESTS_PER_S, burst=MOST_AT_ONCE)
        conversation = Conversation(
            self._machine, writer, lambda: self.client_count, budget, self._take_within_s, self._encode
        )
        await conversation.run(reader)

    async def _take_stops(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await StopLane(self._machine, writer).run(reader)

    def _encode(self, update: Update) -> bytes:
        """Return the frame of an update, made once for all who are told the same."""
        if self._encoded is None or self._encoded[0] is not update:
            self._encoded = update, encode_telling(told(update))
        return self._encoded[1]

    @property
    def client_count(self) -> int:
        """Return how many panels are connected."""
        return len(self._conversations)


async def _until_it_ends(run: Run, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Converse with one panel, and log what ended it: it connects anew."""
    try:
        await run(reader, writer)
    except (EOFError, OSError):
        log.info("link_client_left")
    except FrameBroken as error:
        log.warning("link_client_dropped", reason=str(error))
    except Exception:
        log.exception("link_client_dropped")
    finally:
        await let_go(writer)
