"""Where zero is: set by hand, axis by axis and read back, or searched by the drive itself."""

from datetime import timedelta
from typing import assert_never

from app.base.message import N_, NOTHING, Message, join, say, with_format
from app.tracker.access.interlocks import Action, demand
from app.tracker.commands.commands import CommandRejected, SetHome
from app.tracker.commissioning.selection import confirm_step
from app.tracker.memory.memory import HomeTrust, StepName
from app.tracker.motion.guards import axis_feedback
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.settings.axes import Axis
from app.tracker.state.activity import HOLDING, Homing, SettingHome
from app.tracker.state.controller_state import HALTED, ControllerState, Turn
from app.tracker.state.home_trust import SEARCH_BEGUN, doubt_zero, lose_home, set_homed
from app.tracker.state.positioning import at_rest
from app.tracker.state.setpoints import forget_setpoints
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, hold
from app.tracker.supervision.home_shift import forget, keep_former
from app.tracker.values.motion import DriveCommand, DriveRequest, Feedback, RequestKind
from app.tracker.values.reason import Reason

ZERO_PATIENCE = timedelta(seconds=5)
HOMING_GRACE_S = 60.0
ZERO_TOLERANCE_DEG = 0.05
_REQUESTS = {
    Axis.AZIMUTH: RequestKind.SET_HOME_AZIMUTH,
    Axis.ELEVATION: RequestKind.SET_HOME_ELEVATION,
}


def set_home(state: ControllerState, command: SetHome) -> None:
    """Begin to call the present position zero, or raise `CommandRejected`."""
    demand(state, Action.SET_HOME)
    axes = tuple(axis for axis in state.config.mount.axes if axis in command.axes)
    if not axes:
        raise CommandRejected(
            Reason(
                "no_axis",
                N_("No axis of this mount was selected for homing."),
                say("Name one or more of these: {axes}.", axes=join(", ", state.config.mount.axes)),
            )
        )
    keep_former(state, axes)
    forget_setpoints(state)
    until = state.now + ZERO_PATIENCE
    begin(state, SettingHome(axes, axes, state.next_request(), until, state.actor))


def home(state: ControllerState) -> None:
    """Begin the search for the origin switches, or raise `CommandRejected`. The old zero is given up."""
    demand(state, Action.HOME)
    forget_setpoints(state)
    set_homed(state, frozenset())
    forget(state)
    doubt_zero(state, SEARCH_BEGUN)
    begin(state, Homing(state.next_request(), state.now + _homing_time(state), state.actor))
    state.say(EventKind.HOMING_STARTED, N_("The drive searches for its home switches."))


def step(state: ControllerState, activity: SettingHome | Homing, feedback: Feedback) -> Turn:
    """Go on with setting zero or with the drive's search."""
    match activity:
        case SettingHome():
            return _zeroing(state, activity, feedback)
        case Homing():
            return _homing(state, activity, feedback)
    assert_never(activity)


def _zeroing(state: ControllerState, zeroing: SettingHome, feedback: Feedback) -> Turn:
    """Have the drive set one axis after the other to zero, then read both back."""
    if feedback.request_done != zeroing.number:
        if state.now >= zeroing.until:
            return _zero_failed(state, N_("the drive did not answer in time."))
        request = DriveRequest(zeroing.number, _REQUESTS[zeroing.pending[0]])
        return Turn(zeroing, DriveCommand(request=request))
    if feedback.request_failed:
        return _zero_failed(
            state, say("the drive refused the command for the {pending} axis.", pending=zeroing.pending[0])
        )
    pending = zeroing.pending[1:]
    if not pending:
        return _read_back(state, zeroing, feedback)
    until = state.now + ZERO_PATIENCE
    zeroing = SettingHome(zeroing.axes, pending, state.next_request(), until, zeroing.actor)
    request = DriveRequest(zeroing.number, _REQUESTS[pending[0]])
    return Turn(zeroing, DriveCommand(request=request))


