"""What a hostile computer does: `python -m bench.attacks NAME PORT SUNSPEC_PORT MQTT_PORT TOKEN SECONDS`."""

import argparse
import asyncio
import contextlib
import socket
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from struct import pack

import orjson
from aiomqtt import Client, MqttError
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

from tests.soak.rigs.flood import Flooding, ends, stops


@dataclass(frozen=True, slots=True)
class Target:
    """The ports of what is attacked, and a token that may read and stop, as a viewer may."""

    panel: int
    sunspec: int
    mqtt: int
    token: str


Attack = Callable[[Target, float], Coroutine[None, None, None]]
HALF = b"GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "
STREAM = b"GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
CHANGE = b"PATCH /api/v1/site HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
DEEP = b"[" * 900_000
CHUNK = b"100000\r\n" + b" " * 0x100000 + b"\r\n"
GIGABYTE = 1000
READ = pack(">HHHBBHH", 7, 0, 6, 1, 3, 40000, 125)
COMMANDS = "flooded/trackers/T1/command"
MESSAGES = 3000


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


async def _slow(to: Target, until: float) -> None:
    await _hold(to.panel, 200, HALF, b"a", until)


async def _idle(to: Target, until: float) -> None:
    await _hold(to.panel, 1000, b"", b"", until)


async def _streams(to: Target, until: float) -> None:
    await _hold(to.panel, 500, STREAM, b"", until)


async def _pages(to: Target, until: float) -> None:
    """Hold 500 live pages open and read what they are told."""

    async def one() -> None:
        while time.monotonic() < until:
            with contextlib.suppress(OSError, WebSocketException, TimeoutError):
                async with connect(f"ws://127.0.0.1:{to.panel}/live") as page, asyncio.timeout_at(until):
                    async for _ in page:
                        pass
            await asyncio.sleep(0.5)

    await asyncio.gather(*(one() for _ in range(500)))


async def _body(to: Target, until: float) -> None:
    """Send up to a gigabyte in chunks, for as long as it is taken."""
    sent = 0
    while time.monotonic() < until and sent < GIGABYTE:
        with contextlib.suppress(OSError):
            _, writer = await asyncio.open_connection("127.0.0.1", to.panel)
            writer.write(CHANGE + b"Transfer-Encoding: chunked\r\n\r\n")
            while time.monotonic() < until and sent < GIGABYTE and not writer.is_closing():
                writer.write(CHUNK)
                sent += 1
                await writer.drain()
            writer.transport.abort()


async def _deep(to: Target, until: float) -> None:
    request = CHANGE + f"Content-Length: {len(DEEP)}\r\nConnection: close\r\n\r\n".encode() + DEEP
    while time.monotonic() < until:
        with contextlib.suppress(OSError):
            reader, writer = await asyncio.open_connection("127.0.0.1", to.panel)
            writer.write(request)
            await reader.read()
            writer.close()


async def _deaf(to: Target, until: float) -> None:
    """Ask SunSpec for registers without end and never take an answer."""
    while time.monotonic() < until:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", to.sunspec)) as deaf:
            deaf.setblocking(False)
            while time.monotonic() < until:
                await asyncio.get_running_loop().sock_sendall(deaf, READ * 200)


async def _pipelines(to: Target, until: float) -> None:
    """Ask SunSpec from four connections without waiting for answers, and take them."""

    async def one() -> None:
        while time.monotonic() < until:
            with contextlib.suppress(OSError):
                reader, writer = await asyncio.open_connection("127.0.0.1", to.sunspec)
                taking = asyncio.create_task(_take(reader))
                while time.monotonic() < until and not taking.done():
                    writer.write(READ * 200)
                    await writer.drain()

    await asyncio.gather(*(one() for _ in range(4)))


async def _take(reader: asyncio.StreamReader) -> None:
    with contextlib.suppress(OSError):
        while await reader.read(65536):
            pass


async def _crowd(to: Target, until: float) -> None:
    """Hold 17 SunSpec connections that say nothing; one that is closed comes back at once."""

    async def one() -> None:
        while time.monotonic() < until:
            with contextlib.suppress(OSError):
                reader, writer = await asyncio.open_connection("127.0.0.1", to.sunspec)
                await _take(reader)
                writer.close()
            await asyncio.sleep(0.1)

    await asyncio.gather(*(one() for _ in range(17)))


async def _commands(to: Target, until: float) -> None:
    """Send commands over MQTT as fast as the broker takes them, every second one a stop."""
    told = [orjson.dumps({"type": kind, "client": "flood"}) for kind in ("track", "stop")]
    while time.monotonic() < until:
        with contextlib.suppress(MqttError):
            async with Client("127.0.0.1", to.mqtt) as client:
                while time.monotonic() < until:
                    for payload in told:
                        await client.publish(COMMANDS, payload, 0)


def _flood(sockets: int, frames: bytes) -> Attack:
    """Return the attack of so many live sockets of a viewer that send this at once, again and again."""

    def once(to: Target) -> None:
        pages = []
        for _ in range(sockets):
            with contextlib.suppress(OSError, AssertionError):
                pages.append(Flooding.open(to.panel, to.token))
                pages[-1].send(frames)
        for page in pages:
            with contextlib.suppress(OSError, AssertionError):
                page.closed()

    async def attack(to: Target, until: float) -> None:
        while time.monotonic() < until:
            await asyncio.to_thread(once, to)

    return attack


async def _nothing(to: Target, until: float) -> None:
    await asyncio.sleep(max(0.0, until - time.monotonic()))


ATTACKS: dict[str, Attack] = {
    "nothing (for comparison)": _nothing,
    "200 requests that never end": _slow,
    "1,000 idle connections": _idle,
    "500 streams": _streams,
    "500 live pages": _pages,
    "a body of 1 GB": _body,
    "JSON 900,000 levels deep": _deep,
    "a SunSpec client that reads no answers": _deaf,
    "four SunSpec clients that pipeline": _pipelines,
    "17 idle SunSpec clients": _crowd,
    "a flood of MQTT commands": _commands,
    "a viewer's socket with 3,000 stops at a time": _flood(1, stops(MESSAGES)),
    "a viewer's socket with 3,000 ends of presses at a time": _flood(1, ends(MESSAGES)),
    "200 sockets of a viewer with 3,000 of each": _flood(200, stops(MESSAGES) + ends(MESSAGES)),
}


def main() -> None:
    """Attack for so many seconds."""
    arguments = argparse.ArgumentParser(prog="python -m bench.attacks", description=__doc__)
    arguments.add_argument("name", choices=ATTACKS)
    for port in ("port", "sunspec_port", "mqtt_port"):
        arguments.add_argument(port, type=int)
    arguments.add_argument("token")
    arguments.add_argument("seconds", type=float)
    given = arguments.parse_args()
    target = Target(given.port, given.sunspec_port, given.mqtt_port, given.token)
    print("begun", flush=True)
    asyncio.run(ATTACKS[given.name](target, time.monotonic() + given.seconds))


if __name__ == "__main__":
    main()
