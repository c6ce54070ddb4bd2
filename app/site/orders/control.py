"""Control authority carried out: judged before every motion, stored before it counts, journalled, told."""

from collections.abc import Sequence
from contextlib import AsyncExitStack
from dataclasses import replace
from datetime import timedelta

from app.base.logs import get_logger
from app.base.message import N_, Message, join, say
from app.base.names import clean
from app.link.messages import AnswerControl, Order, ReleaseControl, RenewControl, RequestControl
from app.site.loop.loop import TrackerLoop
from app.site.orders import tracker_orders
from app.site.state import authority as rules
from app.site.state.authority import Authority, Due, Verdict, Wish
from app.site.state.model import SiteModel
from app.tracker.commands.commands import Command, CommandRejected, Jog
from app.tracker.commands.control import ControlHeld, Holder
from app.tracker.state.snapshot import ActivityName, Event, EventKind
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.reason import Reason

GOES_ON = {
    ActivityName.HOLDING,
    ActivityName.STOPPING,
    ActivityName.FAULTED,
    ActivityName.STOWING,
    ActivityName.STOWED,
}
LONGEST_REASON = 200
NO_USER = N_("no user")
OWN_NAMES = {"sunspec": "SunSpec", "mqtt": N_("MQTT")}
"""Doors that are one holder each, whichever host or client wrote."""

log = get_logger()


def holder_of(order: Order) -> Holder:
    """Return who an order makes the holder of control."""
    return Holder(OWN_NAMES.get(order.via, order.actor), order.via, order.rank)


async def admit(
    model: SiteModel, loop: TrackerLoop, order: Order, command: Command
) -> tuple[Command, tuple[Event, ...]]:
    """Return the command if whoever ordered it has control or takes it by it, and what happened by that.

    Raises `ControlHeld` or `ControlLost`. While control passes from one to another an order waits, and is
    judged after that; a jog loses of its lease what it waited.
    """
    if not command.spec.control:
        return command, ()
    who, tracker_id, asked_at = holder_of(order), loop.config.tracker_id, model.clock.now()
    lock = model.control.lock(tracker_id)
    if not lock.locked() and _goes(model, loop, who, order.epoch):
        return command, ()
    async with lock:
        events = await _settle(model, loop)
        if not _goes(model, loop, who, order.epoch):
            taken = rules.take(authority_of(model, loop), who, model.clock.now(), by_order=True)
            events += await _keep(model, loop, taken, _taken_event(model, loop, order.actor, who))
    return _shortened(command, model.clock.now() - asked_at), events


async def settle(model: SiteModel, loop: TrackerLoop) -> tuple[Event, ...]:
    """Let control pass, end or stay as time has brought it about, and return what happened."""
    if rules.due(authority_of(model, loop), model.clock.now()) is None:
        return ()
    async with model.control.lock(loop.config.tracker_id):
        try:
            return await _settle(model, loop)
        except CommandRejected as error:
            log.warning("control_not_stored", tracker=loop.config.tracker_id, reason=str(error))
            return ()


def authority_of(model: SiteModel, loop: TrackerLoop) -> Authority:
    """Return who has control; at first nobody, under an epoch that no order of a former life bears."""
    return model.control.of(loop.config.tracker_id, loop.memory.control_epoch)


def _goes(model: SiteModel, loop: TrackerLoop, who: Holder, epoch: int | None) -> bool:
    """Return whether an order goes as it is, which renews control; False: control is to be taken for it."""
    authority, now = authority_of(model, loop), model.clock.now()
    if rules.judge(authority, who, epoch, now, loop.config.name) is Verdict.TAKE:
        return False
    model.control.put(loop.config.tracker_id, rules.renew(authority, who, now))
    return True


def _shortened(command: Command, waited: timedelta) -> Command:
    if not isinstance(command, Jog) or not waited:
        return command
    return replace(command, lease=max(command.lease - waited, timedelta()))


async def renew(model: SiteModel, command: RenewControl, order: Order) -> tuple[Event, ...]:
    """Note that whoever has control is still there."""
    who, now = holder_of(order), model.clock.now()
    for tracker_id in command.tracker_ids:
        authority = rules.renew(authority_of(model, model.tracker(tracker_id)), who, now)
        model.control.put(tracker_id, authority)
    return ()


