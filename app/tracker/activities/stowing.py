"""Going to a stow position, by command or because the weather demands it, and going on afterwards.

A tracker moves by itself only while it is automatic: it tracks, runs a show, or was parked or stowed by
command. Stopped, moved by hand, homing or being proved it stays where it is, whatever the wind does, and
says that it is not stowed.
"""

from dataclasses import replace
from datetime import timedelta

from app.base.message import N_, Message, join, say
from app.tracker.access.interlocks import Action, demand, demand_drive, unmet
from app.tracker.activities.moving import not_arrived, target_of
from app.tracker.commands.commands import Stow
from app.tracker.mounts.mount import aim, sky
from app.tracker.settings.config import MountKind, Orientation
from app.tracker.settings.protections import Facing, StowName
from app.tracker.state.activity import (
    HOLDING,
    AxisPair,
    Faulted,
    Holding,
    Jogging,
    MoveKind,
    Moving,
    Showing,
    Stowed,
    Stowing,
    Tracking,
)
from app.tracker.state.announce import announce, announce_if_remote, call_off, forget_by_hand, is_counted_down
from app.tracker.state.axis_demand import paced
from app.tracker.state.controller_state import ControllerState, Turn
from app.tracker.state.positioning import arrived, at_rest, new_run
from app.tracker.state.setpoints import forget_setpoint
from app.tracker.state.snapshot import EventKind, ShowPhase
from app.tracker.state.transitions import begin, end_show, fail, hold, interrupt, leave
from app.tracker.state.waiting import end_waiting
from app.tracker.supervision.weather_protection import demanded_stow, guarding, reason
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason

HAND_GRACE = timedelta(seconds=5)
"""For so long a motion by hand goes on when the weather demands a stow."""
BY_HAND = (MoveKind.MOVE, MoveKind.STEP)
BARRED = ("limit_switch", "forbidden_region")
"""Why the way to the stow position ended, and would end again: the panel is jogged away first."""
STOW_ACTIVITIES = (Stowing, Stowed)
MOVES_BY_ITSELF = (ShowPhase.GOING_TO_START, ShowPhase.RUNNING)


def stow(state: ControllerState, command: Stow) -> None:
    """Go to a stow position and stay there until `Resume`, or raise `CommandRejected`."""
    feedback = demand_drive(state, Action.STOW)
    end_waiting(state)
    call_off(state)
    if isinstance(state.activity, Moving):
        leave(state, N_("a stow position was commanded."))
    state.remember(stow=command.position)
    if demanded_stow(state) is command.position:
        _begin(state, feedback, command.position)
        announce_if_remote(state, say("{name} goes to its stow position.", name=state.config.name))


def resume(state: ControllerState) -> None:
    """Leave a stow position that was commanded, or raise `CommandRejected`; tracking goes on if it was on."""
    demand(state, Action.RESUME)
    state.remember(stow=None)
    if isinstance(state.activity, Stowing | Stowed) and demanded_stow(state) is None:
        _go_on(state)
        announce_if_remote(state, say("{name} continues tracking.", name=state.config.name))


def guard(state: ControllerState, feedback: Feedback) -> None:
    """Let the weather and the commanded stow have their way before the activity's own step."""
    activity, wanted = state.activity, demanded_stow(state)
    if wanted is None and not isinstance(activity, STOW_ACTIVITIES):
        if state.countdowns.by_hand is not None:
            forget_by_hand(state)
        return
    by_weather = guarding(state).stow
    if isinstance(activity, Jogging) or (isinstance(activity, Moving) and activity.kind in BY_HAND):
        _end_by_hand(state, by_weather)
        return
    forget_by_hand(state)
    if isinstance(activity, Showing):
        if by_weather is not None:
            _end_show(state, activity, by_weather)
        return
    if isinstance(activity, STOW_ACTIVITIES):
        _keep_stowed(state, feedback, activity, wanted)
    elif wanted is not None and _is_automatic(state, wanted):
        _begin_by_itself(state, feedback, wanted)


