"""The limit of lasting answers: who is counted, whose share it is, and what is answered beyond it."""

import asyncio
from typing import Any

import orjson
import pytest

from app.base.clock import SystemClock
from app.web.http.limits import MOST_ON_PLAIN_CONNECTIONS, MOST_STREAMS, MOST_STREAMS_A_CLIENT, StreamLimit
from app.web.http.server import MOST_A_CLIENT

LIVE, STREAM = "/live", "/api/v1/stream"
FAR, NEAR = "192.0.2.7", "127.0.0.1"


class Held:
    """An app whose answers last until it is let go, and what it was asked."""

    def __init__(self, **limits: int) -> None:
        self.asked: list[tuple[Any, Any, Any]] = []
        self.limit = StreamLimit(self._answer, clock=SystemClock(), **limits)
        self._begun, self._ends = asyncio.Event(), list[asyncio.Event]()
        self._open: list[asyncio.Task[None]] = []

    async def _answer(self, scope: Any, receive: Any, send: Any) -> None:
        self.asked.append((scope, receive, send))
        self._ends.append(asyncio.Event())
        self._begun.set()
        await self._ends[-1].wait()

    async def ask(self, path: str, client: str | None, kind: str = "http") -> list[dict[str, Any]]:
        """Ask once; return what was sent if it was refused, nothing while it lasts."""
        sent: list[dict[str, Any]] = []

        async def send(message: Any) -> None:
            sent.append(message)

        async def receive() -> dict[str, Any]:
            return {"type": "http.disconnect"}

        scope = {"type": kind, "path": path, "client": client and (client, 4321)}
        before = len(self.asked)
        task = asyncio.ensure_future(self.limit(scope, receive, send))
        begun = asyncio.ensure_future(self._begun.wait())
        await asyncio.wait({task, begun}, return_when=asyncio.FIRST_COMPLETED)
        self._begun.clear()
        begun.cancel()
        if len(self.asked) > before:
            assert self.asked[-1] == (scope, receive, send)
        self._open.append(task)
        return sent

    async def end_first(self) -> None:
        """Let the first answer end."""
        self._ends.pop(0).set()
        await self._open.pop(0)

    async def end(self) -> None:
        """Let every answer end."""
        for end in self._ends:
            end.set()
        await asyncio.gather(*self._open)
        self._ends.clear()


async def test_beyond_its_share_a_client_is_refused_with_503_and_a_reason() -> None:
    held = Held(most=10, most_a_client=2)
    assert [await held.ask(path, FAR) for path in (LIVE, STREAM)] == [[], []]
    start, body = await held.ask(STREAM, FAR)
    assert start == {
        "type": "http.response.start",
        "status": 503,
        "headers": [(b"content-type", b"application/problem+json"), (b"retry-after", b"5")],
    }
    assert body["type"] == "http.response.body"
    assert orjson.loads(body["body"]) == {
        "type": "/manual/reference/errors.html#too_many_connections",
        "code": "too_many_connections",
        "title": "Service Unavailable",
        "status": 503,
        "detail": "This device has too many live pages or streams open. Close some, then try again.",
    }
    assert len(held.asked) == 2
    await held.end()


async def test_streams_of_this_computer_leave_some_of_its_plain_connections_to_other_requests() -> None:
    held = Held(most=10, most_plain=2)
    assert [await held.ask(STREAM, NEAR) for _ in range(2)] == [[], []]
    start, _ = await held.ask(STREAM, NEAR)
    assert start["status"] == 503
    assert await held.ask(LIVE, NEAR, "websocket") == []
    await held.end()
    assert await held.ask(STREAM, NEAR) == []
    await held.end()


async def test_a_socket_beyond_the_share_is_closed_with_try_again_later() -> None:
    held = Held(most=10, most_a_client=1)
    assert await held.ask(LIVE, FAR, "websocket") == []
    assert await held.ask(LIVE, FAR, "websocket") == [
        {"type": "websocket.close", "code": 1013, "reason": "too many"}
    ]
    await held.end()


async def test_what_ended_makes_room_and_is_forgotten() -> None:
    held = Held(most=2, most_a_client=2)
    for _ in range(3):
        assert [await held.ask(LIVE, FAR) for _ in range(2)] == [[], []]
        assert await held.ask(LIVE, FAR) != []
        await held.end()
    assert not held.limit._open


@pytest.mark.parametrize("client", [NEAR, "::1"])
async def test_this_computer_is_bound_by_the_total_alone(client: str) -> None:
    held = Held(most=4, most_a_client=1)
    assert [await held.ask(LIVE, client) for _ in range(3)] == [[], [], []]
    assert await held.ask(LIVE, FAR) == []
    assert await held.ask(LIVE, "192.0.2.8") != [], "the total is of all clients together"
    assert await held.ask(LIVE, client) != []
    await held.end()


async def test_clients_without_an_address_share_one_share() -> None:
    held = Held(most=10, most_a_client=1)
    assert await held.ask(LIVE, None) == []
    assert await held.ask(LIVE, None) != []
    assert await held.ask(LIVE, FAR) == []
    assert await held.ask(LIVE, "XXXX") == []
    await held.end()


async def test_other_requests_pass_however_much_is_open() -> None:
    held = Held(most=1, most_a_client=1)
    assert await held.ask(LIVE, FAR) == []
    for path, kind in (("/stop", "http"), ("/", "http"), ("/stop", "websocket"), (LIVE, "lifespan")):
        assert await held.ask(path, FAR, kind) == []
    assert len(held.asked) == 5
    await held.end()


async def test_as_shipped_a_client_has_64_and_all_have_1024() -> None:
    assert (MOST_STREAMS_A_CLIENT, MOST_STREAMS) == (64, 1024)
    assert MOST_ON_PLAIN_CONNECTIONS + 64 == MOST_A_CLIENT
    held = Held()
    assert [await held.ask(LIVE, FAR) for _ in range(64)] == [[]] * 64
    assert await held.ask(LIVE, FAR) != []
    assert [await held.ask(LIVE, NEAR, "websocket") for _ in range(960)] == [[]] * 960
    assert await held.ask(LIVE, NEAR, "websocket") != []
    await held.end()


async def test_one_that_ends_makes_room_for_one_and_the_others_still_count() -> None:
    held = Held(most_a_client=2)
    assert [await held.ask(STREAM, FAR) for _ in range(2)] == [[], []]
    await held.end_first()
    assert await held.ask(STREAM, FAR) == []
    refused = await held.ask(STREAM, FAR)
    assert refused[0]["status"] == 503
    await held.end()
