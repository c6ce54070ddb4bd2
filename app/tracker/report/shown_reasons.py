"""What is said beside the values: why a tracker waits, what is counted down, what is worth knowing."""

from app.base.message import N_, say
from app.tracker.access.interlocks import Action, unmet
from app.tracker.protections.words import WarningState
from app.tracker.state.activity import Homing, Stowed, Stowing, Tracking, TrackPhase
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.rejected import accepted
from app.tracker.supervision import machine_guard
from app.tracker.supervision.weather_protection import doubts, hold_reason, reason
from app.tracker.values.reason import Reason


def waiting_reasons(state: ControllerState) -> tuple[Reason, ...]:
    """Return why a tracker that should track does not move, a cause that two conditions share once."""
    if isinstance(state.activity, Tracking):
        rests = hold_reason(state) if state.activity.phase is TrackPhase.RESTING else None
        return _HOLDS.get(state.activity.phase, ()) if rests is None else (rests,)
    if isinstance(state.activity, Stowing | Stowed):
        return _stowed(state)
    wait = state.waiting.reason
    if not state.memory.tracking_on:
        return () if state.memory.stow is None or wait is None else (wait,)
    known = () if wait is None else (wait,)
    codes = {reason.code for reason in known}
    if codes & _SENT_TO_HOMING and wait is not None and wait.message == state.memory.home_lost:
        codes.add("tracker_not_homed")
    others = tuple(reason for reason in unmet(state, Action.TRACK) if reason.code not in codes)
    return known + others or (_OPERATOR,)


def _stowed(state: ControllerState) -> tuple[Reason, ...]:
    """Return why a stowed tracker that should track does not."""
    if not state.memory.tracking_on:
        return ()
    by_weather = state.guarding is not None and state.guarding.stow is not None
    return (reason(state) if by_weather else _STOWED,)


def countdown(state: ControllerState) -> WarningState | None:
    """Return the countdown to a motion, or to the end of one by hand."""
    motion, by_hand = state.countdowns
    if by_hand is not None:
        return WarningState(max(0.0, (by_hand - state.now).total_seconds()), _HAND_ENDS)
    if motion is None:
        return None
    return WarningState(max(0.0, (motion.until - state.now).total_seconds()), motion.reason)


def notices(state: ControllerState) -> tuple[Reason, ...]:
    """Return what is worth knowing but forbids nothing."""
    limited = isinstance(state.activity, Tracking) and state.activity.phase is TrackPhase.LIMITED
    found = (
        (state.memory.home is None, _NO_SOFT_LIMITS),
        (limited, _LIMITED),
        (state.capabilities.watchdog_s is None, _NO_WATCHDOG),
        (not state.capabilities.verified, _UNVERIFIED),
    )
    refused = accepted(state)
    told = tuple(reason for reason in (refused, state.connection.aftermath) if reason is not None)
    if state.memory.home is None and state.memory.home_lost and not isinstance(state.activity, Homing):
        told = (*told, _zero_lost(state))
    return (
        told
        + machine_guard.notices(state)
        + doubts(state)
        + tuple(reason for present, reason in found if present)
    )


def _zero_lost(state: ControllerState) -> Reason:
    return Reason(
        "home_lost",
        say(
            "{name} is no longer homed: {home_lost}", name=state.config.name, home_lost=state.memory.home_lost
        ),
        N_("Compare the panel with the angles shown, then set the home position again in step 3, Homing."),
    )


_SUN_DOWN = Reason(
    "sun_down", N_("The sun is below the horizon."), N_("Tracking continues automatically at sunrise.")
)
_CLOCK_DOUBTED = Reason(
    "clock_untrusted",
    N_("The site's clock is not trusted."),
    N_("Confirm the clock in step 2, or wait until it has been stable for 60 s; then tracking continues."),
)
_HOLDS = {TrackPhase.NIGHT: (_SUN_DOWN,), TrackPhase.PAUSED: (_CLOCK_DOUBTED,)}
_SENT_TO_HOMING = frozenset({"drive_restarted", "not_homed", "encoder_jump"})
"""Reasons to wait that say by themselves that the zero is lost, and to set it again."""
_STOWED = Reason("stowed", N_("The panel was stowed manually."), N_("Press Resume, or Start tracking."))
_HAND_ENDS = Reason(
    "hand_motion_ends",
    N_("Wind or snow requires a stow; this jog ends."),
    N_("Release the button and move away from the panel, or press again for a few more seconds."),
)
_OPERATOR = Reason(
    "operator_needed", N_("Tracking was interrupted and needs the operator."), N_("Press Start tracking.")
)
_NO_SOFT_LIMITS = Reason(
    "no_soft_limits",
    N_(
        "The tracker is not homed, so the soft limits do not protect it: only the limit switches and "
        "the operator do."
    ),
    N_("Watch the panel while you move it, and set the home position in step 3, Homing."),
)
_LIMITED = Reason(
    "limited",
    N_("The sun is beyond the range of the axes; the panel faces it as nearly as they allow."),
    N_("No action is needed; the soft limits are in the tracker's settings."),
)
_NO_WATCHDOG = Reason(
    "no_watchdog",
    N_("This drive does not stop on communication loss, so jogging is limited to short increments."),
    N_("Keep the emergency stop within reach."),
)
_UNVERIFIED = Reason(
    "profile_unverified",
    N_("The profile of this drive has not been verified on a real drive."),
    N_("Carefully test every motion and the stop before you rely on this drive."),
)
