"""A motion that nobody at the machine asked for is announced: by a countdown, and by the horn."""

from datetime import datetime, timedelta

from app.tracker.control import PROGRAMS
from app.tracker.controller_state import ControllerState, Warned
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind


def announce(mind: ControllerState, why: str) -> None:
    """Warn of a motion that begins after the warning time; `why` is a sentence that says what it is."""
    warning_s = mind.config.protection.warning_s
    if warning_s <= 0.0:
        return
    reason = Reason("motion_ahead", why, "Keep clear of the panel, or press Stop.")
    mind.warning = Warned(mind.now + timedelta(seconds=warning_s), reason)
    mind.say(EventKind.MOTION_ANNOUNCED, f"{why} Motion starts in {warning_s:g} s.", seconds=warning_s)


def announce_if_remote(mind: ControllerState, why: str) -> None:
    """Warn of a motion that another machine asked for."""
    if mind.via in PROGRAMS:
        announce(mind, why)


def is_announced(mind: ControllerState) -> bool:
    """Return whether the motion is still being announced; afterwards the warning is forgotten."""
    if mind.warning is None:
        return False
    if mind.now < mind.warning.until:
        return True
    mind.warning = None
    return False


def begins_at(mind: ControllerState) -> datetime:
    """Return when a motion that is commanded now begins."""
    return mind.now if mind.warning is None else mind.warning.until
