"""Which conditions every action needs: one table, read by `handle` and by the snapshot's `actions` alike."""

from enum import StrEnum

from app.base.message import N_, say, with_format, word
from app.tracker.access.activity_interlocks import Condition, not_in_a_show, showing, while_
from app.tracker.access.continuing import goes_on
from app.tracker.access.local_locks import cleared, locked, remote, served, settings_open, unlocked, unserved
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import StepName
from app.tracker.motion.guards import axis_feedback
from app.tracker.mounts.capabilities import zero_words
from app.tracker.protections.fault_classes import CLASSES
from app.tracker.settings.mechanics import Recovery
from app.tracker.settings.protections import StowName
from app.tracker.state.activity import Faulted, Holding
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.positioning import at_rest
from app.tracker.state.rejected import accepted
from app.tracker.state.snapshot import ActivityName, ShowPhase
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason

UNDO_NEAR_DEG = 0.2
UNREACHABLE = "drive_unreachable"
_UNKNOWN_WITHOUT = ("busy_stopping", "axes_moving")
"""Reasons that say to wait for standstill, which a drive that does not answer never reports."""


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


def unmet(state: ControllerState, action: Action) -> tuple[Reason, ...]:
    """Return every condition that forbids an action now; empty: it is allowed."""
    found = tuple(reason for condition in REQUIRED[action] if (reason := condition(state)) is not None)
    return _silence_first(found) if state.connection.lost else found


def _silence_first(found: tuple[Reason, ...]) -> tuple[Reason, ...]:
    """Return the reasons with the lost connection first, without those that a silent drive cannot end."""
    silent = tuple(reason for reason in found if reason.code == UNREACHABLE)
    if not silent:
        return found
    return silent + tuple(reason for reason in found if reason.code not in (UNREACHABLE, *_UNKNOWN_WITHOUT))


def demand(state: ControllerState, action: Action, *more: Reason | None) -> None:
    """Raise `CommandRejected` with every unmet condition of an action and what else speaks against it."""
    reasons = _against(state, action, more)
    if reasons:
        raise CommandRejected(*reasons)


def demand_drive(state: ControllerState, action: Action, *more: Reason | None) -> Feedback:
    """Return the last reading for an action that needs one, or raise `CommandRejected` as `demand` does."""
    reasons = _against(state, action, more)
    if reasons or state.feedback is None:
        raise CommandRejected(*reasons)
    return state.feedback


def _against(state: ControllerState, action: Action, more: tuple[Reason | None, ...]) -> tuple[Reason, ...]:
    return unmet(state, action) + tuple(reason for reason in more if reason is not None)


def reachable(state: ControllerState) -> Reason | None:
    """Return that the drive does not answer."""
    if state.feedback is not None and not state.connection.lost:
        return None
    return Reason(
        UNREACHABLE,
        say("The drive of {name} does not answer.", name=state.config.name),
        N_("Check the drive's power and network cable. The controller retries automatically."),
    )


def sound(state: ControllerState) -> Reason | None:
    """Return the latched fault."""
    if not isinstance(state.activity, Faulted):
        return None
    return Reason(
        "fault",
        say(
            "{name} has stopped with a fault: {message}",
            name=state.config.name,
            message=state.activity.reason.message,
        ),
        state.activity.reason.hint,
    )


def faulted(state: ControllerState) -> Reason | None:
    """Return that there is no fault to reset."""
    if isinstance(state.activity, Faulted):
        return None
    return Reason(
        "no_fault", say("{name} has no fault to reset.", name=state.config.name), N_("No action is needed.")
    )


def resting(state: ControllerState) -> Reason | None:
    """Return that an axis still moves."""
    if state.feedback is None or at_rest(state.feedback):
        return None
    return Reason(
        "axes_moving",
        say("The axes of {name} are still moving.", name=state.config.name),
        N_("Wait until both are at standstill."),
    )


def homed(state: ControllerState) -> Reason | None:
    """Return that no zero is trusted, and why if one was lost."""
    if state.memory.home is not None:
        return None
    name, lost = state.config.name, state.memory.home_lost
    return Reason(
        "tracker_not_homed",
        say("{name} is not homed: {lost}", name=name, lost=lost)
        if lost
        else say("{name} is not homed.", name=name),
        N_("Go to step 3, Homing, and set the home position."),
    )


def undoable(state: ControllerState) -> Reason | None:
    """Return that there is no home position to go back to, or that the axes have moved since it was set."""
    former, seen = state.memory.former_home, state.feedback
    if former is None or seen is None or seen.boot_count != former.boot_count:
        return Reason(
            "nothing_to_undo",
            N_("There is no former home position."),
            N_("Only the last manually set home position can be undone."),
        )
    near_deg = max(UNDO_NEAR_DEG, state.config.in_position_deg)
    if all(abs(axis_feedback(seen, axis).position_deg) <= near_deg for axis in former.axes):
        return None
    return Reason(
        "moved_since",
        say("The axes of {name} have moved since the home position was set.", name=state.config.name),
        N_("Move the axes to the correct position and set the home position there."),
    )


def self_homing(state: ControllerState) -> Reason | None:
    """Return that the drive cannot search for its origin."""
    if state.capabilities.automatic_homing:
        return None
    return Reason(
        "no_origin_switches",
        say("The drive of {name} has no home switches to search for.", name=state.config.name),
        say(
            "Jog each axis to its home position ({mount}), then press Set home here.",
            mount=zero_words(state.config.mount),
        ),
    )


