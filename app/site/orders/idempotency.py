"""A repeated order is a no-op that answers as the first did; one out of its time is refused."""

import asyncio
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.base.message import N_, say, with_format
from app.link.messages import Order
from app.tracker.commands.commands import Command, CommandRejected
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.order_spec import Motion
from app.tracker.values.reason import Reason

MOST_REMEMBERED = 500
OLDEST_ORDER = MOST_AHEAD = timedelta(seconds=2)


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
        if order.key is None or order.command.spec.ends_motion:
            return await carry_out(order)
        known = self._known.get(order.key)
        if known is None:
            return await self._first(order.key, order, carry_out)
        if (known.order.command, known.order.tracker_id) != (order.command, order.tracker_id):
            raise CommandRejected(
                Reason(
                    "key_reused",
                    N_("This idempotency key was used for another command; nothing was done."),
                    N_("Send the command again with a new key."),
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


class Overtaken:
    """Remembers when each tracker was stopped last: what was given before that moves it no more.

    A stop overtakes orders on the link, and orders that wait for control; none of them may undo it. Instants
    are on the monotonic counter of the computer, which panel and controller share.
    """

    def __init__(self) -> None:
        self._stopped_s: dict[str, float] = {}

    def stopped(self, given_s: float, tracker_ids: Iterable[str]) -> None:
        """Note a stop of these trackers."""
        for name in tracker_ids:
            self._stopped_s[name] = max(given_s, self._stopped_s.get(name, given_s))

    def refuse(self, command: Command, tracker: TrackerConfig, given_s: float) -> None:
        """Raise `CommandRejected` for a motion that was ordered before its tracker was stopped."""
        stopped_s = self._stopped_s.get(tracker.tracker_id, given_s)
        if command.spec.motion is Motion.BEGINS and given_s < stopped_s:
            raise CommandRejected(
                Reason(
                    "stopped_since",
                    (
                        say(
                            "{name} was stopped after this command was given, so the command is not "
                            "carried out.",
                            name=tracker.name,
                        )
                    ),
                    N_("Check the live values and send the command again."),
                )
            )


def refuse_untimely(order: Order, now: datetime) -> None:
    """Raise `CommandRejected` for an order given more than 2 s ago or ahead; a stop is never untimely.

    One from the future tells that a clock is wrong: by that clock, an old order would look like a new one.
    """
    if order.issued_at is None or order.command.spec.ends_motion:
        return
    age = now - order.issued_at
    if age < -MOST_AHEAD:
        raise CommandRejected(
            Reason(
                "from_the_future",
                say(
                    "This command is dated {total_seconds} s ahead of the site's clock and is not "
                    "carried out.",
                    total_seconds=with_format(-age.total_seconds(), ".1f"),
                ),
                N_("Set the clock of the sender or of the site, then send the command again."),
            )
        )
    if age > OLDEST_ORDER:
        raise CommandRejected(
            Reason(
                "too_old",
                say(
                    "This command was given {total_seconds} s ago and is no longer carried out.",
                    total_seconds=with_format(age.total_seconds(), ".1f"),
                ),
                N_("Check the live values and send the command again."),
            )
        )
