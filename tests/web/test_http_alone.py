"""The server's HTTP without a network: deadlines, heads, shares and upgrades, each call on the connection."""

import asyncio
import socket
from typing import Any

import pytest
import uvicorn

from app.web.http.server import (
    FULL,
    HEAD_TOO_LARGE,
    LARGEST_HEAD,
    MOST_A_CLIENT,
    REQUEST_DEADLINE_S,
    RESERVED,
    RESERVED_A_CLIENT,
    CautiousHttp,
    Connections,
    PanelServer,
)
from tests.captured_logs import capture_logs
from tests.web.wires import FAR, Wire, Wired, turns

GET = b"GET /health HTTP/1.1\r\nHost: here\r\n\r\n"
UPGRADE = (
    b"GET /live HTTP/1.1\r\nHost: here\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
)


class App:
    """Answers every request with its path, once it may; a WebSocket it accepts."""

    def __init__(self) -> None:
        self.scopes: list[Any] = []
        self.body = b""
        self.may = asyncio.Event()
        self.may.set()

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        self.scopes.append(scope)
        if scope["type"] == "websocket":
            await send({"type": "websocket.accept"})
            await receive()
            await receive()
            return
        message = {"more_body": True}
        while message["more_body"]:
            message = await receive()
            self.body += message["body"]
        await self.may.wait()
        headers = [(b"content-length", str(len(scope["path"])).encode())]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": scope["path"].encode()})


@pytest.fixture
def app() -> App:
    return App()


def took(wired: Wired) -> list[tuple[float, object]]:
    return [(timer.after_s, timer.work) for timer in wired.timers.left]


async def test_a_request_has_eight_seconds_or_what_is_set_to_arrive(app: App) -> None:
    for deadline, wired in ((REQUEST_DEADLINE_S, Wired(app)), (0.5, Wired(app, deadline_s=0.5))):
        wire = Wire()
        http = wired.http(wire)
        assert took(wired) == [(deadline, wire.abort)]
        http.data_received(GET[:10])
        assert took(wired) == [(deadline, wire.abort)]
        assert len(wired.timers.set) == 2, "it counts from the first byte anew"
        http.data_received(GET[10:])
        assert took(wired) == []
        await turns()
        assert wire.written.endswith(b"/health")
        http.data_received(GET[:10])
        assert (deadline, wire.abort) in took(wired)


async def test_the_server_knows_of_a_request_what_its_framework_wants(app: App) -> None:
    wired, wire = Wired(app), Wire()
    wired.http(wire).data_received(GET)
    await turns()
    (scope,) = app.scopes
    assert scope["client"] == (FAR, 50000)
    assert scope["state"] == {"of": "the server"}
    assert wired.state.total_requests == 1


async def test_a_connection_that_is_lost_is_counted_no_more_and_waited_for_no_more(app: App) -> None:
    wired, wire = Wired(app, Connections(100, most_a_client=1)), Wire()
    http = wired.http(wire)
    assert wired.connections._held == {FAR: 1}
    assert wired.state.connections == {http}
    http.connection_lost(None)
    assert not wired.connections._held
    assert not wired.connections._members
    assert took(wired) == []
    assert not wired.state.connections
    assert wire.closed
    gone = OSError("the line went")
    other = wired.http(Wire())
    other.connection_lost(gone)
    assert not other.transport.is_closing(), "what has broken is not closed as well"


async def test_who_was_hung_up_on_and_is_then_lost_is_counted_once(app: App) -> None:
    wired = Wired(app)
    http = wired.http(Wire())
    http.hang_up()
    http.connection_lost(None)
    assert not wired.connections._held
    assert not wired.connections._members


async def test_a_client_without_an_address_is_one_client(app: App) -> None:
    wired = Wired(app)
    wired.http(Wire(""))
    assert wired.connections._held == {"": 1}


async def test_a_client_with_too_many_connections_is_hung_up_on_and_told_of_once(app: App) -> None:
    app.may.clear()
    wired = Wired(app, Connections(1, most_a_client=1))
    for _ in range(1 + RESERVED_A_CLIENT):
        wired.http(Wire()).data_received(b"POST /stop HTTP/1.1\r\nHost: here\r\n\r\n")
    others = [Wire(f"10.0.0.{number}") for number in range(RESERVED - RESERVED_A_CLIENT)]
    for wire in others:
        wired.http(wire)
    connected = [Wire(), Wire(), Wire("192.0.2.8"), Wire()]
    with capture_logs() as logs:
        for wire in connected:
            wired.http(wire)
    assert [wire.aborted for wire in connected] == [True] * 4
    assert [work for _, work in took(wired)] == [wire.abort for wire in others]
    assert [line["client"] for line in logs] == [FAR, "192.0.2.8"]


