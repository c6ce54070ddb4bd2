"""Which conditions every action needs: one table, read by `handle` and by the snapshot's `actions` alike."""

from collections.abc import Callable
from enum import StrEnum

from app.tracker.activity import NAMES, Faulted, Showing
from app.tracker.commands import CommandRejected
from app.tracker.controller_state import ControllerState
from app.tracker.guards import axis_feedback
from app.tracker.local_locks import cleared, locked, remote, served, settings_open, unlocked, unserved
from app.tracker.memory import StepName
from app.tracker.motion import Feedback
from app.tracker.mounts.capabilities import zero_words
from app.tracker.positioning import at_rest
from app.tracker.protections.fault_classes import CLASSES
from app.tracker.protections.machine_config import Recovery
from app.tracker.protections.words import StowName
from app.tracker.reason import Reason
from app.tracker.rejected import accepted
from app.tracker.snapshot import ActivityName, ShowPhase

UNDO_NEAR_DEG = 0.2
Condition = Callable[[ControllerState], Reason | None]


class Action(StrEnum):
    """What can be asked of a tracker, by the names of `Snapshot.actions`."""

    JOG = "jog"
    STEP = "step"
    SET_HOME = "set_home"
    UNDO_HOME = "undo_home"
    HOME = "home"
    SET_MODE = "set_mode"
    MOVE = "move"
    PARK = "park"
    TRACK = "track"
    GO_TO_START = "go_to_start"
    RUN_SHOW = "run_show"
    PAUSE_SHOW = "pause_show"
    RESUME_SHOW = "resume_show"
    STOP_SHOW = "stop_show"
    STOP = "stop"
    RESET_FAULT = "reset_fault"
    TEST_DIRECTION = "test_direction"
    TEST_SCALE = "test_scale"
    TEST_STOP = "test_stop"
    TEST_COMMUNICATION_LOSS = "test_communication_loss"
    SET_LIMIT = "set_limit"
    STOW = "stow"
    RESUME = "resume"
    SET_INHIBIT = "set_inhibit"
    RELEASE_INHIBIT = "release_inhibit"
    BEGIN_SERVICE_MODE = "begin_service_mode"
    CONFIRM_AREA_CLEAR = "confirm_area_clear"
    END_SERVICE_MODE = "end_service_mode"


def unmet(mind: ControllerState, action: Action) -> tuple[Reason, ...]:
    """Return every condition that forbids an action now; empty: it is allowed."""
    return tuple(reason for condition in REQUIRED[action] if (reason := condition(mind)) is not None)


def demand(mind: ControllerState, action: Action, *more: Reason | None) -> None:
    """Raise `CommandRejected` with every unmet condition of an action and what else speaks against it."""
    reasons = _against(mind, action, more)
    if reasons:
        raise CommandRejected(*reasons)


def demand_drive(mind: ControllerState, action: Action, *more: Reason | None) -> Feedback:
    """Return the last reading for an action that needs one, or raise `CommandRejected` as `demand` does."""
    reasons = _against(mind, action, more)
    if reasons or mind.feedback is None:
        raise CommandRejected(*reasons)
    return mind.feedback


def _against(mind: ControllerState, action: Action, more: tuple[Reason | None, ...]) -> tuple[Reason, ...]:
    return unmet(mind, action) + tuple(reason for reason in more if reason is not None)


def reachable(mind: ControllerState) -> Reason | None:
    """Return that the drive does not answer."""
    if mind.feedback is not None and not mind.lost:
        return None
    return Reason(
        "drive_unreachable",
        f"The drive of {mind.config.name} does not answer.",
        "Check the drive's power and network cable. The controller retries automatically.",
    )


def sound(mind: ControllerState) -> Reason | None:
    """Return the latched fault."""
    if not isinstance(mind.activity, Faulted):
        return None
    return Reason(
        "fault",
        f"{mind.config.name} has stopped with a fault: {mind.activity.reason.message}",
        mind.activity.reason.hint,
    )


def faulted(mind: ControllerState) -> Reason | None:
    """Return that there is no fault to reset."""
    if isinstance(mind.activity, Faulted):
        return None
    return Reason("no_fault", f"{mind.config.name} has no fault to reset.", "No action is needed.")


