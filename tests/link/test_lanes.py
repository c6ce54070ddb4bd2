"""Lanes: one call a key, the next one for all who asked meanwhile, none later than 250 ms."""

import asyncio
import gc
from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.link.lanes import Lanes
from tests.fake_data import NOON


class Work:
    """Lanes, and the calls on them: each is answered when the test says so."""

    def __init__(self) -> None:
        self.clock = VirtualClock(NOON)
        self.lanes: Lanes[int] = Lanes(self.clock)
        self.answers: list[asyncio.Future[int]] = []

    async def call(self) -> int:
        answer: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self.answers.append(answer)
        return await answer

    async def asked(self, key: str | None = "T1") -> "asyncio.Task[int]":
        """Ask on a lane, and give everybody else a turn."""
        asked = asyncio.create_task(self.lanes.ask(key, self.call))
        await turns()
        return asked


async def turns() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


@pytest.fixture
def work() -> Work:
    return Work()


async def test_what_is_asked_meanwhile_is_done_by_one_call_that_begins_later(work: Work) -> None:
    first = await work.asked()
    meanwhile = [await work.asked() for _ in range(30)]
    assert (len(work.answers), len(work.lanes)) == (1, 2)

    work.answers[0].set_result(1)
    await turns()
    assert len(work.answers) == 2
    late = await work.asked()
    assert len(work.answers) == 2

    work.answers[1].set_result(2)
    assert await asyncio.gather(first, *meanwhile) == [1] + [2] * 30
    await turns()
    work.answers[2].set_result(3)
    assert await late == 3
    assert len(work.lanes) == 0


async def test_other_keys_wait_for_nothing(work: Work) -> None:
    waiting = [await work.asked(key) for key in ("T1", "T2", None)]
    assert len(work.answers) == 3
    for answer in work.answers:
        answer.set_result(0)
    await asyncio.gather(*waiting)


async def test_the_next_call_waits_a_quarter_of_a_second_for_an_answer_and_no_longer(work: Work) -> None:
    waiting = [await work.asked(), await work.asked()]
    work.clock.advance(timedelta(milliseconds=249))
    await turns()
    assert len(work.answers) == 1
    work.clock.advance(timedelta(milliseconds=1))
    await turns()
    assert len(work.answers) == 2
    for answer in work.answers:
        answer.set_result(0)
    await asyncio.gather(*waiting)
    assert len(work.lanes) == 0


async def test_a_call_that_fails_tells_who_asked_and_the_next_one_is_made(work: Work) -> None:
    first, second = await work.asked(), await work.asked()
    work.answers[0].set_exception(OSError("no drive"))
    with pytest.raises(OSError, match="no drive"):
        await first
    await turns()
    work.answers[1].set_result(2)
    assert await second == 2


async def test_who_leaves_does_not_end_the_call(work: Work) -> None:
    leaving = await work.asked()
    leaving.cancel()
    await turns()
    assert leaving.cancelled()
    assert len(work.lanes) == 1
    work.answers[0].set_result(1)
    await turns()
    assert len(work.lanes) == 0


async def test_only_a_call_that_has_not_begun_yet_waits(work: Work) -> None:
    asked = [await work.asked()]
    assert not work.lanes.waits("T1")
    asked.append(await work.asked())
    assert work.lanes.waits("T1")
    assert not work.lanes.waits("T2")
    for answer in (0, 1):
        work.answers[answer].set_result(answer)
        await turns()
    assert not work.lanes.waits("T1")
    assert await asyncio.gather(*asked) == [0, 1]


async def test_nobody_is_told_of_an_error_that_nobody_waits_for(work: Work) -> None:
    """Whoever asked has gone: the loop's own complaint about it would be the only trace."""
    complaints: list[object] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: complaints.append(context))
    for end in (OSError("no drive"), None):
        leaving = await work.asked()
        leaving.cancel()
        await turns()
        answer = work.answers.pop()
        if end is None:
            answer.cancel()
        else:
            answer.set_exception(end)
        del answer, leaving
        await turns()
        gc.collect()
    assert complaints == []
    assert len(work.lanes) == 0