def step(state: ControllerState, activity: Stowing | Stowed, feedback: Feedback) -> Turn:
    """Go on until the panel is stowed; one that does not arrive in time is a fault."""
    if isinstance(activity, Stowed):
        return Turn(activity)
    if activity.run is None:
        run = new_run(paced(state), feedback, place(state, feedback, activity.stow), state.now)
        activity = replace(activity, run=run)
    else:
        run = activity.run
    if arrived(run.target, feedback, state.config.in_position_deg):
        return Turn(_arrived(state, activity.stow))
    if state.now >= run.until:
        fail(state, not_arrived(state))
        return Turn(state.activity)
    return Turn(activity, run.command, target_of(state, run.target, feedback))


def place(state: ControllerState, feedback: Feedback, name: StowName) -> AxisPair:
    """Return a stow position in axis angles; an azimuth that is not meant stays where it is."""
    config, pointing = state.config, state.memory.pointing
    near_deg = feedback.azimuth.position_deg
    if name is StowName.PARK:
        parked = aim(config, pointing, config.park, near_deg)
        return AxisPair(parked.azimuth_deg, parked.elevation_deg)
    spot = config.protection.stows.place(name)
    azimuth_deg = _facing_deg(state, feedback, name)
    if azimuth_deg is None:
        azimuth_deg = spot.azimuth_deg
    faced = sky(config, pointing, near_deg, feedback.elevation.position_deg)
    towards = Orientation(faced.azimuth_deg if azimuth_deg is None else azimuth_deg, spot.elevation_deg)
    target = aim(config, pointing, towards, near_deg)
    keeps = azimuth_deg is None and config.mount.kind is MountKind.AZIMUTH_ELEVATION
    return AxisPair(None if keeps else target.azimuth_deg, target.elevation_deg)


def not_stowed(state: ControllerState) -> Reason | None:
    """Return why the panel is not stowed although wind or snow demand it; None: it is, or is on its way."""
    wanted = guarding(state).stow
    if wanted is None or _is_stowed(state, wanted):
        return None
    why, hint = _because(state)
    text = say(
        "{name} is NOT STOWED, although {wanted} requires it: {why}",
        name=state.config.name,
        wanted=wanted,
        why=why,
    )
    return Reason("not_stowed", text, hint)


def _end_by_hand(state: ControllerState, by_weather: StowName | None) -> None:
    """Let a motion by hand go on for a few seconds, counted down before everybody's eyes, then end it."""
    if by_weather is None:
        forget_by_hand(state)
    elif not is_counted_down(state, HAND_GRACE):
        interrupt(state, reason(state))


def _end_show(state: ControllerState, activity: Showing, by_weather: StowName) -> None:
    """End a show for the weather; one that moved by itself is stowed and stays so."""
    why = reason(state)
    end_show(state, activity, say("The show ended early: {message}", message=why.message), "interrupted")
    hold(state)
    forget_setpoint(state)
    if activity.phase in MOVES_BY_ITSELF and state.memory.lock is None:
        state.remember(stow=by_weather)


def _keep_stowed(
    state: ControllerState, feedback: Feedback, activity: Stowing | Stowed, wanted: StowName | None
) -> None:
    if wanted is activity.stow:
        return
    if wanted is not None:
        _begin_by_itself(state, feedback, wanted)
        return
    _go_on(state)
    if isinstance(state.activity, Tracking):
        announce(state, say("{name} continues tracking.", name=state.config.name))


def _is_automatic(state: ControllerState, wanted: StowName) -> bool:
    """Return whether a person left the tracker in a state in which it may move by itself."""
    match state.activity:
        case Tracking():
            return True
        case Moving(kind=MoveKind.PARK):
            return wanted is not StowName.PARK
        case Holding():
            return _was_automatic(state) and wanted is not StowName.PARK and not _blocked(state)
        case _:
            return False


def _was_automatic(state: ControllerState) -> bool:
    """Return whether a tracker that holds was left automatic.

    It was by a command, by a show that the restart cut off, or by tracking that has waited since the restart.
    """
    if state.waiting.reason is not None:
        return state.waiting.untouched
    return state.memory.stow is not None or state.memory.show_moves


