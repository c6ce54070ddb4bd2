"""One request in the same process whose answer never ends, as server-sent events are."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from typing import Any

from fastapi import FastAPI

from tests.fakes import PORT
from tests.patience import PATIENCE_S


class Reading:
    """What a reader of server-sent events has got."""

    def __init__(self) -> None:
        self.status = 0
        self.parts: asyncio.Queue[str] = asyncio.Queue()
        self.reads = asyncio.Event()
        self.reads.set()
        self.ended = asyncio.Event()

    async def hear(self, message: dict[str, Any]) -> None:
        """Take what the server sends, unless this reader is stuck."""
        await self.reads.wait()
        if message["type"] == "http.response.start":
            self.status = message["status"]
        elif message.get("body"):
            self.parts.put_nowait(message["body"].decode())

    async def next(self, name: str) -> dict[str, str]:
        """Return the fields of the next event of a name; others before it are passed over."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                fields = dict(line.split(": ", 1) for line in (await self.parts.get()).strip().splitlines())
                if fields["event"] == name:
                    return fields


def scope_of(
    method: str, path: str, query: str = "", headers: dict[str, str] | None = None
) -> dict[str, Any]:
    """Return the scope of a request from this computer; the method of a WebSocket is WS."""
    is_socket = method == "WS"
    sent = {"host": f"127.0.0.1:{PORT}", **(headers or {})}
    scope = {
        "type": "websocket" if is_socket else "http",
        "path": path,
        "raw_path": path.encode(),
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in sent.items()],
        "scheme": "ws" if is_socket else "http",
        "server": ("127.0.0.1", PORT),
        "client": ("127.0.0.1", 50000),
        "http_version": "1.1",
        "root_path": "",
        "subprotocols": [],
        "extensions": {},
    }
    return scope if is_socket else scope | {"method": method}


@contextlib.asynccontextmanager
async def streaming(
    app: FastAPI, query: str = "", headers: dict[str, str] | None = None
) -> AsyncIterator[Reading]:
    """Read `/api/v1/stream` and leave it at the end."""
    reading = Reading()
    leaves = asyncio.Event()
    inbox: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
    inbox.put_nowait({"type": "http.request", "body": b"", "more_body": False})

    async def receive() -> dict[str, Any]:
        if inbox.empty():
            await leaves.wait()
            return {"type": "http.disconnect"}
        return inbox.get_nowait()

    scope = scope_of("GET", "/api/v1/stream", query, headers)
    serving = asyncio.create_task(app(scope, receive, reading.hear))
    serving.add_done_callback(lambda _: reading.ended.set())
    try:
        yield reading
    finally:
        leaves.set()
        async with asyncio.timeout(PATIENCE_S):
            await serving
