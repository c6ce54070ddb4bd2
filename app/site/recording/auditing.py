"""Who ordered what, and what came of it: one audit entry an order, in the transaction of what it changes."""

import asyncio
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import Any

from pydantic_core import to_jsonable_python

from app.audit.entry import Entry, told
from app.base.clock import is_within
from app.base.logs import get_logger
from app.base.message import say, told_by
from app.link.messages import Order
from app.site.clock.timekeeping import Timekeeper
from app.store.store import AuditFilter, Reader

LEFT_OUT = {"kind", "chunks"}
SAME_WITHIN = timedelta(seconds=2)
CYCLIC, CYCLE_WITHIN = "sunspec", timedelta(minutes=1)
"""A control system writes the same every few seconds; a refusal is recorded once while it does."""
MOST_REMEMBERED = 100
HEAD_EVERY = timedelta(minutes=10)

log = get_logger()


@dataclass(slots=True)
class InHand:
    """The order that is being carried out: its entry, and whether that is on its way to the disk."""

    entry: Entry
    written: bool = False
    over: bool = False


IN_HAND: ContextVar[InHand | None] = ContextVar("order_in_hand", default=None)
"""The order that the running task carries out; what it stores is recorded as that order's."""


@contextmanager
def as_action(action: str) -> Iterator[None]:
    """Have what the order in hand stores inside recorded as an action of its own, if it changes anything."""
    in_hand = IN_HAND.get()
    if in_hand is None:
        yield
        return
    inner = InHand(replace(in_hand.entry, action=action, given="{}"), written=True)
    before = IN_HAND.set(inner)
    try:
        yield
    finally:
        inner.over = True
        IN_HAND.reset(before)


class Auditor:
    """Makes the entry of each order; the ledger writes it with what the order changes.

    `post` has an entry written that nothing was changed for: a refusal, or an order that changes nothing.
    """

    def __init__(self, boot_id: str, timekeeper: Timekeeper, post: Callable[[Entry], None]) -> None:
        self._boot_id = boot_id
        self._timekeeper = timekeeper
        self._post = post
        self._refused: OrderedDict[tuple[object, ...], datetime] = OrderedDict()
        self._head_at: datetime | None = None

    @contextmanager
    def recording(self, order: Order) -> Iterator[None]:
        """Have an order recorded that is carried out inside, whether it is obeyed or refused."""
        spec = order.command.spec
        if not spec.audited:
            yield
            return
        in_hand = InHand(self._entry(order))
        before = IN_HAND.set(in_hand)
        try:
            yield
        except Exception as error:
            self._refuse(order, in_hand.entry, error)
            raise
        finally:
            in_hand.over = True
            IN_HAND.reset(before)
        if not in_hand.written and not spec.held:
            self._post(in_hand.entry)

    def head_is_due(self, now: datetime) -> bool:
        """Return whether the last entry's hash is to be logged again, which is so every ten minutes."""
        if self._head_at is not None and now - self._head_at < HEAD_EVERY:
            return False
        self._head_at = now
        return True

    def _entry(self, order: Order) -> Entry:
        now = self._timekeeper.now()
        return Entry(
            utc=now,
            mono_ms=int(asyncio.get_running_loop().time() * 1000),
            boot_id=self._boot_id,
            clock_quality=self._quality(),
            actor=order.actor,
            via=order.via,
            address=order.address,
            action=order.command.kind,
            object=addressed(order),
            given=told(given(order)),
        )

    def _quality(self) -> str:
        state = self._timekeeper.state()
        if state.reasons:
            return state.reasons[0].code
        return "synchronised" if state.ntp_synchronised else "trusted"

    def _refuse(self, order: Order, entry: Entry, error: Exception) -> None:
        refused = replace(
            entry,
            result=say("refused: {error}", error=told_by(error))
            if str(error)
            else say("failed: {name}", name=type(error).__name__),
        )
        within = SAME_WITHIN if order.command.spec.held else CYCLE_WITHIN
        if (within is SAME_WITHIN or order.via == CYCLIC) and self._is_repeated(refused, within):
            return
        self._post(refused)

    def _is_repeated(self, refused: Entry, within: timedelta) -> bool:
        """Return whether the same was refused to the same sender just now: a held key, a cyclic write."""
        key = (refused.actor, refused.address, refused.object, refused.result)
        last = self._refused.get(key)
        self._refused[key] = refused.utc
        self._refused.move_to_end(key)
        if len(self._refused) > MOST_REMEMBERED:
            self._refused.popitem(last=False)
        return last is not None and is_within(last, refused.utc, within)


def given(order: Order) -> dict[str, Any]:
    """Return an order's arguments as plain data."""
    values = to_jsonable_python(order.command)
    return {name: value for name, value in values.items() if name not in LEFT_OUT}


def addressed(order: Order) -> str:
    """Return what an order is about: a tracker, a recording, or the site."""
    if order.tracker_id is not None:
        return order.tracker_id
    command: Any = order.command
    about = getattr(command, "config", None) or getattr(command, "info", None) or command
    return str(getattr(about, "tracker_id", None) or getattr(about, "recording_id", None) or "site")


def log_head(store: Reader) -> None:
    """Log the last entry's number and hash: who can write the database cannot change them there."""
    for last in store.audit(AuditFilter(limit=1)):
        log.info("audit_head", seq=last.seq, hash=last.hash)
