"""Lanes: one call a key, the next one for all who asked meanwhile, none later than 250 ms."""

import asyncio
import gc
from collections.abc import Callable, Coroutine
from datetime import timedelta
from typing import Any

import pytest

from app.base.clock import VirtualClock
from app.link.lanes import Lanes
from tests.fake_data import NOON


class Work:
    """Counts its calls; each is answered when the test says so."""

    def __init__(self) -> None:
        self.begun = 0
        self.answers: list[asyncio.Future[int]] = []

    async def __call__(self) -> int:
        self.begun += 1
        answer: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self.answers.append(answer)
        return await answer

    @property
    def do(self) -> Callable[[], Coroutine[Any, Any, int]]:
        return self.__call__


async def turns() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


async def test_what_is_asked_meanwhile_is_done_by_one_call_that_begins_later() -> None:
    lanes: Lanes[int] = Lanes(VirtualClock(NOON))
    work = Work()
    first = asyncio.create_task(lanes.ask("T1", work.do))
    await turns()
    meanwhile = [asyncio.create_task(lanes.ask("T1", work.do)) for _ in range(3000)]
    await turns()
    assert work.begun == 1
    assert len(lanes) == 2

    work.answers[0].set_result(1)
    await turns()
    assert work.begun == 2
    late = asyncio.create_task(lanes.ask("T1", work.do))
    await turns()
    assert work.begun == 2

    work.answers[1].set_result(2)
    assert await asyncio.gather(first, *meanwhile) == [1] + [2] * 3000
    await turns()
    work.answers[2].set_result(3)
    assert await late == 3
    assert len(lanes) == 0


async def test_other_keys_wait_for_nothing() -> None:
    lanes: Lanes[int] = Lanes(VirtualClock(NOON))
    work = Work()
    waiting = [asyncio.create_task(lanes.ask(name, work.do)) for name in ("T1", "T2", None)]
    await turns()
    assert work.begun == 3
    for answer in work.answers:
        answer.set_result(0)
    await asyncio.gather(*waiting)


async def test_the_next_call_waits_a_quarter_of_a_second_for_an_answer_and_no_longer() -> None:
    clock = VirtualClock(NOON)
    lanes: Lanes[int] = Lanes(clock)
    work = Work()
    waiting = [asyncio.create_task(lanes.ask("T1", work.do))]
    await turns()
    waiting.append(asyncio.create_task(lanes.ask("T1", work.do)))
    await turns()
    clock.advance(timedelta(milliseconds=249))
    await turns()
    assert work.begun == 1
    clock.advance(timedelta(milliseconds=1))
    await turns()
    assert work.begun == 2
    for answer in work.answers:
        answer.set_result(0)
    await asyncio.gather(*waiting)
    assert len(lanes) == 0


async def test_a_call_that_fails_tells_who_asked_and_the_next_one_is_made() -> None:
    lanes: Lanes[int] = Lanes(VirtualClock(NOON))
    work = Work()
    first = asyncio.create_task(lanes.ask("T1", work.do))
    await turns()
    second = asyncio.create_task(lanes.ask("T1", work.do))
    await turns()
    work.answers[0].set_exception(OSError("no drive"))
    with pytest.raises(OSError, match="no drive"):
        await first
    await turns()
    work.answers[1].set_result(2)
    assert await second == 2


async def test_who_leaves_does_not_end_the_call() -> None:
    lanes: Lanes[int] = Lanes(VirtualClock(NOON))
    work = Work()
    leaving = asyncio.create_task(lanes.ask("T1", work.do))
    await turns()
    leaving.cancel()
    await turns()
    assert leaving.cancelled()
    assert len(lanes) == 1
    work.answers[0].set_result(1)
    await turns()
    assert len(lanes) == 0


async def test_only_a_call_that_has_not_begun_yet_waits() -> None:
    lanes: Lanes[int] = Lanes(VirtualClock(NOON))
    work = Work()
    asked = [asyncio.create_task(lanes.ask("T1", work.do)) for _ in range(1)]
    await turns()
    assert not lanes.waits("T1")
    asked.append(asyncio.create_task(lanes.ask("T1", work.do)))
    await turns()
    assert lanes.waits("T1")
    assert not lanes.waits("T2")
    for answer in (0, 1):
        work.answers[answer].set_result(answer)
        await turns()
    assert not lanes.waits("T1")
    assert await asyncio.gather(*asked) == [0, 1]


async def test_nobody_is_told_of_an_error_that_nobody_waits_for() -> None:
    """Whoever asked has gone: the loop's own complaint about it would be the only trace."""
    complaints: list[object] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: complaints.append(context))
    lanes: Lanes[int] = Lanes(VirtualClock(NOON))
    for end in (OSError("no drive"), asyncio.CancelledError()):
        work = Work()
        leaving = asyncio.create_task(lanes.ask("T1", work.do))
        await turns()
        leaving.cancel()
        await turns()
        if isinstance(end, OSError):
            work.answers[0].set_exception(end)
        else:
            work.answers[0].cancel()
        del work, leaving
        await turns()
        gc.collect()
    assert complaints == []
    assert len(lanes) == 0