async def request(model: SiteModel, command: RequestControl, order: Order) -> tuple[Event, ...]:
    """Take control of all trackers that are asked for, in the order of their ids, or of none.

    Of one tracker it can also be asked for; doors that have no page to wait at cannot ask.
    """
    command = replace(command, reason=clean(command.reason))
    if len(command.reason) > LONGEST_REASON:
        raise ValueError(
            say("A reason has at most {longest_reason} characters.", longest_reason=LONGEST_REASON)
        )
    loops = [model.tracker(tracker_id) for tracker_id in sorted(set(command.tracker_ids))]
    async with AsyncExitStack() as stack:
        for loop in loops:
            await stack.enter_async_context(model.control.lock(loop.config.tracker_id))
        events = [event for loop in loops for event in await _settle(model, loop)]
        who = holder_of(order)
        if len(loops) > 1 or who.via in OWN_NAMES:
            _refuse_group(model, loops, who)
        for loop in loops:
            events += await _want(model, loop, command, order, who)
    return tuple(events)


def _refuse_group(model: SiteModel, loops: Sequence[TrackerLoop], who: Holder) -> None:
    """Raise `ControlHeld` with everyone who has one of these trackers and would have to agree."""
    reasons = [
        rules.held(holder, who, loop.config.name)
        for loop in loops
        if (holder := authority_of(model, loop).holder) is not None
        and not holder.is_same(who)
        and not rules.passes_at_once(authority_of(model, loop), who)
    ]
    if reasons:
        raise ControlHeld(*reasons)


async def _want(
    model: SiteModel, loop: TrackerLoop, command: RequestControl, order: Order, who: Holder
) -> tuple[Event, ...]:
    authority, now = authority_of(model, loop), model.clock.now()
    if authority.is_held_by(who):
        model.control.put(loop.config.tracker_id, rules.renew(authority, who, now))
        return ()
    if rules.passes_at_once(authority, who):
        return await _pass_on(model, loop, who, order.actor, command.reason)
    reason = command.reason
    if command.takes and not reason:
        raise CommandRejected(NO_REASON)
    until = now + (rules.COUNTDOWN if command.takes else rules.ASK_LASTS)
    wanted = rules.want(authority, Wish(who, command.takes, reason, until), loop.config.name)
    if wanted is authority:
        return ()
    return await _keep(model, loop, wanted, _wish_event(model, loop, order.actor, wanted))


async def answer(model: SiteModel, command: AnswerControl, order: Order) -> tuple[Event, ...]:
    """Hand control over to who wants it, or keep it; stored before this returns."""
    loop = model.tracker(command.tracker_id)
    async with model.control.lock(command.tracker_id):
        events = await _settle(model, loop)
        authority, now = _own(model, loop, order), model.clock.now()
        if authority.wish is None:
            raise CommandRejected(rules.NO_WISH)
        if command.grants:
            return events + await _pass_on(model, loop, authority.wish.by, order.actor, "")
        refused = rules.refuse(authority, now)
        message = say(
            "{actor} keeps control of {name}; the request of {name2} was declined.",
            actor=order.actor,
            name=loop.config.name,
            name2=authority.wish.by.name,
        )
        event = _event(model, loop, EventKind.CONTROL_DECLINED, message, order.actor)
        return events + await _keep(model, loop, rules.renew(refused, holder_of(order), now), event)


async def release(model: SiteModel, command: ReleaseControl, order: Order) -> tuple[Event, ...]:
    """Let go of control; stored before this returns."""
    loop = model.tracker(command.tracker_id)
    async with model.control.lock(command.tracker_id):
        events = await _settle(model, loop)
        authority = _own(model, loop, order)
        if authority.wish is not None:
            return events + await _pass_on(model, loop, authority.wish.by, order.actor, "")
        message = say("{actor} released control of {name}.", actor=order.actor, name=loop.config.name)
        event = _event(model, loop, EventKind.CONTROL_RELEASED, message, order.actor)
        return events + await _keep(model, loop, rules.release(authority), event)


def _own(model: SiteModel, loop: TrackerLoop, order: Order) -> Authority:
    authority = authority_of(model, loop)
    if authority.is_held_by(holder_of(order)):
        return authority
    holder = authority.holder
    if holder is not None:
        raise ControlHeld(rules.held(holder, holder_of(order), loop.config.name))
    raise CommandRejected(
        Reason("no_control", say("You do not have control of {name}.", name=loop.config.name))
    )


