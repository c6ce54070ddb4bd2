"""Authority over one tracker, pure: who has it, who wants it, and how it passes; instants are steady time."""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from enum import Enum, auto

from app.base.message import N_, join, say
from app.tracker.commands.commands import CommandRejected
from app.tracker.commands.control import (
    CONTROL_HELD,
    CONTROL_LOST,
    ControlHeld,
    ControlLost,
    ControlRequest,
    ControlState,
    Holder,
)
from app.tracker.values.reason import Reason

LEASE = timedelta(seconds=15)
COUNTDOWN = timedelta(seconds=10)
ASK_LASTS = timedelta(seconds=60)
SILENT_AFTER = timedelta(seconds=5)


@dataclass(frozen=True, slots=True)
class Lease:
    """Control that somebody has; it ends when they are not heard for `LEASE`."""

    holder: Holder
    since: datetime
    heard_at: datetime


@dataclass(frozen=True, slots=True)
class Wish:
    """Somebody wants control: `takes` it at `until` unless refused, or asks until then."""

    by: Holder
    takes: bool
    reason: str
    until: datetime


@dataclass(frozen=True, slots=True)
class Authority:
    """Who has control of one tracker.

    `epoch` fences orders: one of an older epoch is refused. `basis` is the epoch that was free when the
    holder took control by the very order that moved: what they ordered at that moment carries that number.
    """

    epoch: int
    lease: Lease | None = None
    wish: Wish | None = None
    basis: int | None = None

    @property
    def holder(self) -> Holder | None:
        """Return who has control."""
        return None if self.lease is None else self.lease.holder

    def is_held_by(self, who: Holder) -> bool:
        """Return whether this person or program has control."""
        return self.lease is not None and self.lease.holder.is_same(who)


class Verdict(Enum):
    """What an order for motion may do: go, or go after control is taken for it."""

    GO = auto()
    TAKE = auto()


class Due(Enum):
    """What time has brought about."""

    EXPIRED = auto()
    PASSES = auto()
    LAPSED = auto()


def judge(authority: Authority, who: Holder, epoch: int | None, now: datetime, name: str) -> Verdict:
    """Return what an order for motion may do, or raise `ControlHeld` or `ControlLost`.

    `epoch` is the one that the order was given under, None for a program that does not say; `name` is the
    tracker's. Control whose lease has run out is free, under the next epoch.
    """
    authority = without_expired(authority, now)
    if epoch is not None and epoch not in (authority.epoch, authority.basis):
        raise ControlLost(_lost(authority, name))
    if authority.lease is None:
        return Verdict.TAKE
    if not authority.is_held_by(who):
        raise ControlHeld(held(authority.lease.holder, who, name))
    return Verdict.GO


def is_silent(lease: Lease, now: datetime) -> bool:
    """Return whether the holder has not been heard for 5 s."""
    return now - lease.heard_at > SILENT_AFTER


def without_expired(authority: Authority, now: datetime) -> Authority:
    """Return the authority with control free if its lease has run out; a wish stays."""
    if authority.lease is None or now - authority.lease.heard_at < LEASE:
        return authority
    return Authority(authority.epoch + 1, wish=authority.wish)


def take(authority: Authority, who: Holder, now: datetime, *, by_order: bool = False) -> Authority:
    """Return the authority after somebody took control, under the next epoch."""
    basis = authority.epoch if by_order else None
    return Authority(authority.epoch + 1, Lease(who, now, now), basis=basis)


def renew(authority: Authority, who: Holder, now: datetime) -> Authority:
    """Return the authority with the lease begun anew; unchanged where somebody else has it."""
    if authority.lease is None or not authority.is_held_by(who):
        return authority
    return replace(authority, lease=replace(authority.lease, heard_at=now))


def release(authority: Authority) -> Authority:
    """Return the authority after its holder let go: nobody has control, under the next epoch."""
    return Authority(authority.epoch + 1)


def passes_at_once(authority: Authority, who: Holder) -> bool:
    """Return whether control needs nobody's consent: nobody has it, or a person takes it from a program."""
    holder = authority.holder
    return holder is None or (who.is_person and not holder.is_person)