def _homing(state: ControllerState, homing: Homing, feedback: Feedback) -> Turn:
    """Wait for the drive's search; one that fails or takes too long leaves the tracker without a zero."""
    if feedback.request_done != homing.number:
        if state.now >= homing.until:
            return _homing_failed(state, N_("the search took too long."))
        return Turn(homing, DriveCommand(request=DriveRequest(homing.number, RequestKind.HOME)))
    if feedback.request_failed:
        return _homing_failed(state, say("the drive did not find {what}.", what=_missing(state, feedback)))
    if not at_rest(feedback):
        return Turn(homing)
    if not (feedback.azimuth.homed and feedback.elevation.homed):
        return _homing_failed(state, N_("the drive does not report both axes as homed."))
    set_homed(state, frozenset(Axis))
    hold(state)
    state.say(EventKind.HOMING_ENDED, N_("Both axes have found their home switches."), outcome="homed")
    _trust(state, feedback, homing.actor, N_("home switches"))
    return Turn(HOLDING)


def _missing(state: ControllerState, feedback: Feedback) -> str:
    """Return whose switch was not met: where one axis stands on its own, the other's."""
    axes = state.config.mount.axes
    unmet = [axis for axis in axes if not axis_feedback(feedback, axis).at_origin]
    if not unmet or len(unmet) == len(axes) > 1:
        return "them"
    return say(
        "the home switch of the {config} within its whole travel", config=axis_of(state.config, unmet[0])
    )


def _read_back(state: ControllerState, zeroing: SettingHome, feedback: Feedback) -> Turn:
    for axis in zeroing.axes:
        seen = axis_feedback(feedback, axis)
        if abs(seen.position_deg) > max(ZERO_TOLERANCE_DEG, state.config.in_position_deg):
            title = axis_title(state.config.mount, axis)
            why = say(
                "the {title} axis reads {position_deg} degrees instead of 0.",
                title=title,
                position_deg=with_format(seen.position_deg, ".2f"),
            )
            return _zero_failed(state, why)
        if not seen.homed:
            return _zero_failed(
                state,
                say(
                    "the drive does not report the {mount} axis as homed.",
                    mount=axis_title(state.config.mount, axis),
                ),
            )
    set_homed(state, state.zeroed | frozenset(zeroing.axes))
    hold(state)
    named = join(" and ", (axis_title(state.config.mount, axis) for axis in zeroing.axes))
    state.say(
        EventKind.HOME_POSITION_SET,
        say("Home position set for {named} and verified.", named=named),
        axes=list(zeroing.axes),
    )
    if (
        state.zeroed.issuperset(state.config.mount.axes)
        and feedback.azimuth.homed
        and feedback.elevation.homed
    ):
        _trust(state, feedback, zeroing.actor, N_("set manually"))
    return Turn(HOLDING)


def _trust(state: ControllerState, feedback: Feedback, actor: str, how: Message) -> None:
    trust = HomeTrust(state.site_time, actor, how, feedback.boot_count)
    state.remember(home=trust, home_lost=NOTHING, home_lost_at=None)
    confirm_step(state, StepName.HOMING, actor)


def _zero_failed(state: ControllerState, why: Message) -> Turn:
    hold(state)
    state.say(
        EventKind.HOME_POSITION_NOT_SET,
        say(
            "Home position not set: {why} Keep the axes at standstill and press Set home here again.", why=why
        ),
    )
    state.remember(former_home=None)
    lose_home(state, Reason("home_position_not_set", why))
    return Turn(HOLDING)


def _homing_failed(state: ControllerState, why: Message) -> Turn:
    hold(state)
    doubt_zero(state, say("the search for the home switches failed: {why}", why=why))
    state.say(
        EventKind.HOMING_ENDED, say("The home switches were not found: {why}", why=why), outcome="failed"
    )
    return Turn(HOLDING, HALTED)


def _homing_time(state: ControllerState) -> timedelta:
    """Return twice the time for both full ranges at the slow hand speed, and a minute."""
    seconds = HOMING_GRACE_S
    for axis in state.config.mount.axes:
        config = state.config.axis(axis)
        seconds += 2.0 * (config.maximum_deg - config.minimum_deg) / config.jog_slow_dps
    return timedelta(seconds=seconds)
