"""From a request to one order of the machine."""

from contextlib import suppress
from dataclasses import replace
from typing import Annotated

from fastapi import Depends, Header

from app.base.instants import Instant
from app.base.message import told_by
from app.link.messages import Machine, SiteCommand, UnknownTracker
from app.tracker.commands.commands import Command
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.web.api.base import IssuedAt
from app.web.http.errors import NotAcceptable
from app.web.shell.deps import MachineDep, PrincipalDep, order_of

Key = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        min_length=1,
        max_length=64,
        description="A repeated request with the same key is answered as the first was, and done once; "
        "with another command it is refused with 409.",
    ),
]
Epoch = Annotated[
    int | None,
    Header(
        alias="Control-Epoch",
        ge=0,
        le=2**53,
        description="The `epoch` of control that this order is given under; when control has changed since, "
        "the order is refused with 423.",
    ),
]


class Sender:
    """Gives the machine one order, with what the request says about repeats and age."""

    def __init__(
        self,
        machine: MachineDep,
        who: PrincipalDep,
        key: Key = None,
        issued_at: IssuedAt = None,
        epoch: Epoch = None,
    ) -> None:
        self._machine: Machine = machine
        self._who = who
        self._key = key
        self._issued_at = issued_at
        self._epoch = epoch

    async def send(
        self,
        command: Command | SiteCommand,
        tracker_id: str | None = None,
        issued_at: Instant | None = None,
    ) -> SiteSnapshot:
        """Carry out a command and return the site after it; what cannot be is a 422."""
        try:
            at = issued_at or self._issued_at
            order = order_of(self._who, command, tracker_id, self._key, at, self._epoch)
            return await self._machine.execute(order)
        except ValueError as error:
            raise NotAcceptable(told_by(error)) from error

    async def command(self, tracker_id: str, command: Command, issued_at: Instant | None = None) -> Snapshot:
        """Carry out a tracker's command and return the tracker after it, with what is allowed then."""
        became = tracker_of(await self.send(command, tracker_id, issued_at), tracker_id)
        if not became.actions:
            with suppress(UnknownTracker):
                became = await self._machine.tracker(tracker_id)
        return became


SenderDep = Annotated[Sender, Depends()]


def tracker_of(site: SiteSnapshot, tracker_id: str) -> Snapshot:
    """Return one tracker of the site, or raise `UnknownTracker`."""
    for snapshot in site.trackers:
        if snapshot.tracker_id == tracker_id:
            return snapshot
    raise UnknownTracker(tracker_id)


def listed(site: SiteSnapshot) -> SiteSnapshot:
    """Return a site as lists tell it: what is allowed now is told of one tracker, to who asks for it."""
    trackers = tuple(replace(one, actions={}) if one.actions else one for one in site.trackers)
    return replace(site, trackers=trackers)
