"""uvicorn's WebSocket with a budget: a socket that floods is closed, and never holds up anybody else.

Frames are taken apart in small pieces, one piece of one socket a turn of the loop: 200 sockets that send all
they can at once leave every other request its turn in between.
"""

import asyncio
from typing import Any

from uvicorn._types import ASGIReceiveEvent
from uvicorn.config import Config
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from uvicorn.server import ServerState
from websockets.frames import Frame

from app.base.budget import Budget
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_
from app.base.turnstile import Turnstile

log = get_logger()

FLOODED = 4029
"""The code with which a socket that floods is closed; pages say it in a sentence."""

FLOOD = N_("This page sent more messages than Heliopanel accepts.")
MOST_AT_ONCE = 256
MOST_A_SECOND = 64.0
PIECE = 1024
FAREWELL_S = 1.0


class CautiousSocket(WebSocketsSansIOProtocol):
    """A WebSocket whose frames are counted and taken apart in turn."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
        *,
        turnstile: Turnstile,
        budget: Budget,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._turnstile = turnstile
        self._budget = budget
        self._rest = bytearray()
        self._flooded = False

    def data_received(self, data: bytes) -> None:
        """Keep what came until it is its turn, and read no more before that; of a flood keep nothing."""
        if self._flooded:
            return
        if not self._rest:
            self._turnstile.add(self._take)
        self._rest += data
        self._pause()

    def handle_events(self) -> None:
        """Pass on what came, as long as the budget lasts."""
        if all(self._budget.spend() for event in self.conn.events if isinstance(event, Frame)):
            super().handle_events()
        else:
            self._end_flood()

    async def receive(self) -> ASGIReceiveEvent:
        """Return the next message, and read on once none is left."""
        message = await self.queue.get()
        self._read_on()
        return message

    def _take(self) -> None:
        piece = bytes(self._rest[:PIECE])
        del self._rest[:PIECE]
        if self.transport.is_closing():
            self._rest.clear()
            return
        super().data_received(piece)
        if self._rest:
            self._turnstile.add(self._take)
        else:
            self._read_on()

    def _pause(self) -> None:
        if not self.read_paused and not self.transport.is_closing():
            self.read_paused = True
            self.transport.pause_reading()

    def _read_on(self) -> None:
        ready = self.queue.empty() and not self._rest
        if self.read_paused and ready and not self.transport.is_closing():
            self.read_paused = False
            self.transport.resume_reading()

    def _end_flood(self) -> None:
        """Close with the reason; what still comes is thrown away unread until the other end has heard."""
        self._flooded = True
        self._rest.clear()
        log.warning("a live socket that floods is closed", client=self.client[0] if self.client else "")
        if self.handshake_complete and not self.close_sent:
            self.queue.put_nowait({"type": "websocket.disconnect", "code": FLOODED, "reason": FLOOD})
            self.conn.send_close(FLOODED, FLOOD)
            self.transport.write(b"".join(self.conn.data_to_send()))
            self.close_sent = True
        if self.read_paused:
            self.read_paused = False
            self.transport.resume_reading()
        self.close_timer = self.loop.call_later(FAREWELL_S, self.transport.close)


def cautious_sockets(clock: Clock, turnstile: Turnstile) -> type[WebSocketsSansIOProtocol]:
    """Return the protocol with a turnstile that its sockets share, as uvicorn wants it: a class."""

    class Limited(CautiousSocket):
        def __init__(
            self,
            config: Config,
            server_state: ServerState,
            app_state: dict[str, Any],
            _loop: asyncio.AbstractEventLoop | None = None,
        ) -> None:
            budget = Budget(clock, per_s=MOST_A_SECOND, burst=MOST_AT_ONCE)
            super().__init__(config, server_state, app_state, _loop, turnstile=turnstile, budget=budget)

    return Limited
