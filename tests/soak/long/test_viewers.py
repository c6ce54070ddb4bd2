"""An hour on the real clock with 100 pages open: the machine ticks on time, whoever watches."""

import asyncio
import os
from itertools import accumulate
from pathlib import Path

import pytest
from websockets import Origin
from websockets.asyncio.client import connect

from app.link.metrics import LATENESS_BOUNDS_MS
from tests.machine.service import Service

VIEWERS = 100
WATCHED_S = float(os.environ.get("HELIOPANEL_TEST_WATCHED_S", "3600"))
ON_TIME = 0.999
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


def percentile_ms(counts: tuple[int, ...], share: float) -> float:
    """Return the bound below which so many of the ticks began, milliseconds after their time."""
    wanted = share * sum(counts)
    bounds = (*LATENESS_BOUNDS_MS, float("inf"))
    return next(bound for bound, count in zip(bounds, accumulate(counts), strict=True) if count >= wanted)


@pytest.mark.timeout(WATCHED_S + 300)
async def test_ticks_come_on_time_while_100_pages_are_open(tmp_path: Path) -> None:
    service = await Service.start(tmp_path / "data")
    try:
        await service.commission()
        await service.track()
        before = (await service.link.metrics()).trackers["T1"]
        until = asyncio.get_running_loop().time() + WATCHED_S
        messages = await asyncio.gather(*(watch(service.port, until) for _ in range(VIEWERS)))
        after = (await service.link.metrics()).trackers["T1"]
    finally:
        await service.stop()
    late = tuple(b - a for a, b in zip(before.lateness_counts, after.lateness_counts, strict=True))
    found_ms = percentile_ms(late, ON_TIME)
    print(f"{sum(late)} ticks, p99.9 at most {found_ms} ms, {sum(messages)} messages to {VIEWERS} pages")
    assert min(messages) > WATCHED_S
    assert sum(late) > WATCHED_S * 9.5
    assert found_ms <= LATEST_MS
