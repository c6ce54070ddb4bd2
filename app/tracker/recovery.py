"""Leaving a fault by itself, where an engineer allowed that for its class; nothing else moves by itself."""

from datetime import timedelta

from app.tracker.activities import tracking
from app.tracker.activities.faulted import reset_fault
from app.tracker.activity import Faulted, Holding
from app.tracker.controller_state import ControllerState
from app.tracker.motion import Feedback
from app.tracker.positioning import at_rest
from app.tracker.protections.fault_classes import CLASSES
from app.tracker.protections.machine_config import Recovery, RecoveryPolicy
from app.tracker.snapshot import EventKind

HOUR = timedelta(hours=1)


def recover(mind: ControllerState, feedback: Feedback) -> None:
    """Clear a fault that its policy lets clear by itself, and go on tracking after one that was cleared."""
    if mind.recovering:
        _go_on(mind)
    code = _fault(mind)
    if code is None and mind.ailing is None:
        return
    if code != mind.ailing:
        mind.ailing, mind.ailing_since = code, mind.now
    policy = _policy(mind, code)
    if policy is None or not at_rest(feedback) or _asks_already(mind):
        return
    if mind.now - mind.ailing_since < timedelta(seconds=policy.after_s):
        return
    recent = tuple(at for at in mind.recovered_at if mind.now - at < HOUR)
    if policy.kind is Recovery.LIMITED and len(recent) >= policy.times_per_hour:
        return
    mind.recovered_at = (*recent, mind.now)[-60:]
    mind.ailing_since = mind.now
    text = f"{mind.config.name} resets the fault {code} automatically, according to its recovery policy."
    mind.say(EventKind.FAULT_RESET_AUTOMATICALLY, text, code=code, policy=policy.kind)
    if isinstance(mind.activity, Faulted):
        reset_fault(mind)
    mind.recovering = True


def _fault(mind: ControllerState) -> str | None:
    """Return the code of the latched fault, or that the drive was lost and tracking waits for that."""
    if isinstance(mind.activity, Faulted):
        return mind.activity.reason.code
    if mind.wait is None or mind.wait.code != "drive_lost" or not isinstance(mind.activity, Holding):
        return None
    return mind.wait.code


def _policy(mind: ControllerState, code: str | None) -> RecoveryPolicy | None:
    """Return the policy by which a fault is left by itself now, None where a person has to."""
    fault = None if code is None else CLASSES.get(code)
    if fault is None or mind.memory.lock is not None or mind.memory.service is not None:
        return None
    policy = mind.config.machine.recovery.of(fault)
    return policy if policy.kind in (Recovery.LIMITED, Recovery.UNLIMITED) else None


def _asks_already(mind: ControllerState) -> bool:
    return isinstance(mind.activity, Faulted) and mind.activity.number is not None


def _go_on(mind: ControllerState) -> None:
    """Track again once the fault that was being left is gone; the motion is announced."""
    if isinstance(mind.activity, Faulted):
        return
    mind.recovering = False
    if isinstance(mind.activity, Holding):
        tracking.resume(mind, "the fault was reset")
