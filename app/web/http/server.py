"""uvicorn with patience that ends: a deadline for requests, limits for connections, a quick farewell."""

import asyncio
import re
import resource
import socket
from collections import Counter
from collections.abc import Callable
from enum import Enum
from typing import Any, Protocol, assert_never

import uvicorn
from uvicorn.config import Config
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.server import ServerState

from app.base.logs import get_logger
from app.base.turnstile import Turnstile

log = get_logger()

REQUEST_DEADLINE_S = 8.0
LARGEST_HEAD = 64 * 1024
STOPS = re.compile(rb"(/api/v1)?(/trackers/[^/?]+)?/stop(\?.*)?")
"""What is answered even where a client has no connection left."""

FULL = (
    b"HTTP/1.1 503 Service Unavailable\r\nconnection: close\r\nretry-after: 5\r\n"
    b"content-type: text/plain; charset=utf-8\r\ncontent-length: 52\r\n\r\n"
    b"Too many connections are open. Close some, try again"
)
HEAD_TOO_LARGE = (
    b"HTTP/1.1 431 Request Header Fields Too Large\r\nconnection: close\r\ncontent-length: 0\r\n\r\n"
)
KEEP_ALIVE_S = 15
FAREWELL_S = 2
PING_S = 5.0
UNACKNOWLEDGED_MS = 10_000
MOST_A_CLIENT = 256
RESERVED = 64
MOST_TOLD = 1000
RESERVED_A_CLIENT = 8
DESCRIPTORS_RESERVED = 128
DESCRIPTORS_WANTED = 8192
LARGEST_MESSAGE = 16 * 1024
STOP_FIRST_S = 0.05
"""So long at most whatever comes over live sockets waits for a stop that is under way."""


class Admission(Enum):
    """What a new connection may be used for."""

    ANYTHING = "anything"
    STOP = "stop"
    NOTHING = "nothing"


class Member(Protocol):
    """A connection that is counted."""

    @property
    def is_idle(self) -> bool:
        """Return whether no answer is under way on it."""

    def hang_up(self) -> None:
        """End it, and count it no more."""


class Connections:
    """How many plain connections each client holds, and how many there may be; some are kept for Stop."""

    def __init__(self, most: int, most_a_client: int = MOST_A_CLIENT) -> None:
        self._most = most
        self._most_a_client = most_a_client
        self._held: Counter[str] = Counter()
        self._reserved: Counter[str] = Counter()
        self._members: dict[str, dict[Member, None]] = {}
        self._told: set[str] = set()

    def enter(self, client: str) -> Admission:
        """Count one more connection of a client, and return what it may be used for."""
        if self.admit(client):
            return Admission.ANYTHING
        if self._reserved[client] >= RESERVED_A_CLIENT or self._reserved.total() >= RESERVED:
            return Admission.NOTHING
        self._reserved[client] += 1
        return Admission.STOP

    def join(self, client: str, member: Member) -> Admission:
        """Count a connection; where a client's share is used up, its oldest idle connection makes room."""
        admission = self.enter(client)
        if admission is not Admission.ANYTHING and (oldest := self._oldest_idle(client)) is not None:
            self.leave(client, admission)
            oldest.hang_up()
            admission = self.enter(client)
        if admission is not Admission.NOTHING:
            self._members.setdefault(client, {})[member] = None
        return admission

    def part(self, client: str, member: Member, admission: Admission) -> None:
        """Count a connection no more."""
        mine = self._members.get(client, {})
        mine.pop(member, None)
        if not mine:
            self._members.pop(client, None)
        self.leave(client, admission)

    def is_new_excess(self, client: str) -> bool:
        """Return whether a client's excess is to be told of: once, until it has fewer connections again."""
        if client in self._told or len(self._told) >= MOST_TOLD:
            return False
        self._told.add(client)
        return True

    def _oldest_idle(self, client: str) -> Member | None:
        return next((one for one in self._members.get(client, ()) if one.is_idle), None)

    def leave(self, client: str, admission: Admission) -> None:
        """Count one less."""
        match admission:
            case Admission.ANYTHING:
                self.release(client)
            case Admission.STOP:
                self._reserved[client] -= 1
                if self._reserved[client] <= 0:
                    del self._reserved[client]
            case Admission.NOTHING:
                pass
            case _:
                assert_never(admission)

    def admit(self, client: str) -> bool:
        """Count one more connection of a client, unless that would be too many."""
        if self._held[client] >= self._most_a_client or self._held.total() >= self._most:
            return False
        self._held[client] += 1
        return True

    def release(self, client: str) -> None:
        """Count one less."""
        self._held[client] -= 1
        if 2 * self._held[client] <= self._most_a_client:
            self._told.discard(client)
        if self._held[client] <= 0:
            del self._held[client]


