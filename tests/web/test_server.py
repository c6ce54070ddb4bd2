"""The real server on a free port: deadlines, limits, and a quick end though streams are open."""

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator
from datetime import timedelta

import pytest
import uvicorn
from websockets.asyncio.client import connect

from app.base.clock import Clock, SystemClock
from app.base.turnstile import Turnstile
from app.link.messages import Order
from app.tracker.state.snapshot import SiteSnapshot
from app.web.http.server import (
    REQUEST_DEADLINE_S,
    Connections,
    PanelServer,
    cautious,
)
from app.web.live.live_protocol import cautious_sockets
from tests.fakes import FakeMachine, fake_app
from tests.fault_result import REAL, FaultResult
from tests.patience import PATIENCE_S


@contextlib.asynccontextmanager
async def serving(
    connections: Connections,
    deadline_s: float | None = None,
    socket_clock: Clock | None = None,
    machine: FakeMachine | None = None,
    turnstile: Turnstile | None = None,
    graceful_s: int | None = 2,
) -> AsyncIterator[tuple[PanelServer, int]]:
    app = fake_app(machine or FakeMachine())
    turnstile = Turnstile() if turnstile is None else turnstile
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(
        app,
        http=cautious(connections, turnstile, deadline_s or REQUEST_DEADLINE_S),
        ws=cautious_sockets(socket_clock or SystemClock(), turnstile),
        log_config=None,
        timeout_graceful_shutdown=graceful_s,
    )
    server = PanelServer(config, app.state.panel.hub.closing.set)
    serving = asyncio.create_task(server._serve([listener]))
    clock = SystemClock()
    while not server.started:
        await clock.sleep_until(clock.now() + timedelta(milliseconds=10))
    try:
        yield server, listener.getsockname()[1]
    finally:
        server.should_exit = True
        async with asyncio.timeout(PATIENCE_S):
            await serving
        listener.close()


@pytest.mark.fault(65)
async def test_a_request_has_eight_seconds_to_arrive(fault: FaultResult) -> None:
    """The very timer of a real connection is read: nobody waits for it."""
    async with serving(Connections(100)) as (server, port):
        _, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(b"GET /health HTTP/1.1\r\nHost: 127.0")
        assert await _status(port) == b"200", "the connection before it was accepted"
        (held,) = server.server_state.connections
        assert (held._deadline is not None, held._deadline_s) == (True, 8.0)
        fault.noticed(8.0, REAL)
        fault.shows_nothing("the connection is closed")
        writer.close()
        assert await _status(port) == b"200"
        fault.recovers("nothing was lost: other requests are answered")


ASKING = b"GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
Held = list[tuple[asyncio.StreamReader, asyncio.StreamWriter]]


async def holding(port: int, count: int, first: bytes) -> Held:
    held = [await asyncio.open_connection("127.0.0.1", port) for _ in range(count)]
    for reader, writer in held:
        writer.write(first)
        if first:
            await asyncio.wait_for(reader.readuntil(b"event: snapshot"), PATIENCE_S)
    return held


async def leave(held: Held) -> None:
    for _, writer in held:
        writer.close()
        with contextlib.suppress(ConnectionResetError):
            await writer.wait_closed()


@pytest.mark.fault(65)
async def test_stop_is_obeyed_where_a_client_has_no_connection_left() -> None:
    connections = Connections(100, most_a_client=2)
    async with serving(connections, 5.0) as (_, port):
        held = await holding(port, 2, ASKING)
        assert await _status(port) == b"503"
        assert await _status(port, "POST /api/v1/trackers/T1/stop") == b"202"
        assert await _status(port, "POST /api/v1/trackers/T1/track") == b"503"
        await leave(held)
        clock = SystemClock()
        while connections._held or connections._reserved:
            await clock.sleep_until(clock.now() + timedelta(milliseconds=10))
        assert await _status(port) == b"200"


@pytest.mark.fault(68)
async def test_a_viewer_that_has_gone_silently_is_noticed_by_the_system(fault: FaultResult) -> None:
    async with serving(Connections(100), 5.0) as (server, port):
        _, writer = await asyncio.open_connection("127.0.0.1", port)
        assert await _status(port) == b"200"
        (held,) = server.server_state.connections
        raw = held.transport.get_extra_info("socket")
        assert raw.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) == 10_000
        assert raw.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
        writer.close()
        fault.noticed(10.0, REAL)
        fault.shows_nothing("nobody is there to read it")
        fault.recovers("automatic: a page that comes back connects again")


class SlowToStop(FakeMachine):
    """A machine whose stops take until they are let go."""

    def __init__(self) -> None:
        super().__init__()
        self.begun, self.let_go = asyncio.Event(), asyncio.Event()

    async def execute(self, order: Order) -> SiteSnapshot:
        self.begun.set()
        await self.let_go.wait()
        return await super().execute(order)


async def test_what_comes_over_live_sockets_waits_for_a_stop_that_is_under_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("app.web.http.server.STOP_FIRST_S", 60.0)
    machine, turnstile, clock = SlowToStop(), Turnstile(), SystemClock()
    limits = serving(Connections(100), machine=machine, turnstile=turnstile)
    async with limits as (_, port), connect(f"ws://127.0.0.1:{port}/live") as page:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(b"POST /api/v1/trackers/T1/stop HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        await machine.begun.wait()
        await page.send('{"type":"ping","tc":1,"visible":false}')
        while not turnstile:
            await clock.sleep_until(clock.now() + timedelta(milliseconds=1))
        for _ in range(20):
            await asyncio.sleep(0)
        assert len(turnstile) == 1
        machine.let_go.set()
        assert (await reader.readline()).startswith(b"HTTP/1.1 202")
        while "pong" not in str(await page.recv()):
            pass
        writer.close()


async def test_server_ends_by_itself_though_streams_are_open() -> None:
    """Uvicorn would wait for them for ever: the server ends them."""
    async with serving(Connections(100), 5.0, graceful_s=None) as (server, port):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(b"GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert b"event: snapshot" in await asyncio.wait_for(
            reader.readuntil(b"\n\n"), PATIENCE_S
        ) + await reader.readuntil(b"\n\n")
        page = await connect(f"ws://127.0.0.1:{port}/live")
        server.should_exit = True
        await asyncio.wait_for(reader.read(), PATIENCE_S)
        await page.wait_closed()
        writer.close()


async def _status(port: int, request: str = "GET /health") -> bytes:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(f"{request} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode())
    answer = await asyncio.wait_for(reader.read(), PATIENCE_S)
    writer.close()
    return answer.split(b" ")[1]