async def test_a_head_of_any_length_beyond_the_largest_is_refused(app: App) -> None:
    wired = Wired(app)
    for size, refused in ((LARGEST_HEAD, False), (LARGEST_HEAD + 1, True)):
        wire = Wire()
        http = wired.http(wire)
        http.data_received(b"GET /health HTTP/1.1\r\nHost: here\r\nX: ")
        http.data_received(b"a" * size)
        assert not wire.closed, "what came at once is read"
        http.data_received(b"\r\n\r\n")
        await turns()
        assert wire.closed is refused
        assert wire.written.startswith(HEAD_TOO_LARGE if refused else b"HTTP/1.1 200 OK")


async def test_empty_lines_before_a_request_count_too(app: App) -> None:
    lines = b"\r\n" * (LARGEST_HEAD // 2)
    for more, refused in ((b"", False), (b"\n", True)):
        wired, wire = Wired(app), Wire()
        http = wired.http(wire)
        http.data_received(lines + more)
        http.data_received(GET)
        await turns()
        assert wire.written.startswith(HEAD_TOO_LARGE if refused else b"HTTP/1.1 200 OK")


async def test_a_body_is_no_part_of_the_head_and_every_request_has_a_head_of_its_own(app: App) -> None:
    wired, wire = Wired(app), Wire()
    http = wired.http(wire)
    http.data_received(b"POST /a HTTP/1.1\r\nHost: here\r\nContent-Length: 200000\r\n\r\n")
    for _ in range(4):
        http.data_received(b"x" * 50_000)
    await turns()
    assert wire.written.endswith(b"/a")
    assert app.body == b"x" * 200_000
    http.data_received(b"GET /b HTTP/1.1\r\n")
    http.data_received(b"Host: here\r\n\r\n")
    await turns()
    assert wire.written.endswith(b"/b")
    http.data_received(b"GET /c HTTP/1.1\r\nX: ")
    for _ in range(3):
        if not wire.closed:
            http.data_received(b"x" * 40_000)
    assert wire.written.endswith(HEAD_TOO_LARGE), "a later head is measured too"


STOPS = (b"/stop", b"/api/v1/stop", b"/trackers/T1/stop", b"/api/v1/trackers/T1/stop", b"/stop?a=1")
NO_STOPS = (b"/", b"/stops", b"/api/v2/stop", b"/trackers/T1/T2/stop", b"/trackers/T1/park", b"/a/stop")


@pytest.mark.parametrize(
    ("method", "path", "answered"),
    [(b"POST", path, True) for path in STOPS]
    + [(b"POST", path, False) for path in NO_STOPS]
    + [(b"GET", b"/stop", False)],
)
async def test_beyond_its_share_a_client_stops_and_nothing_else(
    app: App, method: bytes, path: bytes, answered: bool
) -> None:
    wired, wire = Wired(app, Connections(100, most_a_client=1)), Wire()
    app.may.clear()
    wired.http(Wire()).data_received(GET)
    http = wired.http(wire)
    app.may.set()
    http.data_received(method + b" " + path + b" HTTP/1.1\r\nHost: here\r\n\r\n")
    await turns()
    assert wire.closed is not answered
    assert wire.written.startswith(b"HTTP/1.1 200 OK") if answered else wire.written == FULL
    assert len(app.scopes) == 1 + answered


async def test_of_what_is_refused_for_a_clients_share_the_body_is_not_kept(app: App) -> None:
    wired, wire = Wired(app, Connections(100, most_a_client=1)), Wire()
    app.may.clear()
    wired.http(Wire()).data_received(GET)
    http = wired.http(wire)
    http.data_received(b"POST /a HTTP/1.1\r\nHost: here\r\nContent-Length: 5\r\n\r\nhel")
    http.data_received(b"lo")
    assert wire.written == FULL, "nothing else is answered"


async def test_the_connection_that_was_asked_nothing_longest_makes_room(app: App) -> None:
    wired = Wired(app, Connections(100, most_a_client=3))
    wires = [Wire() for _ in range(3)]
    answered, asked, silent = (wired.http(wire) for wire in wires)
    answered.data_received(GET)
    await turns()
    app.may.clear()
    asked.data_received(GET)
    await turns()
    assert (answered.is_idle, asked.is_idle, silent.is_idle) == (True, False, True)
    late = Wire()
    wired.http(late)
    assert [wire.aborted for wire in (*wires, late)] == [True, False, False, False]
    assert wired.connections._held == {FAR: 3}
    answered.connection_lost(None)
    assert wired.connections._held == {FAR: 3}, "it is counted no more already"
    waits = [timer for timer in wired.timers.left if timer.work == wires[0].abort]
    assert waits == [], "nobody waits for a request of it"


async def test_a_live_socket_is_counted_elsewhere_and_opened_in_its_turn(app: App) -> None:
    wired, wires = Wired(app, Connections(100, most_a_client=2)), [Wire(), Wire()]
    for wire in wires:
        wired.http(wire).data_received(UPGRADE)
        assert not wire.reads
    assert not wired.connections._held
    assert took(wired) == []
    assert [wire.protocol for wire in wires] == [None, None]
    await turns(1)
    assert wires[0].protocol is not None
    assert wires[1].protocol is None, "one a turn of the loop"
    await turns()
    assert wires[1].protocol is not None
    assert [wire.reads for wire in wires] == [True, True]
    assert wires[0].written.startswith(b"HTTP/1.1 101")
    assert {scope["path"] for scope in app.scopes} == {"/live"}
    for wire in wires:
        wire.protocol.connection_lost(None)
    await turns()


async def test_a_live_socket_whose_connection_has_gone_is_not_opened(app: App) -> None:
    wired, wire = Wired(app), Wire()
    wired.http(wire).data_received(UPGRADE)
    wire.close()
    await turns()
    assert wire.protocol is None
    assert not wire.reads


@pytest.mark.parametrize("family", [socket.AF_INET, socket.AF_INET6])
async def test_the_system_watches_connections_of_a_network(app: App, family: socket.AddressFamily) -> None:
    with socket.socket(family) as raw:
        Wired(app).http(Wire(raw=raw))
        assert raw.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
        assert raw.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) == 10_000