def resting(mind: ControllerState) -> Reason | None:
    """Return that an axis still moves."""
    if mind.feedback is None or at_rest(mind.feedback):
        return None
    return Reason(
        "axes_moving",
        f"The axes of {mind.config.name} are still moving.",
        "Wait until both are at standstill.",
    )


def homed(mind: ControllerState) -> Reason | None:
    """Return that no zero is trusted, and why if one was lost."""
    if mind.memory.home is not None:
        return None
    name, lost = mind.config.name, mind.memory.home_lost
    return Reason(
        "home_not_trusted",
        f"{name} is not homed: {lost}" if lost else f"{name} is not homed.",
        "Go to step 3, Homing, and set the home position.",
    )


def undoable(mind: ControllerState) -> Reason | None:
    """Return that there is no home position to go back to, or that the axes have moved since it was set."""
    former, seen = mind.memory.former_home, mind.feedback
    if former is None or seen is None or seen.boot_count != former.boot_count:
        return Reason(
            "nothing_to_undo",
            "There is no former home position.",
            "Only the last manually set home position can be undone.",
        )
    near_deg = max(UNDO_NEAR_DEG, mind.config.in_position_deg)
    if all(abs(axis_feedback(seen, axis).position_deg) <= near_deg for axis in former.axes):
        return None
    return Reason(
        "moved_since",
        f"The axes of {mind.config.name} have moved since the home position was set.",
        "Move the axes to the correct position and set the home position there.",
    )


def self_homing(mind: ControllerState) -> Reason | None:
    """Return that the drive cannot search for its origin."""
    if mind.capabilities.automatic_homing:
        return None
    return Reason(
        "no_origin_switches",
        f"The drive of {mind.config.name} has no home switches to search for.",
        f"Jog each axis to its home position ({zero_words(mind.config.mount)}), then press Set home here.",
    )


def watched(mind: ControllerState) -> Reason | None:
    """Return that the drive has no watchdog that could be tested."""
    if mind.capabilities.watchdog_s is not None:
        return None
    return Reason(
        "no_watchdog",
        (
            f"The drive of {mind.config.name} has no watchdog: it does not stop automatically on "
            "communication loss."
        ),
        "Jogging is therefore limited to short increments. The emergency stop must be within reach.",
    )


def prompt(mind: ControllerState) -> Reason | None:
    """Return that the drive's replies are too slow for motion by a held key."""
    link = None if mind.seen is None else mind.seen.link
    if link is None or not link.slow:
        return None
    return Reason(
        "link_slow",
        f"The drive of {mind.config.name} answers slowly: 1 reply in 100 takes more than "
        f"{link.p99_s * 1000.0:.0f} ms; the limit is {link.allowed_s * 1000.0:.0f} ms.",
        "Use incremental jog, or find out what slows the connection down.",
    )


def recoverable(mind: ControllerState) -> Reason | None:
    """Return that a fault of this class is cleared in service mode only."""
    if not isinstance(mind.activity, Faulted) or mind.memory.service is not None:
        return None
    fault = CLASSES.get(mind.activity.reason.code)
    if fault is None or mind.config.machine.recovery.of(fault).kind is not Recovery.SERVICE:
        return None
    return Reason(
        "service_needed",
        "A fault of this class can be reset only at the tracker, in service mode.",
        "Begin service mode on the tracker's page, remove the cause, then reset the fault.",
    )


def stowed(mind: ControllerState) -> Reason | None:
    """Return that no stow was commanded that could be left."""
    if mind.memory.stow is not None:
        return None
    text = f"{mind.config.name} is not in a manual stow."
    return Reason("not_in_stow", text, "A stow that the weather requires ends automatically.")


def sheltered(mind: ControllerState) -> Reason | None:
    """Return that wind or snow demand a stow, so that the panel must go nowhere else."""
    if mind.guarding is None or mind.guarding.stow is None:
        return None
    words = {StowName.WIND: "the wind", StowName.SNOW: "snow"}[mind.guarding.stow]
    return Reason(
        "stow_demanded",
        f"{mind.config.name} must be stowed because of {words}.",
        "Wait until that has ended. If the tracker is not stowed yet, press Stow.",
    )


