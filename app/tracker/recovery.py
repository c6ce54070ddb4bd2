"""Leaving a fault by itself, where an engineer allowed that for its class; nothing else moves by itself."""

from datetime import datetime, timedelta

from app.base.message import N_, say
from app.tracker.access.continuing import HOUR, fault_code, recovery_policy
from app.tracker.activities import tracking
from app.tracker.activities.faulted import reset_fault
from app.tracker.settings.mechanics import Recovery as Recovers
from app.tracker.settings.mechanics import RecoveryPolicy
from app.tracker.state.activity import Faulted, Holding
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.parts import Recovery
from app.tracker.state.positioning import at_rest
from app.tracker.state.snapshot import EventKind
from app.tracker.values.motion import Feedback

MOST_RESETS = 60


def recover(state: ControllerState, feedback: Feedback) -> None:
    """Clear a fault that its policy lets clear by itself, and go on tracking after one that was cleared."""
    if state.recovery.goes_on:
        _go_on(state)
    code, before = fault_code(state), state.recovery
    if code is None and before.fault is None:
        return
    policy = recovery_policy(state) if at_rest(feedback) and not _asks_already(state) else None
    state.recovery = after = watched(before, code, policy, state.now)
    if policy is None or after.resets is before.resets:
        return
    text = say(
        "{name} resets the fault {code} automatically, according to its recovery policy.",
        name=state.config.name,
        code=code,
    )
    state.say(EventKind.FAULT_RESET_AUTOMATICALLY, text, code=code, policy=policy.kind)
    if isinstance(state.activity, Faulted):
        reset_fault(state)


def watched(before: Recovery, fault: str | None, policy: RecoveryPolicy | None, now: datetime) -> Recovery:
    """Return the next state; it has one reset more where the policy wants the fault reset now."""
    since = before.since if fault == before.fault else now
    waits = before._replace(fault=fault, since=since)
    if policy is None or now - since < timedelta(seconds=policy.after_s):
        return waits
    recent = tuple(at for at in before.resets if now - at < HOUR)
    if policy.kind is Recovers.LIMITED and len(recent) >= policy.times_per_hour:
        return waits
    return Recovery(fault, now, (*recent, now)[-MOST_RESETS:], goes_on=True)


def _asks_already(state: ControllerState) -> bool:
    return isinstance(state.activity, Faulted) and state.activity.number is not None


def _go_on(state: ControllerState) -> None:
    """Track again once the fault that was being left is gone; the motion is announced."""
    if isinstance(state.activity, Faulted):
        return
    state.recovery = state.recovery._replace(goes_on=False)
    if isinstance(state.activity, Holding):
        tracking.resume(state, N_("the fault was reset"))
