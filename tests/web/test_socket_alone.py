"""The live socket without a network: what it takes, in which order, when it reads, and how a flood ends."""

import asyncio
from datetime import timedelta
from typing import Any

import pytest
from websockets.frames import Frame, Opcode

from app.base.clock import VirtualClock
from app.web.live.live_protocol import (
    FLOOD,
    FLOODED,
    MOST_A_SECOND,
    MOST_AT_ONCE,
    PIECE,
    CautiousSocket,
)
from tests.captured_logs import capture_logs
from tests.fake_data import NOON
from tests.web.test_http_alone import UPGRADE
from tests.web.wires import FAR, Wire, Wired, turns

FAREWELL = Frame(Opcode.CLOSE, FLOODED.to_bytes(2, "big") + FLOOD.encode()).serialize(mask=False)
END = {"type": "websocket.disconnect", "code": FLOODED, "reason": FLOOD}
HELLO = {"type": "websocket.connect"}


def text(said: str) -> bytes:
    """Return the frame of a message from a browser."""
    return Frame(Opcode.TEXT, said.encode()).serialize(mask=True)


def received(said: str) -> dict[str, str]:
    return {"type": "websocket.receive", "text": said}


class App:
    """Accepts a socket once it may, and takes messages once it may."""

    def __init__(self) -> None:
        self.heard: list[Any] = []
        self.accepts, self.takes = asyncio.Event(), asyncio.Event()
        self.accepts.set()
        self.takes.set()
        self.send: Any = None

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        self.send = send
        message = await receive()
        self.heard.append(message)
        await self.accepts.wait()
        await send({"type": "websocket.accept"})
        while message["type"] != "websocket.disconnect":
            await self.takes.wait()
            message = await receive()
            self.heard.append(message)


class Page:
    """A browser's page: its wire, the protocol at the other end, and the application behind that."""

    def __init__(self, wired: Wired, app: App) -> None:
        self.wired, self.app, self.wire = wired, app, Wire()
        self.socket: CautiousSocket = wired.socket(self.wire)

    async def open(self) -> None:
        """Shake hands."""
        self.socket.data_received(UPGRADE)
        await turns()
        self.wire.written.clear()

    def send(self, *said: str) -> None:
        """Have the network hand over messages at once."""
        self.socket.data_received(b"".join(text(one) for one in said))

    @property
    def heard(self) -> list[Any]:
        """Return what the application has heard after its hello."""
        return self.app.heard[1:]

    async def leave(self) -> None:
        """Go away without a word."""
        self.socket.connection_lost(None)
        self.app.takes.set()
        self.app.accepts.set()
        await turns()


def new_page(clock: VirtualClock | None = None) -> Page:
    app = App()
    return Page(Wired(app, clock=clock or VirtualClock(NOON)), app)


async def opened(clock: VirtualClock | None = None) -> Page:
    page = new_page(clock)
    await page.open()
    return page


async def test_what_came_is_taken_in_its_turn_and_nothing_is_read_before() -> None:
    page = await opened()
    assert page.wire.reads
    page.send("a")
    assert not page.wire.reads
    page.send("b")
    assert len(page.socket._turnstile) == 1, "it waits once"
    assert page.heard == []
    await turns()
    assert page.heard == [received("a"), received("b")]
    assert page.wire.reads
    await page.leave()


async def test_the_application_knows_of_a_socket_what_its_framework_wants() -> None:
    page = new_page()
    assert page.socket in page.wired.state.connections
    assert page.socket.app_state == {"of": "the server"}
    assert page.socket.config is page.wired.config
    await page.open()
    assert page.app.heard == [HELLO]
    await page.leave()


async def test_nothing_is_read_while_a_message_waits_for_the_application() -> None:
    page = await opened()
    page.app.takes.clear()
    page.send("a", "b", "c")
    await turns()
    assert page.heard == [received("a")], "it had asked for one already"
    assert not page.wire.reads
    assert not len(page.socket._turnstile)
    page.app.takes.set()
    await turns()
    assert len(page.heard) == 3
    assert page.wire.reads
    await page.leave()


async def test_nothing_is_read_while_a_rest_waits_though_the_application_has_heard_all() -> None:
    page = await opened()
    long = text("x" * 3 * PIECE)
    page.socket.data_received(text("a") + long)
    for _ in range(2):
        await turns(1)
        assert not page.wire.reads
    await turns()
    assert [len(message["text"]) for message in page.heard] == [1, 3 * PIECE]
    assert page.wire.reads
    await page.leave()


async def test_a_socket_that_sends_much_at_once_lets_others_through_piece_by_piece() -> None:
    app = App()
    wired = Wired(app, clock=VirtualClock(NOON))
    pages = [Page(wired, app) for _ in range(2)]
    for page in pages:
        await page.open()
    app.heard = [HELLO]
    much = b"".join(text("x" * 250) for _ in range(16))
    pages[0].socket.data_received(much)
    pages[1].send("y")
    order = []
    for _ in range(6):
        await turns(1)
        order.append((len(pages[0].socket._rest), len(pages[1].socket._rest)))
    left = len(much) - PIECE
    short = len(text("y"))
    assert order[:4] == [(left, short), (left, 0), (left - PIECE, 0), (left - 2 * PIECE, 0)]
    await turns(30)
    assert len(app.heard) == 1 + 17
    for page in pages:
        await page.leave()


