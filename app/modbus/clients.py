"""The clients of a Modbus server: how much each may ask for, and which one gives way to a new one."""

import asyncio
import socket
from collections import Counter
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass

from app.base.budget import Budget
from app.base.clock import Clock, give_way
from app.base.logs import get_logger

CLOSE_WITHIN_S = 0.5
KEEP_ALIVE = (
    (socket.TCP_KEEPIDLE, 30),
    (socket.TCP_KEEPINTVL, 10),
    (socket.TCP_KEEPCNT, 3),
)
"""A client that vanished without a word, as behind a tunnel that broke, is noticed after one minute."""

log = get_logger()


@dataclass(frozen=True, slots=True)
class Limits:
    """What the clients of a server may do; None sets no limit.

    A client waits `idle_s` between two requests at most, sends the rest of a request within `rest_s`, and
    takes its replies within `take_s`; one that asks faster than `requests_per_s` is answered at that pace.
    """

    most: int = 64
    requests_per_s: float | None = None
    burst: int = 50
    idle_s: float | None = None
    rest_s: float = 5.0
    take_s: float = 5.0


class Client:
    """One connection; `TimeoutError` says that it took too long for something."""

    def __init__(
        self,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        limits: Limits,
        heard: Callable[[], None],
    ) -> None:
        self.host = str((writer.get_extra_info("peername") or ("",))[0])
        self.writer = writer
        self._reader = reader
        self._limits = limits
        self._heard = heard

    async def begin(self, count: int) -> bytes:
        """Return the first bytes of the next request."""
        async with asyncio.timeout(self._limits.idle_s):
            return await self._reader.readexactly(count)

    async def rest(self, count: int) -> bytes:
        """Return the rest of the request that was begun."""
        async with asyncio.timeout(self._limits.rest_s):
            rest = await self._reader.readexactly(count)
        self._heard()
        return rest

    async def send(self, reply: bytes) -> None:
        """Send a reply, and return once the client has taken so much that the next one has room."""
        self.writer.write(reply)
        async with asyncio.timeout(self._limits.take_s):
            await self.writer.drain()


class Clients:
    """Everyone who is connected, the one that has been quiet for longest first.

    `answer_one` answers one request of a client, and returns False where its connection is to be cut.
    """

    def __init__(self, answer_one: Callable[[Client], Awaitable[bool]], limits: Limits, clock: Clock) -> None:
        self._answer_one = answer_one
        self._limits = limits
        self._clock = clock
        self._quiet: dict[asyncio.Task[None], Client] = {}
        self._serving: set[asyncio.Task[None]] = set()
        self._is_closed = False

    def __len__(self) -> int:
        return len(self._quiet)

    def admit(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve one more client; if there are too many, another one gives way to it.

        One that was accepted while the server closed is cut off.
        """
        if self._is_closed:
            writer.transport.abort()
            return
        if len(self._quiet) >= self._limits.most:
            self._dismiss_one()
        self._watch(writer)
        client = Client(reader, writer, self._limits, lambda: self._heard(task))
        task = asyncio.create_task(self._serve(client))
        self._quiet[task] = client
        self._serving.add(task)
        task.add_done_callback(lambda done: self._forget(done, client))

    async def close(self) -> None:
        """Close every connection."""
        self._is_closed = True
        serving = tuple(self._serving)
        for task in serving:
            task.cancel()
        await asyncio.gather(*serving, return_exceptions=True)

    def _watch(self, writer: asyncio.StreamWriter) -> None:
        connection = writer.get_extra_info("socket")
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        for option, value in KEEP_ALIVE:
            connection.setsockopt(socket.IPPROTO_TCP, option, value)

    def _dismiss_one(self) -> None:
        """Cut off who has been quiet for longest, of the host that has the most connections."""
        hosts = Counter(client.host for client in self._quiet.values())
        most = max(hosts.values())
        task, client = next(one for one in self._quiet.items() if hosts[one[1].host] == most)
        del self._quiet[task]
        task.cancel()
        log.warning("modbus_client_gave_way", host=client.host, clients=self._limits.most)

    def _heard(self, task: asyncio.Task[None]) -> None:
        """Put a client behind all the others: nobody has been quiet for less long."""
        client = self._quiet.pop(task, None)
        if client is not None:
            self._quiet[task] = client

    def _forget(self, task: asyncio.Task[None], client: Client) -> None:
        self._quiet.pop(task, None)
        self._serving.discard(task)
        client.writer.transport.abort()

    async def _serve(self, client: Client) -> None:
        try:
            await self._answer(client)
        except TimeoutError:
            log.warning("modbus_client_dropped", host=client.host, reason="it was quiet, or took no replies")
        except (ConnectionError, asyncio.IncompleteReadError):
            pass
        finally:
            client.writer.close()
            with suppress(OSError):
                async with asyncio.timeout(CLOSE_WITHIN_S):
                    await client.writer.wait_closed()

    async def _answer(self, client: Client) -> None:
        """Answer until the connection is to be cut, at the pace that is allowed."""
        per_s = self._limits.requests_per_s
        budget = None if per_s is None else Budget(self._clock, per_s=per_s, burst=self._limits.burst)
        going_on = True
        while going_on:
            if budget is not None:
                await budget.wait()
            going_on = await self._answer_one(client)
            await give_way()
