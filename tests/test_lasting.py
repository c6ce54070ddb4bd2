"""A task that breaks begins again; one that ends or is cancelled does not."""

import asyncio
from datetime import timedelta

from app.base.clock import VirtualClock
from app.base.lasting import begun
from tests.captured_logs import capture_logs
from tests.fake_data import NOON
from tests.site.plant import settle


async def test_work_that_breaks_begins_again_a_second_later_and_ends_once_it_is_done() -> None:
    clock, times = VirtualClock(NOON), []

    async def work() -> None:
        times.append(clock.now() - NOON)
        if len(times) < 3:
            raise KeyError("unforeseen")

    with capture_logs() as logs:
        task = begun("a door", work, clock)
        for _ in range(5):
            await settle()
            clock.advance(timedelta(milliseconds=500))
    await task
    assert times == [timedelta(seconds=second) for second in (0, 1, 2)]
    assert [(line["event"], line["task"]) for line in logs] == [("task_broke", "a door")] * 2


async def test_work_that_is_cancelled_stays_cancelled() -> None:
    async def work() -> None:
        await asyncio.Event().wait()

    task = begun("a door", work, VirtualClock(NOON))
    await settle()
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
    assert task.cancelled()