def located(mind: ControllerState) -> Reason | None:
    """Return that the site's location is not known."""
    if mind.seen is not None and mind.seen.location is not None:
        return None
    return Reason("location_unknown", "The site has no location yet.", "Go to step 1, Location.")


def on_time(mind: ControllerState) -> Reason | None:
    """Return that the site's clock is not to be relied on."""
    if mind.seen is not None and mind.seen.clock_trusted:
        return None
    return Reason(
        "clock_untrusted", "The site's clock is not trusted.", "Go to step 2, Clock, and set or confirm it."
    )


def mode_selected(mind: ControllerState) -> Reason | None:
    """Return that no mode has been selected."""
    if mind.memory.mode is not None:
        return None
    return Reason("mode_not_selected", f"No mode is selected for {mind.config.name}.", "Go to step 4, Mode.")


def confirmed(step: StepName, number: int) -> Condition:
    """Return the condition that a step was not saved for a former location."""

    def condition(mind: ControllerState) -> Reason | None:
        saved = mind.memory.confirmations.get(step)
        if saved is None or mind.seen is None or saved.location_revision >= mind.seen.location_revision:
            return None
        return Reason(
            f"{step}_to_be_confirmed",
            f"The location has changed since step {number}, {step}, was saved for {mind.config.name}.",
            f"Go to step {number} and confirm it.",
        )

    return condition


def while_(*allowed: ActivityName) -> Condition:
    """Return the condition that the tracker is doing one of these (a fault is `sound`'s business)."""

    def condition(mind: ControllerState) -> Reason | None:
        doing = NAMES[type(mind.activity)]
        if doing in allowed or doing is ActivityName.FAULTED:
            return None
        words, hint = _DOING[doing]
        return Reason(f"busy_{doing}", f"{mind.config.name} {words}.", hint)

    return condition


def showing(*phases: ShowPhase) -> Condition:
    """Return the condition that a show is in one of these phases."""

    def condition(mind: ControllerState) -> Reason | None:
        if isinstance(mind.activity, Showing) and mind.activity.phase in phases:
            return None
        phase = mind.activity.phase if isinstance(mind.activity, Showing) else None
        hint = _SHOW_HINT[phases[0]] if phases[0] is not ShowPhase.READY else _BEFORE_RUN[phase]
        return Reason("show_phase", f"{mind.config.name} {_SHOW_IS[phase]}.", hint)

    return condition


def not_in_a_show(mind: ControllerState) -> Reason | None:
    """Return that a show is under way, which would have to be stopped first."""
    if isinstance(mind.activity, Showing) and mind.activity.phase in (ShowPhase.RUNNING, ShowPhase.PAUSED):
        return Reason(
            "show_running", f"{mind.config.name} {_SHOW_IS[mind.activity.phase]}.", "Stop the show first."
        )
    return None


_STOP_FIRST = "Press Stop first."
_DOING = {
    ActivityName.HOLDING: ("is at standstill", "No action is needed."),
    ActivityName.JOGGING: ("is being jogged", "Release the button first."),
    ActivityName.MOVING: ("is moving to a position", "Wait until the tracker has arrived, or press Stop."),
    ActivityName.SETTING_HOME: ("is setting its home position", "Wait until this has finished."),
    ActivityName.HOMING: (
        "is searching for its home switches",
        "Wait until this has finished, or press Stop.",
    ),
    ActivityName.TRACKING: ("is tracking", _STOP_FIRST),
    ActivityName.SHOWING: ("is busy with a show", "Stop the show first."),
    ActivityName.STOPPING: ("is stopping", "Wait until both axes are at standstill."),
    ActivityName.STOWING: (
        "is going to a stow position",
        "Wait until the tracker has arrived, or press Stop.",
    ),
    ActivityName.STOWED: ("is stowed", "Press Stop first; the tracker is then no longer stowed."),
    ActivityName.MEASURING: ("is running a drive test", "Wait until this has finished, or press Stop."),
}
_SHOW_IS = {
    None: "has no show under way",
    ShowPhase.GOING_TO_START: "is still going to the start of the show",
    ShowPhase.READY: "is at the start of a show that has not begun",
    ShowPhase.RUNNING: "is running a show",
    ShowPhase.PAUSED: "has paused a show",
}
_SHOW_HINT = {
    ShowPhase.GOING_TO_START: "There is nothing to stop.",
    ShowPhase.RUNNING: "Only a running show can be paused.",
    ShowPhase.PAUSED: "Only a paused show can be resumed.",
}
_BEFORE_RUN = {
    None: "Press Go to start position and wait until the panel is there.",
    ShowPhase.GOING_TO_START: "Wait until the tracker has arrived, or press Stop.",
    ShowPhase.READY: "No action is needed.",
    ShowPhase.RUNNING: "Stop the show first.",
    ShowPhase.PAUSED: "Stop the show first.",
}