async def _settle(model: SiteModel, loop: TrackerLoop) -> tuple[Event, ...]:
    """Carry out what time has brought about; the lock is held."""
    authority, now = authority_of(model, loop), model.clock.now()
    wish, holder = authority.wish, authority.holder
    match rules.due(authority, now):
        case None:
            return ()
        case Due.LAPSED:
            message = say("The request for control of {name} was not answered.", name=loop.config.name)
            event = _event(model, loop, EventKind.CONTROL_DECLINED, message, CONTROLLER)
            return await _keep(model, loop, replace(authority, wish=None), event)
        case Due.PASSES | Due.EXPIRED if wish is not None:
            return await _pass_on(model, loop, wish.by, wish.by.name, wish.reason)
        case _:
            name = NO_USER if holder is None else holder.name
            message = say(
                "There was no signal from {name} for 15 s: no user has control of {name2} now.",
                name=name,
                name2=loop.config.name,
            )
            event = _event(model, loop, EventKind.CONTROL_RELEASED, message, CONTROLLER, expired=True)
            return await _keep(model, loop, rules.without_expired(authority, now), event)


async def _pass_on(
    model: SiteModel, loop: TrackerLoop, who: Holder, actor: str, reason: str
) -> tuple[Event, ...]:
    """Stop what the former holder set in motion, then let control pass: the new one begins at rest."""
    stopped: tuple[Event, ...] = ()
    if authority_of(model, loop).lease is not None and _is_ordered_motion(model, loop):
        stopped = tracker_orders.handle_stop(model, loop, actor)
        await tracker_orders.finish_stop(model, loop)
    taken = rules.take(authority_of(model, loop), who, model.clock.now())
    event = _taken_event(model, loop, actor, who, reason)
    return stopped + await _keep(model, loop, taken, event)


def _is_ordered_motion(model: SiteModel, loop: TrackerLoop) -> bool:
    """Return whether something turns by order, or is announced; following the sun is the machine's own."""
    if loop.activity is not ActivityName.TRACKING:
        return loop.activity not in GOES_ON
    shown = loop.snapshot(model.now(), asked=False)
    return shown.approaching or not shown.in_position


async def _keep(model: SiteModel, loop: TrackerLoop, changed: Authority, event: Event) -> tuple[Event, ...]:
    """Have the epoch and the event on disk before anything goes by them."""
    if changed.epoch > loop.memory.control_epoch:
        loop.controller.set_control_epoch(changed.epoch)
        loop.take_changed()
        await model.ledger.save_tracker(loop.state, (event,))
    else:
        await model.ledger.append((event,))
    model.control.put(loop.config.tracker_id, changed)
    return (event,)


def _with_reason(message: Message, reason: str) -> Message:
    return join(" ", (message, say("Reason: {reason}", reason=reason))) if reason else message


def _taken_event(model: SiteModel, loop: TrackerLoop, actor: str, who: Holder, reason: str = "") -> Event:
    message = say("{name} has control of {name2} now.", name=who.name, name2=loop.config.name)
    message = _with_reason(message, reason.strip())
    return _event(model, loop, EventKind.CONTROL_TAKEN, message, actor, holder=who.name, via=who.via)


def _wish_event(model: SiteModel, loop: TrackerLoop, actor: str, wanted: Authority) -> Event:
    wish = wanted.wish
    takes = wish is not None and wish.takes
    told = {
        "actor": actor,
        "name": loop.config.name,
        "holder": NO_USER if wanted.holder is None else wanted.holder.name,
    }
    message = (
        say("{actor} takes control of {name}, which {holder} has.", **told)
        if takes
        else say("{actor} requests control of {name}, which {holder} has.", **told)
    )
    message = _with_reason(message, "" if wish is None else wish.reason)
    return _event(model, loop, EventKind.CONTROL_REQUESTED, message, actor, takes=takes)


def _event(
    model: SiteModel, loop: TrackerLoop, kind: EventKind, message: Message, actor: str, **data: object
) -> Event:
    return model.event(kind, message, actor, loop.config.tracker_id, **data)


NO_REASON = Reason(
    "no_reason",
    N_("Taking control from another user needs a reason."),
    N_("Enter a short reason; all users can read it."),
)
