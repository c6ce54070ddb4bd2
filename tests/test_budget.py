"""How much a client may ask for, on a virtual clock."""

import asyncio
from datetime import UTC, datetime, timedelta

from app.base.budget import Budget
from app.base.clock import VirtualClock
from tests.patience import PATIENCE_S


def clock() -> VirtualClock:
    return VirtualClock(datetime(2027, 6, 21, 9, 40, tzinfo=UTC))


def spent(budget: Budget, most: int = 1000) -> int:
    return next(count for count in range(most) if not budget.spend())


def test_a_burst_is_allowed_and_then_the_pace() -> None:
    time = clock()
    budget = Budget(time, per_s=10.0, burst=5)
    assert spent(budget) == 5
    time.advance(timedelta(seconds=0.099))
    assert spent(budget) == 0
    time.advance(timedelta(seconds=0.001))
    assert spent(budget) == 1
    time.advance(timedelta(hours=1))
    assert spent(budget) == 5, "an hour of silence saves up no more than the burst"


async def test_who_waits_goes_on_when_the_next_one_is_allowed() -> None:
    time = clock()
    budget = Budget(time, per_s=10.0, burst=1)
    await budget.wait()
    waiting = asyncio.create_task(budget.wait())
    await asyncio.sleep(0)
    time.advance(timedelta(seconds=0.05))
    await asyncio.sleep(0)
    assert not waiting.done()
    time.advance(timedelta(seconds=0.05))
    await asyncio.wait_for(waiting, PATIENCE_S)
