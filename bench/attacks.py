"""What a hostile computer does to a panel: `python -m bench.attacks NAME PORT SECONDS`."""

import argparse
import asyncio
import contextlib
import time
from collections.abc import Awaitable, Callable

from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

Attack = Callable[[int, float], Awaitable[None]]
HALF = b"GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "
STREAM = b"GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
CHANGE = b"PATCH /api/v1/site HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
DEEP = b"[" * 900_000
CHUNK = b"100000\r\n" + b" " * 0x100000 + b"\r\n"
GIGABYTE = 1000


async def _hold(port: int, count: int, first: bytes, again: bytes, until: float) -> None:
    """Hold connections open that begin so and go on so once a second; those hung up on are opened anew."""

    async def one() -> None:
        while time.monotonic() < until:
            with contextlib.suppress(OSError):
                _, writer = await asyncio.open_connection("127.0.0.1", port)
                writer.write(first)
                while time.monotonic() < until and not writer.is_closing():
                    await asyncio.sleep(1)
                    writer.write(again)
                writer.transport.abort()
            await asyncio.sleep(0.5)

    await asyncio.gather(*(one() for _ in range(count)))


async def _slow(port: int, until: float) -> None:
    await _hold(port, 200, HALF, b"a", until)


async def _idle(port: int, until: float) -> None:
    await _hold(port, 1000, b"", b"", until)


async def _streams(port: int, until: float) -> None:
    await _hold(port, 500, STREAM, b"", until)


async def _pages(port: int, until: float) -> None:
    """Hold 500 live pages open and read what they are told."""

    async def one() -> None:
        while time.monotonic() < until:
            with contextlib.suppress(OSError, WebSocketException, TimeoutError):
                async with connect(f"ws://127.0.0.1:{port}/live") as page, asyncio.timeout_at(until):
                    async for _ in page:
                        pass
            await asyncio.sleep(0.5)

    await asyncio.gather(*(one() for _ in range(500)))


async def _body(port: int, until: float) -> None:
    """Send up to a gigabyte in chunks, for as long as it is taken."""
    sent = 0
    while time.monotonic() < until and sent < GIGABYTE:
        with contextlib.suppress(OSError):
            _, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(CHANGE + b"Transfer-Encoding: chunked\r\n\r\n")
            while time.monotonic() < until and sent < GIGABYTE and not writer.is_closing():
                writer.write(CHUNK)
                sent += 1
                await writer.drain()
            writer.transport.abort()


async def _deep(port: int, until: float) -> None:
    request = CHANGE + f"Content-Length: {len(DEEP)}\r\nConnection: close\r\n\r\n".encode() + DEEP
    while time.monotonic() < until:
        with contextlib.suppress(OSError):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(request)
            await reader.read()
            writer.close()


async def _nothing(port: int, until: float) -> None:
    await asyncio.sleep(max(0.0, until - time.monotonic()))


ATTACKS: dict[str, Attack] = {
    "nothing (for comparison)": _nothing,
    "200 requests that never end": _slow,
    "1,000 idle connections": _idle,
    "500 streams": _streams,
    "500 live pages": _pages,
    "a body of 1 GB": _body,
    "JSON 900,000 levels deep": _deep,
}


def main() -> None:
    """Attack for so many seconds."""
    arguments = argparse.ArgumentParser(prog="python -m bench.attacks", description=__doc__)
    arguments.add_argument("name", choices=ATTACKS)
    arguments.add_argument("port", type=int)
    arguments.add_argument("seconds", type=float)
    given = arguments.parse_args()
    asyncio.run(ATTACKS[given.name](given.port, time.monotonic() + given.seconds))


if __name__ == "__main__":
    main()
