"""A door at which a control system asks again and again: what is refused is journalled once."""

from collections import OrderedDict
from collections.abc import AsyncIterator
from datetime import datetime, timedelta

from app.alarms.conditions import Condition
from app.base.clock import is_within
from app.gateway.ports import Door
from app.link.messages import Order, SiteDetail, Update
from app.tracker.state.snapshot import Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.notifications import Notifications

TELL_AGAIN = timedelta(minutes=1)
MOST_REMEMBERED = 500


class QuietDoor:
    """Passes everything on but refusals that were the same within the last minute."""

    def __init__(self, door: Door) -> None:
        self._door = door
        self._refused: OrderedDict[tuple[str | None, str, str], datetime] = OrderedDict()

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order."""
        return await self._door.execute(order)

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities."""
        return await self._door.detail()

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now, with what may be asked of it."""
        return await self._door.tracker(tracker_id)

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        """Have snapshots of these trackers told with their actions."""
        await self._door.watch(tracker_ids)

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot."""
        return self._door.latest()

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the machine ends."""
        return self._door.updates()

    def trouble(self, name: str, condition: Condition | None) -> None:
        """Note a condition that is for the alarms, or with None that it is over."""
        self._door.trouble(name, condition)

    @property
    def notifications(self) -> Notifications:
        """Return where alarms are to be sent."""
        return self._door.notifications

    def note(self, *events: Event) -> None:
        """Journal and tell what happened at this door, repeated refusals aside."""
        fresh = [event for event in events if self._is_new(event)]
        if fresh:
            self._door.note(*fresh)

    def _is_new(self, event: Event) -> bool:
        if event.kind is not EventKind.REMOTE_REFUSED:
            return True
        key = (event.tracker_id, event.actor, event.message)
        last = self._refused.pop(key, None)
        self._refused[key] = event.at
        if len(self._refused) > MOST_REMEMBERED:
            self._refused.popitem(last=False)
        return last is None or not is_within(last, event.at, TELL_AGAIN)