@pytest.mark.parametrize("beyond", [0, 1])
async def test_a_piece_is_taken_a_turn(beyond: int) -> None:
    page = await opened()
    data = text("x" * PIECE * 2)
    page.socket.data_received(data[: PIECE + beyond])
    await turns(1)
    assert (len(page.socket._turnstile), len(page.socket._rest)) == (beyond, beyond)
    assert page.wire.reads is not bool(beyond)
    await turns()
    assert page.wire.reads
    await page.leave()


async def test_of_a_socket_that_has_gone_the_rest_is_thrown_away() -> None:
    page = await opened()
    page.send(*"x" * 2 * PIECE)
    page.wire.close()
    await turns()
    assert not page.socket._rest
    assert not len(page.socket._turnstile)
    assert received("x") not in page.heard
    assert not page.wire.reads, "nothing more is read"
    await page.leave()


async def test_what_is_closing_is_neither_paused_nor_resumed() -> None:
    page = await opened()
    page.wire.close()
    page.send("a")
    assert page.wire.reads
    await turns()
    assert page.heard == []
    other = await opened()
    other.app.takes.clear()
    other.send("a", "b")
    await turns()
    assert not other.wire.reads
    other.wire.close()
    other.app.takes.set()
    await turns()
    assert other.heard == [received("a"), received("b")]
    assert not other.wire.reads
    for one in (page, other):
        await one.leave()


async def test_so_many_messages_are_taken_at_once_and_so_many_a_second() -> None:
    clock = VirtualClock(NOON)
    page = await opened(clock)
    page.send(*"x" * MOST_AT_ONCE)
    await turns(2 * MOST_AT_ONCE)
    assert page.heard == [received("x")] * MOST_AT_ONCE
    clock.advance(timedelta(seconds=1))
    page.send(*"y" * int(MOST_A_SECOND))
    await turns(2 * MOST_AT_ONCE)
    assert page.heard[MOST_AT_ONCE:] == [received("y")] * int(MOST_A_SECOND)
    assert page.wire.written == b""
    assert page.wire.reads
    with capture_logs() as logs:
        page.send("z")
        await turns()
    assert page.wire.written == FAREWELL
    assert page.heard[-1] == END
    assert [line["client"] for line in logs] == [FAR]


async def flooded(page: Page) -> None:
    page.send(*"x" * (MOST_AT_ONCE + 1))
    await turns(2 * MOST_AT_ONCE)


async def test_a_flood_is_closed_with_its_reason_and_thrown_away_until_the_other_end_has_heard() -> None:
    page = await opened()
    page.send(*"x" * (MOST_AT_ONCE + 600))
    await turns(3 * MOST_AT_ONCE)
    assert page.wire.written == FAREWELL
    assert page.heard[-1] == END
    assert not page.socket._rest
    assert page.wire.reads, "so that it hears the answer of the other end"
    assert not page.wire.closed
    (farewell,) = (timer for timer in page.wired.timers.left if timer.work == page.wire.close)
    assert farewell.after_s == 1.0
    close_timer: object = page.socket.close_timer
    assert close_timer is farewell
    page.send("more")
    assert not page.socket._rest
    assert not len(page.socket._turnstile)
    assert page.wire.reads
    await turns()
    for timer in page.wired.timers.left:
        if timer is not farewell:
            timer.work()
    assert page.wire.written == FAREWELL, "nor is it asked for signs of life"


async def test_a_flood_before_the_handshake_has_no_reason_and_ends_all_the_same() -> None:
    page = new_page()
    page.app.accepts.clear()
    await page.open()
    assert page.app.heard == [HELLO]
    await flooded(page)
    assert page.wire.written == b""
    assert [timer.work for timer in page.wired.timers.left] == [page.wire.close]
    assert page.wire.reads
    await page.leave()
    assert END not in page.heard


async def test_a_flood_after_a_farewell_gets_no_second_one() -> None:
    page = await opened()
    await page.app.send({"type": "websocket.close", "code": 1000, "reason": "bye"})
    before = bytes(page.wire.written)
    await flooded(page)
    assert page.wire.written == before
    assert END not in page.heard
    assert [timer.after_s for timer in page.wired.timers.left][-1] == 1.0
    await page.leave()


async def test_a_farewell_in_the_midst_of_a_flood_resumes_reading_once() -> None:
    page = await opened()
    page.send(*"x" * (MOST_AT_ONCE + 1))
    await page.app.send({"type": "websocket.close", "code": 1000, "reason": "bye"})
    assert page.wire.reads
    await turns(2 * MOST_AT_ONCE)
    assert page.wire.reads
    await page.leave()


async def test_one_flood_ends_no_other_socket() -> None:
    app = App()
    wired = Wired(app, clock=VirtualClock(NOON))
    first, second = (Page(wired, app) for _ in range(2))
    await first.open()
    await second.open()
    await flooded(first)
    app.heard = [HELLO]
    second.send("a")
    await turns()
    assert second.heard == [received("a")]
    assert second.wire.written == b""
    assert first.socket._turnstile is second.socket._turnstile
    assert first.socket._turnstile is not Wired(app).socket(Wire())._turnstile
    await second.leave()