async def test_the_system_does_not_watch_connections_of_this_computer(app: App) -> None:
    with socket.socket(socket.AF_UNIX) as raw:
        Wired(app).http(Wire(raw=raw))
        assert raw.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 0


async def test_every_server_has_a_turnstile_of_its_own_and_the_same_for_all_connections(app: App) -> None:
    wired = Wired(app)
    first, second = wired.http(Wire()), wired.http(Wire())
    assert isinstance(first, CautiousHttp)
    assert first._turnstile is second._turnstile
    assert first._turnstile is not Wired(app).http(Wire())._turnstile


async def test_a_server_says_when_it_answers_and_bids_farewell_before_it_waits(
    app: App, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[object] = []
    starts = [False, True, True]

    async def startup(self: uvicorn.Server, sockets: Any = None) -> None:
        done.append(("listens", sockets))
        self.started = starts.pop(0)

    async def shutdown(self: uvicorn.Server, sockets: Any = None) -> None:
        done.append(("waits", sockets))

    monkeypatch.setattr(uvicorn.Server, "startup", startup)
    monkeypatch.setattr(uvicorn.Server, "shutdown", shutdown)
    config, sockets = Wired(app).config, [socket.socket()]
    server = PanelServer(config, lambda: done.append("farewell"), lambda: done.append("answers"))
    assert server.config is config
    for _ in range(2):
        await server.startup(sockets)
    await PanelServer(config, lambda: None).startup(sockets)
    await server.shutdown(sockets)
    sockets[0].close()
    listens = ("listens", sockets)
    assert done == [listens, listens, "answers", listens, "farewell", ("waits", sockets)]
    assert not server.should_exit
    server.leave()
    assert server.should_exit is True


def test_a_client_has_256_connections() -> None:
    connections = Connections(1000)
    assert sum(connections.admit(FAR) for _ in range(1000)) == MOST_A_CLIENT == 256
