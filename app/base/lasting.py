"""Tasks that last: an error nobody foresaw is logged, and the work begins again."""

import asyncio
from collections.abc import Awaitable, Callable
from datetime import timedelta

from app.base.clock import Clock
from app.base.logs import get_logger

AGAIN_AFTER = timedelta(seconds=1)

log = get_logger()


async def lasting(name: str, work: Callable[[], Awaitable[None]], clock: Clock) -> None:
    """Do this until it ends by itself or is cancelled; after a mistake again, a second later."""
    while True:
        try:
            await work()
        except Exception:
            log.exception("task_broke", task=name, action="it begins again")
            await clock.sleep_until(clock.now() + AGAIN_AFTER)
        else:
            return


def begun(name: str, work: Callable[[], Awaitable[None]], clock: Clock) -> "asyncio.Task[None]":
    """Begin such a task."""
    return asyncio.create_task(lasting(name, work, clock), name=name)
