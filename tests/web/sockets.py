"""A WebSocket's client in the same process and the same loop, without a network."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from typing import Any

from fastapi import FastAPI

from tests.patience import PATIENCE_S

HOST = b"127.0.0.1:8010"


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
    sent = {"host": HOST.decode(), **(headers or {})}
    scope = {
        "type": "websocket",
        "path": "/live",
        "raw_path": b"/live",
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in sent.items()],
        "scheme": "ws",
        "client": ("127.0.0.1", 50001),
        "server": ("127.0.0.1", 8010),
        "subprotocols": [],
        "extensions": {},
    }
    socket.outbox.put_nowait({"type": "websocket.connect"})
    serving = asyncio.create_task(app(scope, socket.outbox.get, socket.hear))
    serving.add_done_callback(lambda _: socket.ended.set())
    try:
        yield socket
    finally:
        socket.outbox.put_nowait({"type": "websocket.disconnect", "code": 1001})
        async with asyncio.timeout(PATIENCE_S):
            await serving
