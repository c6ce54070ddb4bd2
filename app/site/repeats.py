"""A repeated order is a no-op that answers as the first did; one too old or of the future is refused."""

import asyncio
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.link.messages import Order, StopAll
from app.tracker.commands import CommandRejected, EndJog, Stop
from app.tracker.reason import Reason
from app.tracker.snapshot import SiteSnapshot

MOST_REMEMBERED = 500
OLDEST_ORDER = MOST_AHEAD = timedelta(seconds=2)
ENDS_MOTION = Stop | StopAll | EndJog


@dataclass(frozen=True, slots=True)
class _Remembered:
    order: Order
    answer: asyncio.Future[SiteSnapshot]


class Repeats:
    """Remembers the last orders that carried a key, and what came of them."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, _Remembered] = OrderedDict()

    async def once(self, order: Order, carry_out: Callable[[Order], Awaitable[SiteSnapshot]]) -> SiteSnapshot:
        """Carry out an order, unless its key is known: then answer as then. A stop is never a repeat."""
        if order.key is None or isinstance(order.command, ENDS_MOTION):
            return await carry_out(order)
        known = self._known.get(order.key)
        if known is None:
            return await self._first(order.key, order, carry_out)
        if (known.order.command, known.order.tracker_id) != (order.command, order.tracker_id):
            raise CommandRejected(
                Reason(
                    "key_reused",
                    "This idempotency key was used for another command, so nothing was done.",
                    "Send it again with a new key.",
                )
            )
        return await asyncio.shield(known.answer)

    async def _first(
        self, key: str, order: Order, carry_out: Callable[[Order], Awaitable[SiteSnapshot]]
    ) -> SiteSnapshot:
        answer: asyncio.Future[SiteSnapshot] = asyncio.get_running_loop().create_future()
        self._known[key] = _Remembered(order, answer)
        if len(self._known) > MOST_REMEMBERED:
            self._known.popitem(last=False)
        try:
            snapshot = await carry_out(order)
        except BaseException as error:
            answer.set_exception(error if isinstance(error, Exception) else asyncio.CancelledError())
            answer.exception()
            raise
        answer.set_result(snapshot)
        return snapshot


def refuse_untimely(order: Order, now: datetime) -> None:
    """Raise `CommandRejected` for an order given more than 2 s ago or ahead; a stop is never untimely.

    One from the future tells that a clock is wrong: by that clock, an old order would look like a new one.
    """
    if order.issued_at is None or isinstance(order.command, ENDS_MOTION):
        return
    age = now - order.issued_at
    if age < -MOST_AHEAD:
        raise CommandRejected(
            Reason(
                "from_the_future",
                f"This command was given {-age.total_seconds():.1f} s ahead of the site's clock and is not "
                "carried out.",
                "Set the clock of the sender or of the site, then give it again.",
            )
        )
    if age > OLDEST_ORDER:
        raise CommandRejected(
            Reason(
                "too_old",
                f"This command was given {age.total_seconds():.1f} s ago and is not carried out any more.",
                "Look at the live values and give it again.",
            )
        )
