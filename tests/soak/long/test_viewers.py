"""An hour on the real clock with 100 pages open: the machine ticks on time, whoever watches."""

import asyncio
import os
from pathlib import Path

import pytest
from websockets import Origin
from websockets.asyncio.client import connect

from tests.machine.field import Punctuality
from tests.machine.service import Service

VIEWERS = 100
WATCHED_S = float(os.environ.get("HELIOPANEL_TEST_WATCHED_S", "3600"))
LATEST_MS = 10.0


async def watch(port: int, until: float) -> int:
    """Be an open page until an instant of the loop; return how many messages came."""
    messages = 0
    origin = Origin(f"http://127.0.0.1:{port}")
    async with connect(f"ws://127.0.0.1:{port}/live", origin=origin, open_timeout=60) as page:
        try:
            async with asyncio.timeout_at(until):
                async for _ in page:
                    messages += 1
        except TimeoutError:
            return messages
    raise AssertionError("The panel closed a page.")


@pytest.mark.timeout(WATCHED_S + 300)
async def test_ticks_come_on_time_while_100_pages_are_open(tmp_path: Path) -> None:
    service = await Service.start(tmp_path / "data")
    try:
        await service.commission()
        await service.track()
        before = await service.link.metrics()
        until = asyncio.get_running_loop().time() + WATCHED_S
        messages = await asyncio.gather(*(watch(service.port, until) for _ in range(VIEWERS)))
        after = await service.link.metrics()
    finally:
        await service.stop()
    found = Punctuality.between(before, after)
    print(f"{found}, {sum(messages)} messages to {VIEWERS} pages")
    assert min(messages) > WATCHED_S
    assert found.ticks > WATCHED_S * 9.5
    assert found.p999_ms <= LATEST_MS