def watched(state: ControllerState) -> Reason | None:
    """Return that the drive has no watchdog that could be tested."""
    if state.capabilities.watchdog_s is not None:
        return None
    return Reason(
        "no_watchdog",
        (
            say(
                "The drive of {name} has no watchdog: it does not stop automatically on communication loss.",
                name=state.config.name,
            )
        ),
        N_("Jogging is therefore limited to short increments. The emergency stop must be within reach."),
    )


def prompt(state: ControllerState) -> Reason | None:
    """Return that the drive's replies are too slow for motion by a held key."""
    link = None if state.seen is None else state.seen.link
    if link is None or not link.slow:
        return None
    return Reason(
        "link_slow",
        say(
            "The drive of {name} answers slowly: 1 reply in 100 takes more than {p99_s} ms; the "
            "limit is {allowed_s} ms.",
            name=state.config.name,
            p99_s=with_format(link.p99_s * 1000.0, ".0f"),
            allowed_s=with_format(link.allowed_s * 1000.0, ".0f"),
        ),
        N_("Use incremental jog, or find out what slows the connection down."),
    )


def recoverable(state: ControllerState) -> Reason | None:
    """Return that a fault of this class is cleared in service mode only."""
    if not isinstance(state.activity, Faulted) or state.memory.service is not None:
        return None
    fault = CLASSES.get(state.activity.reason.code)
    if fault is None or state.config.machine.recovery.of(fault).kind is not Recovery.SERVICE:
        return None
    return Reason(
        "service_needed",
        N_("A fault of this class can be reset only at the tracker, in service mode."),
        N_("Begin service mode on the tracker's page, remove the cause, then reset the fault."),
    )


def stowed(state: ControllerState) -> Reason | None:
    """Return that no stow was commanded that could be left."""
    if state.memory.stow is not None:
        return None
    text = say("{name} is not in a manual stow.", name=state.config.name)
    return Reason("not_in_stow", text, N_("A stow that the weather requires ends automatically."))


def sheltered(state: ControllerState) -> Reason | None:
    """Return that wind or snow demand a stow, so that the panel must go nowhere else."""
    if state.guarding is None or state.guarding.stow is None:
        return None
    words = {StowName.WIND: N_("the wind"), StowName.SNOW: "snow"}[state.guarding.stow]
    return Reason(
        "stow_demanded",
        say("{name} must be stowed because of {words}.", name=state.config.name, words=word(words)),
        N_("Wait until that has ended. If the tracker is not stowed yet, press Stow."),
    )


def located(state: ControllerState) -> Reason | None:
    """Return that the site's location is not known."""
    if state.seen is not None and state.seen.location is not None:
        return None
    return Reason("location_unknown", N_("The site has no location yet."), N_("Go to step 1, Location."))


def on_time(state: ControllerState) -> Reason | None:
    """Return that the site's clock is not to be relied on."""
    if state.seen is not None and state.seen.clock_trusted:
        return None
    return Reason(
        "clock_untrusted",
        N_("The site's clock is not trusted."),
        N_("Go to step 2, Clock, and set or confirm it."),
    )


def settled(state: ControllerState) -> Reason | None:
    """Return that a tracker at standstill may go on tracking with nobody asked, to where it is told here."""
    if not (isinstance(state.activity, Holding) and goes_on(state)):
        return None
    name = state.config.name
    text = say("{tracker_id} may continue tracking automatically.", tracker_id=name)
    return Reason("tracking_continues", text, N_("Press Stop first."))


def mode_selected(state: ControllerState) -> Reason | None:
    """Return that no mode has been selected."""
    if state.memory.mode is not None:
        return None
    return Reason(
        "mode_not_selected",
        say("No mode is selected for {name}.", name=state.config.name),
        N_("Go to step 4, Mode."),
    )


def confirmed(step: StepName, number: int) -> Condition:
    """Return the condition that a step was not saved for a former location."""

    def condition(state: ControllerState) -> Reason | None:
        saved = state.memory.confirmations.get(step)
        if saved is None or state.seen is None or saved.location_revision >= state.seen.location_revision:
            return None
        return Reason(
            f"{step}_to_be_confirmed",
            say(
                "The location has changed since step {number}, {step}, was saved for {name}.",
                number=number,
                step=step,
                name=state.config.name,
            ),
            say("Go to step {number} and confirm it.", number=number),
        )

    return condition


_HOLD, _JOG, _MOVE = ActivityName.HOLDING, ActivityName.JOGGING, ActivityName.MOVING
_TRACK, _SHOW, _STOPPING = ActivityName.TRACKING, ActivityName.SHOWING, ActivityName.STOPPING
_STOW, _STOWED = ActivityName.STOWING, ActivityName.STOWED
_CAN_MOVE = (accepted, reachable, sound, remote, homed, unlocked)
_BY_ITSELF = (*_CAN_MOVE, unserved)
_CAN_PROVE = (accepted, reachable, sound, remote, cleared, while_(_HOLD), resting)

REQUIRED: dict[Action, tuple[Condition, ...]] = {
    Action.JOG: (accepted, reachable, sound, remote, cleared, prompt, while_(_HOLD, _JOG)),
    Action.STEP: (accepted, reachable, sound, remote, cleared, while_(_HOLD)),
    Action.SET_HOME: (reachable, sound, remote, settings_open, while_(_HOLD), settled, resting),
    Action.UNDO_HOME: (reachable, sound, remote, settings_open, while_(_HOLD), settled, resting, undoable),
    Action.HOME: (
        accepted,
        reachable,
        sound,
        remote,
        cleared,
        unlocked,
        self_homing,
        while_(_HOLD),
        settled,
        resting,
    ),
    Action.SET_MODE: (while_(_HOLD, _JOG, _MOVE, _STOPPING), settled),
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