class CautiousHttp(HttpToolsProtocol):
    """HTTP that gives a request 8 s to arrive, and a client no more connections than its share."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
        *,
        connections: Connections,
        turnstile: Turnstile,
        deadline_s: float = REQUEST_DEADLINE_S,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._counted = connections
        self._turnstile = turnstile
        self._deadline_s = deadline_s
        self._deadline: asyncio.TimerHandle | None = None
        self._name: str
        self._admission: Admission
        self._head_bytes = 0
        self._head_is_open = True

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override] # as its parent
        """Begin to wait for a request, or hang up on a client that has too many connections."""
        super().connection_made(transport)
        self._name = self.client[0] if self.client else ""
        self._admission = self._counted.join(self._name, self)
        if self._admission is Admission.NOTHING:
            if self._counted.is_new_excess(self._name):
                log.warning("a client has too many connections", client=self._name)
            transport.abort()
            return
        _watch(transport)
        self._expect()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        self._settle()
        self._release()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take what came, unless a request's head has become too large."""
        if self._head_is_open and self._head_bytes > LARGEST_HEAD:
            self.transport.write(HEAD_TOO_LARGE)
            self.transport.close()
            return
        self._head_bytes += len(data)
        super().data_received(data)

    def on_headers_complete(self) -> None:
        """Begin to answer; a connection beyond the client's share is answered only if it stops something."""
        self._head_is_open = False
        is_stop = self._is_stop()
        if self._admission is Admission.STOP and not is_stop:
            self.transport.write(FULL)
            self.transport.close()
            return
        if is_stop:
            self._turnstile.hold(STOP_FIRST_S)
        super().on_headers_complete()

    def on_response_complete(self) -> None:
        """Let live sockets go on that waited for a stop."""
        self._turnstile.release()
        super().on_response_complete()

    @property
    def is_idle(self) -> bool:
        """Return whether no answer is under way: nothing was asked, or not all of it, or it is answered."""
        return self.cycle is None or self.cycle.response_complete

    def hang_up(self) -> None:
        """End the connection, and count it no more."""
        self._settle()
        self._release()
        self.transport.abort()

    def _is_stop(self) -> bool:
        return self.parser.get_method() == b"POST" and STOPS.fullmatch(self.url) is not None

    def on_message_begin(self) -> None:
        """Begin to wait for the rest of a request."""
        self._head_is_open, self._head_bytes = True, 0
        self._expect()
        super().on_message_begin()

    def on_body(self, body: bytes) -> None:
        """Take a part of a request; of one that was refused nothing is kept."""
        if not self.transport.is_closing():
            super().on_body(body)

    def on_message_complete(self) -> None:
        """The request is there."""
        self._settle()
        if not self.transport.is_closing():
            super().on_message_complete()

    def handle_websocket_upgrade(self) -> None:
        """The connection becomes a WebSocket, which is counted elsewhere, when its turn comes.

        500 that come at once took a quarter of a second of the loop, in which no Stop was read.
        """
        self._settle()
        self._release()
        self.transport.pause_reading()
        self._turnstile.add(self._upgrade)

    def _upgrade(self) -> None:
        if self.transport.is_closing():
            return
        self.transport.resume_reading()
        super().handle_websocket_upgrade()

    def _expect(self) -> None:
        self._settle()
        self._deadline = self.loop.call_later(self._deadline_s, self.transport.abort)

    def _settle(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _release(self) -> None:
        self._counted.part(self._name, self, self._admission)
        self._admission = Admission.NOTHING


class PanelServer(uvicorn.Server):
    """A server that says when it answers, and tells its streams to end before it waits for them."""

    def __init__(
        self, config: Config, say_farewell: Callable[[], None], on_answer: Callable[[], None] | None = None
    ) -> None:
        super().__init__(config)
        self._say_farewell = say_farewell
        self._on_answer = on_answer

    def leave(self) -> None:
        """End this serving as if it had been told to."""
        self.should_exit = True

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen, then say that it answers."""
        await super().startup(sockets)
        if self.started and self._on_answer is not None:
            self._on_answer()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End the streams, then wait for what is under way."""
        self._say_farewell()
        await super().shutdown(sockets)


def cautious(
    connections: Connections, turnstile: Turnstile, deadline_s: float = REQUEST_DEADLINE_S
) -> type[HttpToolsProtocol]:
    """Return the protocol with its limits, as uvicorn wants it: a class."""

    class Limited(CautiousHttp):
        def __init__(
            self,
            config: Config,
            server_state: ServerState,
            app_state: dict[str, Any],
            _loop: asyncio.AbstractEventLoop | None = None,
        ) -> None:
            super().__init__(
                config,
                server_state,
                app_state,
                _loop,
                connections=connections,
                turnstile=turnstile,
                deadline_s=deadline_s,
            )

    return Limited


def reserve_descriptors() -> int:
    """Ask for enough file descriptors and return how many may be connections."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = (
        max(soft, min(hard, DESCRIPTORS_WANTED)) if hard != resource.RLIM_INFINITY else DESCRIPTORS_WANTED
    )
    if wanted > soft:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
    return max(16, wanted - DESCRIPTORS_RESERVED)


def _watch(transport: asyncio.Transport) -> None:
    """Let the system end a connection whose other end has silently gone."""
    raw = transport.get_extra_info("socket")
    if raw is None or raw.family not in (socket.AF_INET, socket.AF_INET6):
        return
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, UNACKNOWLEDGED_MS)
