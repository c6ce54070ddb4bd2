"""Where zero is: set by hand, axis by axis and read back, or searched by the drive itself."""

from datetime import timedelta
from typing import assert_never

from app.tracker.activity import HOLDING, Homing, SettingHome
from app.tracker.axes import Axis
from app.tracker.commands import CommandRejected, SetHome
from app.tracker.controller_state import HALTED, NOWHERE, ControllerState, Turn
from app.tracker.guards import axis_feedback
from app.tracker.home_shift import forget, keep_former
from app.tracker.interlocks import Action, demand
from app.tracker.memory import HomeTrust, StepName
from app.tracker.motion import DriveCommand, DriveRequest, Feedback, RequestKind
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.positioning import at_rest
from app.tracker.reason import Reason
from app.tracker.selection import confirm_step
from app.tracker.snapshot import EventKind
from app.tracker.transitions import doubt_zero, lose_home

ZERO_PATIENCE = timedelta(seconds=5)
HOMING_GRACE_S = 60.0
ZERO_TOLERANCE_DEG = 0.05
_REQUESTS = {
    Axis.AZIMUTH: RequestKind.SET_HOME_AZIMUTH,
    Axis.ELEVATION: RequestKind.SET_HOME_ELEVATION,
}


def set_home(mind: ControllerState, command: SetHome) -> None:
    """Begin to call the present position zero, or raise `CommandRejected`."""
    demand(mind, Action.SET_HOME)
    axes = tuple(axis for axis in mind.config.mount.axes if axis in command.axes)
    if not axes:
        raise CommandRejected(
            Reason(
                "no_axis",
                "No axis of this mount was selected for homing.",
                f"Name one or more of these: {', '.join(mind.config.mount.axes)}.",
            )
        )
    keep_former(mind, axes)
    mind.setpoint, mind.corrected = NOWHERE, None
    until = mind.now + ZERO_PATIENCE
    mind.activity = SettingHome(axes, axes, mind.next_request(), until, mind.actor)


def home(mind: ControllerState) -> None:
    """Begin the search for the origin switches, or raise `CommandRejected`. The old zero is given up."""
    demand(mind, Action.HOME)
    mind.setpoint, mind.corrected = NOWHERE, None
    mind.zeroed = frozenset()
    forget(mind)
    doubt_zero(mind, "the search for the home switches was not finished.")
    mind.activity = Homing(mind.next_request(), mind.now + _homing_time(mind), mind.actor)
    mind.say(EventKind.HOMING_STARTED, "The drive searches for its home switches.")


def step(mind: ControllerState, activity: SettingHome | Homing, feedback: Feedback) -> Turn:
    """Go on with setting zero or with the drive's search."""
    match activity:
        case SettingHome():
            return _zeroing(mind, activity, feedback)
        case Homing():
            return _homing(mind, activity, feedback)
    assert_never(activity)


def _zeroing(mind: ControllerState, zeroing: SettingHome, feedback: Feedback) -> Turn:
    """Have the drive set one axis after the other to zero, then read both back."""
    if feedback.request_done != zeroing.number:
        if mind.now >= zeroing.until:
            return _zero_failed(mind, "the drive did not answer in time.")
        request = DriveRequest(zeroing.number, _REQUESTS[zeroing.pending[0]])
        return Turn(zeroing, DriveCommand(request=request))
    if feedback.request_failed:
        return _zero_failed(mind, f"the drive refused the command for the {zeroing.pending[0]} axis.")
    pending = zeroing.pending[1:]
    if not pending:
        return _read_back(mind, zeroing, feedback)
    until = mind.now + ZERO_PATIENCE
    zeroing = SettingHome(zeroing.axes, pending, mind.next_request(), until, zeroing.actor)
    request = DriveRequest(zeroing.number, _REQUESTS[pending[0]])
    return Turn(zeroing, DriveCommand(request=request))


