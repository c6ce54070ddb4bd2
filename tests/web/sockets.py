"""A WebSocket's client in the same process and the same loop, without a network."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from typing import Any

from fastapi import FastAPI

from tests.patience import PATIENCE_S
from tests.web.asgi import scope_of


def heartbeat(press: str, sequence: int, sent_ms: float) -> dict[str, Any]:
    """Return what a page sends while the key is held that turns the azimuth of T1."""
    return {
        "type": "jog", "tracker_id": "T1", "press_id": press, "axis": "azimuth", "direction": 1,
        "speed": "slow", "sequence": sequence, "tc": sent_ms, "rtt_ms": 5.0,
    }  # fmt: skip


class Socket:
    """The browser's end: what was received lies in `inbox` until it is taken."""

    def __init__(self) -> None:
        self.outbox: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self.inbox: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self.closed: int | None = None
        self.ended = asyncio.Event()
        self.reads = asyncio.Event()
        self.reads.set()

    async def send(self, **message: Any) -> None:
        """Send one JSON message."""
        await self.outbox.put({"type": "websocket.receive", "text": json.dumps(message)})

    async def beat(self, press: str, sequence: int, tc: float, **more: Any) -> None:
        """Send that the key which turns the azimuth of T1 is held."""
        await self.send(**(heartbeat(press, sequence, tc) | more))

    async def next(self, kind: str) -> dict[str, Any]:
        """Return the next message of a kind; others before it are passed over."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                message = await self.inbox.get()
                if message["type"] == kind:
                    return message

    async def hear(self, message: dict[str, Any]) -> None:
        """Take what the server sends, unless this reader is stuck."""
        await self.reads.wait()
        if message["type"] == "websocket.send":
            self.inbox.put_nowait(json.loads(message["text"]))
        if message["type"] == "websocket.close":
            self.closed = message["code"]


@contextlib.asynccontextmanager
async def connected(
    app: FastAPI, query: str = "", headers: dict[str, str] | None = None
) -> AsyncIterator[Socket]:
    """Open `/live` and close it at the end."""
    socket = Socket()
    scope = scope_of("WS", "/live", query, headers)
    socket.outbox.put_nowait({"type": "websocket.connect"})
    serving = asyncio.create_task(app(scope, socket.outbox.get, socket.hear))
    serving.add_done_callback(lambda _: socket.ended.set())
    try:
        yield socket
    finally:
        socket.outbox.put_nowait({"type": "websocket.disconnect", "code": 1001})
        async with asyncio.timeout(PATIENCE_S):
            await serving
