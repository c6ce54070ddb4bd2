"""How many lasting answers one client may hold open: streams and live sockets, but never a stop."""

import asyncio
from collections import Counter

from starlette.types import ASGIApp, Receive, Scope, Send

from app.base.clock import Clock
from app.base.message import N_
from app.web.http.problems import MEDIA_TYPE, Problem, ProblemCode

LASTING = frozenset({"/live", "/api/v1/stream"})
MOST_STREAMS = 1024
MOST_STREAMS_A_CLIENT = 64
MOST_ON_PLAIN_CONNECTIONS = 192
"""An HTTP stream holds one of a client's plain connections; some are left for every other request."""
LOOPBACK = frozenset({"127.0.0.1", "::1"})
"""Programs on this computer, and tunnels that end here, share the total alone."""

TOO_MANY = N_("This device has too many live pages or streams open. Close some, then try again.")


class StreamLimit:
    """Turns away live sockets and streams beyond a client's share; every other request passes."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        clock: Clock,
        most: int = MOST_STREAMS,
        most_a_client: int = MOST_STREAMS_A_CLIENT,
        most_plain: int = MOST_ON_PLAIN_CONNECTIONS,
    ) -> None:
        self._app = app
        self._clock = clock
        self._turnstile = asyncio.Lock()
        self._most = most
        self._most_a_client = most_a_client
        self._most_plain = most_plain
        self._open: Counter[str] = Counter()
        self._plain: Counter[str] = Counter()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer 503 (a WebSocket: close it with 1013, try again later)."""
        if scope["type"] not in ("http", "websocket") or scope["path"] not in LASTING:
            await self._app(scope, receive, send)
            return
        client = scope["client"][0] if scope.get("client") else ""
        plain = scope["type"] == "http"
        if not self._has_room(client, plain=plain):
            await _refuse(scope, send)
            return
        counted = (self._open, self._plain) if plain else (self._open,)
        for count in counted:
            count[client] += 1
        try:
            await self._one_by_one()
            await self._app(scope, receive, send)
        finally:
            for count in counted:
                count[client] -= 1
                if not count[client]:
                    del count[client]

    def _has_room(self, client: str, *, plain: bool) -> bool:
        share = self._most if client in LOOPBACK else self._most_a_client
        if plain and self._plain[client] >= self._most_plain:
            return False
        return self._open[client] < share and self._open.total() < self._most

    async def _one_by_one(self) -> None:
        """Wait for one's turn to begin: of many that come at once each lets other requests pass before it."""
        async with self._turnstile:
            await self._clock.sleep_until(self._clock.now())


async def _refuse(scope: Scope, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1013, "reason": N_("too many")})
        return
    problem = Problem(ProblemCode.TOO_MANY_CONNECTIONS, TOO_MANY)
    headers = [(b"content-type", MEDIA_TYPE.encode()), (b"retry-after", b"5")]
    await send({"type": "http.response.start", "status": problem.status, "headers": headers})
    await send({"type": "http.response.body", "body": problem.body()})