_HOLD, _JOG, _MOVE = ActivityName.HOLDING, ActivityName.JOGGING, ActivityName.MOVING
_TRACK, _SHOW, _STOPPING = ActivityName.TRACKING, ActivityName.SHOWING, ActivityName.STOPPING
_STOW, _STOWED = ActivityName.STOWING, ActivityName.STOWED
_CAN_MOVE = (accepted, reachable, sound, remote, homed, unlocked)
_BY_ITSELF = (*_CAN_MOVE, unserved)
_CAN_PROVE = (accepted, reachable, sound, remote, cleared, while_(_HOLD), resting)

REQUIRED: dict[Action, tuple[Condition, ...]] = {
    Action.JOG: (accepted, reachable, sound, remote, cleared, prompt, while_(_HOLD, _JOG)),
    Action.STEP: (accepted, reachable, sound, remote, cleared, while_(_HOLD)),
    Action.SET_HOME: (reachable, sound, remote, settings_open, while_(_HOLD), resting),
    Action.UNDO_HOME: (reachable, sound, remote, settings_open, while_(_HOLD), resting, undoable),
    Action.HOME: (accepted, reachable, sound, remote, cleared, unlocked, self_homing, while_(_HOLD), resting),
    Action.SET_MODE: (while_(_HOLD, _JOG, _MOVE, _STOPPING),),
    Action.MOVE: (*_CAN_MOVE, cleared, sheltered, while_(_HOLD, _MOVE, _TRACK, _STOW, _STOWED)),
    Action.PARK: (*_BY_ITSELF, sheltered, while_(_HOLD, _MOVE, _TRACK, _STOW, _STOWED)),
    Action.STOW: (*_BY_ITSELF, while_(_HOLD, _MOVE, _TRACK, _STOW, _STOWED)),
    Action.RESUME: (remote, unlocked, unserved, stowed),
    Action.SET_INHIBIT: (unlocked,),
    Action.RELEASE_INHIBIT: (locked,),
    Action.BEGIN_SERVICE_MODE: (unserved,),
    Action.CONFIRM_AREA_CLEAR: (served,),
    Action.END_SERVICE_MODE: (served,),
    Action.TRACK: (
        *_BY_ITSELF,
        located,
        on_time,
        mode_selected,
        confirmed(StepName.HOMING, 3),
        confirmed(StepName.MODE, 4),
        while_(_HOLD, _MOVE, _TRACK, _STOW, _STOWED),
    ),
    Action.GO_TO_START: (
        *_BY_ITSELF,
        sheltered,
        while_(_HOLD, _MOVE, _TRACK, _SHOW, _STOW, _STOWED),
        not_in_a_show,
    ),
    Action.RUN_SHOW: (*_BY_ITSELF, sheltered, showing(ShowPhase.READY)),
    Action.PAUSE_SHOW: (showing(ShowPhase.RUNNING),),
    Action.RESUME_SHOW: (
        remote,
        unserved,
        unlocked,
        sheltered,
        showing(ShowPhase.PAUSED),
    ),
    Action.STOP_SHOW: (
        showing(ShowPhase.GOING_TO_START, ShowPhase.READY, ShowPhase.RUNNING, ShowPhase.PAUSED),
    ),
    Action.STOP: (),
    Action.RESET_FAULT: (reachable, faulted, recoverable),
    Action.TEST_DIRECTION: _CAN_PROVE,
    Action.TEST_SCALE: _CAN_PROVE,
    Action.TEST_STOP: (*_CAN_PROVE, unserved),
    Action.TEST_COMMUNICATION_LOSS: (*_CAN_PROVE, unserved, watched),
    Action.SET_LIMIT: (*_CAN_PROVE, homed),
}