def _homing(mind: ControllerState, homing: Homing, feedback: Feedback) -> Turn:
    """Wait for the drive's search; one that fails or takes too long leaves the tracker without a zero."""
    if feedback.request_done != homing.number:
        if mind.now >= homing.until:
            return _homing_failed(mind, "the search took too long.")
        return Turn(homing, DriveCommand(request=DriveRequest(homing.number, RequestKind.HOME)))
    if feedback.request_failed:
        return _homing_failed(mind, f"the drive did not find {_missing(mind, feedback)}.")
    if not at_rest(feedback):
        return Turn(homing)
    if not (feedback.azimuth.homed and feedback.elevation.homed):
        return _homing_failed(mind, "the drive does not report both axes as homed.")
    mind.zeroed = frozenset(Axis)
    mind.activity = HOLDING
    mind.say(EventKind.HOMING_ENDED, "Both axes have found their home switches.", outcome="homed")
    _trust(mind, feedback, homing.actor, "home switches")
    return Turn(HOLDING)


def _missing(mind: ControllerState, feedback: Feedback) -> str:
    """Return whose switch was not met: where one axis stands on its own, the other's."""
    axes = mind.config.mount.axes
    unmet = [axis for axis in axes if not axis_feedback(feedback, axis).at_origin]
    if not unmet or len(unmet) == len(axes) > 1:
        return "them"
    return f"the home switch of the {axis_of(mind.config, unmet[0])} within its whole travel"


def _read_back(mind: ControllerState, zeroing: SettingHome, feedback: Feedback) -> Turn:
    for axis in zeroing.axes:
        seen = axis_feedback(feedback, axis)
        if abs(seen.position_deg) > max(ZERO_TOLERANCE_DEG, mind.config.in_position_deg):
            title = axis_title(mind.config.mount, axis)
            why = f"the {title} axis reads {seen.position_deg:.2f} degrees instead of 0."
            return _zero_failed(mind, why)
        if not seen.homed:
            return _zero_failed(
                mind, f"the drive does not report the {axis_title(mind.config.mount, axis)} axis as homed."
            )
    mind.zeroed |= frozenset(zeroing.axes)
    mind.activity = HOLDING
    named = " and ".join(axis_title(mind.config.mount, axis) for axis in zeroing.axes)
    mind.say(
        EventKind.HOME_POSITION_SET, f"Home position set for {named} and verified.", axes=list(zeroing.axes)
    )
    if mind.zeroed.issuperset(mind.config.mount.axes) and feedback.azimuth.homed and feedback.elevation.homed:
        _trust(mind, feedback, zeroing.actor, "set manually")
    return Turn(HOLDING)


def _trust(mind: ControllerState, feedback: Feedback, actor: str, how: str) -> None:
    trust = HomeTrust(mind.site_time, actor, how, feedback.boot_count)
    mind.remember(home=trust, home_lost="", home_lost_at=None)
    confirm_step(mind, StepName.HOMING, actor)


def _zero_failed(mind: ControllerState, why: str) -> Turn:
    mind.activity = HOLDING
    mind.say(
        EventKind.HOME_POSITION_NOT_SET,
        (f"Home position not set: {why} Keep the axes at standstill and press Set home here again."),
    )
    mind.remember(former_home=None)
    lose_home(mind, Reason("home_position_not_set", why))
    return Turn(HOLDING)


def _homing_failed(mind: ControllerState, why: str) -> Turn:
    mind.activity = HOLDING
    doubt_zero(mind, f"the search for the home switches failed: {why}")
    mind.say(EventKind.HOMING_ENDED, f"The home switches were not found: {why}", outcome="failed")
    return Turn(HOLDING, HALTED)


def _homing_time(mind: ControllerState) -> timedelta:
    """Return twice the time for both full ranges at the slow hand speed, and a minute."""
    seconds = HOMING_GRACE_S
    for axis in mind.config.mount.axes:
        config = mind.config.axis(axis)
        seconds += 2.0 * (config.maximum_deg - config.minimum_deg) / config.jog_slow_dps
    return timedelta(seconds=seconds)
