"""The live socket over a real connection: how much it takes, and how it is closed beyond that."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from datetime import timedelta

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from app.base.clock import VirtualClock
from app.link.messages import Order
from app.tracker.commands.commands import Stop
from tests.fake_data import NOON
from tests.fakes import FakeMachine
from tests.patience import PATIENCE_S
from tests.web.test_server import Connections, serving

PING = json.dumps({"type": "ping", "tc": 1.0})
STOP = json.dumps({"type": "stop", "tracker_id": "T1"})


@contextlib.asynccontextmanager
async def live_page(
    clock: VirtualClock, machine: FakeMachine | None = None
) -> AsyncIterator[ClientConnection]:
    served = serving(Connections(100), 5.0, clock, machine)
    async with served as (_, port), connect(f"ws://127.0.0.1:{port}/live", ping_interval=None) as page:
        yield page


async def pongs(page: ClientConnection, count: int) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while count:
            count -= json.loads(await page.recv())["type"] == "pong"


async def closed(page: ClientConnection) -> tuple[int, str]:
    async with asyncio.timeout(PATIENCE_S):
        with contextlib.suppress(ConnectionClosed):
            while True:
                await page.recv()
    assert page.protocol.close_rcvd is not None
    return page.protocol.close_rcvd.code, page.protocol.close_rcvd.reason


@pytest.mark.fault(93)
async def test_256_messages_at_once_are_taken_and_64_a_second_after_them() -> None:
    clock = VirtualClock(NOON)
    async with live_page(clock) as page:
        for _ in range(256):
            await page.send(PING)
        await pongs(page, 256)
        clock.advance(timedelta(seconds=1))
        for _ in range(64):
            await page.send(PING)
        await pongs(page, 64)
        await page.send(PING)
        assert await closed(page) == (4029, "This page sent more messages than Heliopanel accepts.")


@pytest.mark.fault(93)
async def test_control_frames_count_too() -> None:
    async with live_page(VirtualClock(NOON)) as page:
        with contextlib.suppress(ConnectionClosed):
            for _ in range(300):
                await page.pong(b"")
        assert (await closed(page))[0] == 4029


@pytest.mark.fault(93)
async def test_a_stop_before_the_flood_is_obeyed_once_and_a_long_message_is_one(
    machine: FakeMachine,
) -> None:
    async with live_page(VirtualClock(NOON), machine) as page:
        await page.send(" " * 15_000 + STOP)
        for _ in range(3000):
            with contextlib.suppress(ConnectionClosed):
                await page.send(STOP)
        assert (await closed(page))[0] == 4029
    given: list[Order] = [order for order in machine.orders if order.command == Stop()]
    assert 1 <= len(given) <= 256