def want(authority: Authority, wish: Wish, name: str) -> Authority:
    """Return the authority with a wish, or raise `ControlHeld` if another wish or the rank forbids it.

    The same person may turn asking into taking; a wish of more weight puts aside one of less.
    """
    holder, other = authority.holder, authority.wish
    if other is not None and not other.by.is_same(wish.by) and other.by.weight >= wish.by.weight:
        raise ControlHeld(_other_wish(other, name))
    if holder is not None and wish.takes and wish.by.weight < holder.weight:
        raise ControlHeld(_too_low(holder, name))
    if other is not None and other.by.is_same(wish.by) and other.takes:
        return authority
    return replace(authority, wish=wish)


def refuse(authority: Authority, now: datetime) -> Authority:
    """Return the authority without the wish that its holder refuses, or raise `CommandRejected`."""
    lease, wish = authority.lease, authority.wish
    if lease is None or wish is None:
        raise CommandRejected(NO_WISH)
    if not can_be_refused(lease, wish, now):
        raise CommandRejected(_not_refusable(wish))
    return replace(authority, wish=None)


def can_be_refused(lease: Lease, wish: Wish, now: datetime) -> bool:
    """Return whether the holder may keep control: who asks can be refused, who takes it by rank cannot."""
    return not wish.takes or (wish.by.weight <= lease.holder.weight and not is_silent(lease, now))


def due(authority: Authority, now: datetime) -> Due | None:
    """Return what time has brought about and is to be carried out now."""
    if authority.wish is not None and now >= authority.wish.until:
        return Due.PASSES if authority.wish.takes else Due.LAPSED
    expired = authority.lease is not None and now - authority.lease.heard_at >= LEASE
    return Due.EXPIRED if expired else None


def control_state(authority: Authority, now: datetime, site_time: datetime) -> ControlState:
    """Return what everyone sees, in site time; `now` is the steady time of the same instant."""
    lease = authority.lease
    if lease is None:
        return ControlState(authority.epoch)
    shift = site_time - now
    return ControlState(
        epoch=authority.epoch,
        holder=lease.holder.name,
        via=lease.holder.via,
        rank=lease.holder.weight,
        is_program=not lease.holder.is_person,
        since=lease.since + shift,
        expires=lease.heard_at + LEASE + shift,
        is_silent=is_silent(lease, now),
        request=_request(lease, authority.wish, now, shift),
    )


def _request(lease: Lease, wish: Wish | None, now: datetime, shift: timedelta) -> ControlRequest | None:
    if wish is None:
        return None
    refusable = can_be_refused(lease, wish, now)
    return ControlRequest(wish.by.name, wish.by.via, wish.takes, wish.reason, wish.until + shift, refusable)


def held(holder: Holder, who: Holder, name: str) -> Reason:
    """Return why somebody's order is refused, and how they come to have control."""
    ask = N_("Request control at the top of the page, or take control there with a reason.")
    if not who.is_person:
        ask = N_("Request control (POST .../control), or wait until it is released.")
    elif who.weight < holder.weight:
        ask = N_("Request control at the top of the page and wait until it is handed over.")
    return Reason(CONTROL_HELD, say("{name} has control of {name2}.", name=holder.name, name2=name), ask)


def _lost(authority: Authority, name: str) -> Reason:
    lost = say(
        "This command was given before control of {name} changed, and is no longer carried out.", name=name
    )
    if authority.holder is not None:
        lost = join(" ", (lost, say("{name} has control now.", name=authority.holder.name)))
    return Reason(
        CONTROL_LOST,
        lost,
        N_("Check who has control and the state of the tracker, then send the command again."),
    )


def _too_low(holder: Holder, name: str) -> Reason:
    return Reason(
        CONTROL_HELD,
        say("{name} has control of {name2} and has the higher role.", name=holder.name, name2=name),
        N_("Request control instead of taking it."),
    )


def _other_wish(other: Wish, name: str) -> Reason:
    return Reason(
        CONTROL_HELD,
        say("{name} has already requested control of {name2}.", name=other.by.name, name2=name),
        N_("Wait for the decision, then request control again."),
    )


def _not_refusable(wish: Wish) -> Reason:
    return Reason(
        "cannot_refuse",
        say(
            "{name} takes control because of a higher role, or because you sent no signal.", name=wish.by.name
        ),
        N_("You cannot decline this: hand over control, or let the countdown end."),
    )


NO_WISH = Reason(
    "no_wish", N_("There is no request for control of this tracker."), N_("No answer is needed.")
)
