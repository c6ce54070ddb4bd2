"""Whether tracking goes on by itself: now, after a stow, or by the recovery policy of what stopped it."""

from datetime import timedelta

from app.tracker.protections.fault_classes import CLASSES
from app.tracker.settings.mechanics import Recovery, RecoveryPolicy
from app.tracker.state.activity import Faulted, Holding, Stowed, Stowing, Tracking
from app.tracker.state.controller_state import ControllerState

HOUR = timedelta(hours=1)


def goes_on(state: ControllerState) -> bool:
    """Return whether tracking goes on with nobody asked: it tracks, is stowed meanwhile, or recovers."""
    if not state.memory.tracking_on:
        return False
    if isinstance(state.activity, Tracking | Stowing | Stowed):
        return state.waiting.reason is None and state.memory.stow is None
    return state.recovery.goes_on or recovery_policy(state) is not None


def goes_on_soon(state: ControllerState) -> bool:
    """Return whether tracking goes on with nobody asked before the resets of an hour are used up."""
    policy = recovery_policy(state)
    recent = sum(state.now - at < HOUR for at in state.recovery.resets)
    is_spent = policy is not None and policy.kind is Recovery.LIMITED and recent >= policy.times_per_hour
    return goes_on(state) and (state.recovery.goes_on or not is_spent)


def recovery_policy(state: ControllerState) -> RecoveryPolicy | None:
    """Return the policy by which the present fault is left by itself, None where a person has to."""
    code = fault_code(state)
    fault = None if code is None else CLASSES.get(code)
    if fault is None or state.memory.lock is not None or state.memory.service is not None:
        return None
    policy = state.config.machine.recovery.of(fault)
    return policy if policy.kind in (Recovery.LIMITED, Recovery.UNLIMITED) else None


def fault_code(state: ControllerState) -> str | None:
    """Return the code of the latched fault, or that the drive was lost and tracking waits for that."""
    if isinstance(state.activity, Faulted):
        return state.activity.reason.code
    wait = state.waiting.reason
    if wait is None or wait.code != "drive_lost" or not isinstance(state.activity, Holding):
        return None
    return wait.code