def _blocked(state: ControllerState) -> bool:
    return bool(unmet(state, Action.STOW))


def _begin_by_itself(state: ControllerState, feedback: Feedback, wanted: StowName) -> None:
    """Go to a stow position; after a show that the restart cut off the tracker stays there."""
    if state.memory.show_moves:
        state.remember(stow=wanted, show_moves=False)
    if isinstance(state.activity, Moving):
        leave(state, reason(state).message)
    _begin(state, feedback, wanted)
    if isinstance(state.activity, Stowing):
        announce(
            state, say("{name} goes to its {wanted} stow position.", name=state.config.name, wanted=wanted)
        )


def _begin(state: ControllerState, feedback: Feedback, name: StowName) -> None:
    """Be on the way to a stow position, or there at once."""
    call_off(state)
    forget_setpoint(state)
    if at_rest(feedback) and arrived(place(state, feedback, name), feedback, state.config.in_position_deg):
        begin(state, _arrived(state, name))
        return
    begin(state, Stowing(name))
    state.say(
        EventKind.STOW_STARTED,
        say("{name} goes to the stow position {name2}.", name=state.config.name, name2=name),
        stow=name,
    )


def _arrived(state: ControllerState, name: StowName) -> Stowed | Holding:
    text = say("{name} is in the stow position {name2}.", name=state.config.name, name2=name)
    state.say(EventKind.STOW_ENDED, text, stow=name, outcome="in_position")
    return HOLDING if name is StowName.PARK else Stowed(name)


def _go_on(state: ControllerState) -> None:
    """Track again where tracking is on and lacks nothing, else hold."""
    call_off(state)
    if not state.memory.tracking_on or state.waiting.reason is not None:
        hold(state)
        return
    begin(state, Tracking())
    state.say(EventKind.TRACKING_RESUMED, N_("Tracking continues after the stow."), mode=state.memory.mode)


def _facing_deg(state: ControllerState, feedback: Feedback, name: StowName) -> float | None:
    """Return the azimuth that turns the panel's back or its nearer edge into the wind."""
    facing = state.config.protection.wind.facing
    wind_from_deg = state.seen.weather.wind_from_deg if state.seen else None
    if name is not StowName.WIND or wind_from_deg is None or facing is Facing.ANYTHING:
        return None
    if facing is Facing.BACK:
        return (wind_from_deg + 180.0) % 360.0
    faced = sky(
        state.config, state.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg
    )
    to_right_deg = (wind_from_deg + 90.0) % 360.0
    off_deg = abs((to_right_deg - faced.azimuth_deg + 180.0) % 360.0 - 180.0)
    return to_right_deg if off_deg <= 90.0 else (to_right_deg + 180.0) % 360.0


def _is_stowed(state: ControllerState, wanted: StowName) -> bool:
    """Return whether the panel is in the position, or on its way, or stands there though nobody sent it."""
    if state.connection.lost or state.feedback is None or isinstance(state.activity, Faulted):
        return False
    if isinstance(state.activity, Stowing | Stowed):
        return state.activity.stow is wanted or state.activity.stow is demanded_stow(state)
    if isinstance(state.activity, Moving) and state.activity.kind is MoveKind.PARK:
        return False
    if state.memory.home is None or not at_rest(state.feedback):
        return False
    return arrived(place(state, state.feedback, wanted), state.feedback, state.config.in_position_deg)


def _because(state: ControllerState) -> tuple[Message, Message]:
    """Return what keeps the tracker from its stow position, and what to do."""
    against = unmet(state, Action.STOW)
    if against:
        return join(" ", (one.message for one in against)), against[0].hint
    wait = state.waiting.reason
    if wait is not None:
        again = N_("Press Stow. Start tracking also stows the panel first.")
        return wait.message, wait.hint if wait.code in BARRED else again
    return (
        N_("the tracker is in manual and does not move automatically."),
        N_("Clear the area, then press Stow; or jog the panel."),
    )
