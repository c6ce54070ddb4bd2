"""A motion that nobody at the machine asked for is announced: by a countdown, and by the horn."""

from datetime import datetime, timedelta

from app.base.message import N_, Message, say, with_format
from app.tracker.commands.control import PROGRAMS
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.parts import Warned
from app.tracker.state.snapshot import EventKind
from app.tracker.values.reason import Reason


def announce(state: ControllerState, why: Message) -> None:
    """Warn of a motion that begins after the warning time; `why` is a sentence that says what it is."""
    warning_s = state.config.protection.warning_s
    if warning_s <= 0.0:
        return
    reason = Reason("motion_ahead", why, N_("Keep clear of the panel, or press Stop."))
    motion = Warned(state.now + timedelta(seconds=warning_s), reason)
    state.countdowns = state.countdowns._replace(motion=motion)
    state.say(
        EventKind.MOTION_ANNOUNCED,
        say("{why} Motion starts in {warning_s} s.", why=why, warning_s=with_format(warning_s, "g")),
        seconds=warning_s,
    )


def announce_if_remote(state: ControllerState, why: Message) -> None:
    """Warn of a motion that another machine asked for."""
    if state.via in PROGRAMS:
        announce(state, why)


def is_announced(state: ControllerState) -> bool:
    """Return whether the motion is still being announced; afterwards the warning is forgotten."""
    motion = state.countdowns.motion
    if motion is None:
        return False
    if state.now < motion.until:
        return True
    call_off(state)
    return False


def begins_at(state: ControllerState) -> datetime:
    """Return when a motion that is commanded now begins."""
    motion = state.countdowns.motion
    return state.now if motion is None else motion.until


def call_off(state: ControllerState) -> None:
    """Announce no motion any more: it has begun, or is not to begin."""
    if state.countdowns.motion is not None:
        state.countdowns = state.countdowns._replace(motion=None)


def is_counted_down(state: ControllerState, grace: timedelta) -> bool:
    """Return whether a motion by hand may go on: for so long after it was asked for the first time."""
    by_hand = state.countdowns.by_hand
    if by_hand is None:
        state.countdowns = state.countdowns._replace(by_hand=state.now + grace)
        return True
    if state.now < by_hand:
        return True
    forget_by_hand(state)
    return False


def forget_by_hand(state: ControllerState) -> None:
    """Count down to the end of no motion by hand."""
    if state.countdowns.by_hand is not None:
        state.countdowns = state.countdowns._replace(by_hand=None)
