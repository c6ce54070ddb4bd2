"""Going to a stow position, by command or because the weather demands it, and going on afterwards.

A tracker moves by itself only while it is automatic: it tracks, runs a show, or was parked or stowed by
command. Stopped, moved by hand, homing or being proved it stays where it is, whatever the wind does, and
says that it is not stowed.
"""

from dataclasses import replace
from datetime import timedelta

from app.tracker.activities.moving import not_arrived, target_of
from app.tracker.activity import (
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
from app.tracker.announce import announce, announce_if_remote
from app.tracker.axis_demand import paced
from app.tracker.commands import Stow
from app.tracker.config import MountKind, Orientation
from app.tracker.controller_state import NOWHERE, ControllerState, Turn
from app.tracker.interlocks import Action, demand, demand_drive, unmet
from app.tracker.motion import Feedback
from app.tracker.mount import aim, sky
from app.tracker.positioning import arrived, at_rest, new_run
from app.tracker.protections.words import Facing, StowName
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind, ShowPhase
from app.tracker.transitions import end_show, fail, interrupt, leave
from app.tracker.weather_protection import demanded_stow, guarding, reason

HAND_GRACE = timedelta(seconds=5)
"""For so long a motion by hand goes on when the weather demands a stow."""
BY_HAND = (MoveKind.MOVE, MoveKind.STEP)
STOW_ACTIVITIES = (Stowing, Stowed)
MOVES_BY_ITSELF = (ShowPhase.GOING_TO_START, ShowPhase.RUNNING)


def stow(mind: ControllerState, command: Stow) -> None:
    """Go to a stow position and stay there until `Resume`, or raise `CommandRejected`."""
    feedback = demand_drive(mind, Action.STOW)
    mind.wait = mind.warning = None
    if isinstance(mind.activity, Moving):
        leave(mind, "a stow position was commanded.")
    mind.remember(stow=command.position)
    if demanded_stow(mind) is command.position:
        _begin(mind, feedback, command.position)
        announce_if_remote(mind, f"{mind.config.name} goes to its stow position.")


def resume(mind: ControllerState) -> None:
    """Leave a stow position that was commanded, or raise `CommandRejected`; tracking goes on if it was on."""
    demand(mind, Action.RESUME)
    mind.remember(stow=None)
    if isinstance(mind.activity, Stowing | Stowed) and demanded_stow(mind) is None:
        _go_on(mind)
        announce_if_remote(mind, f"{mind.config.name} continues tracking.")


def guard(mind: ControllerState, feedback: Feedback) -> None:
    """Let the weather and the commanded stow have their way before the activity's own step."""
    activity, wanted = mind.activity, demanded_stow(mind)
    if wanted is None and not isinstance(activity, STOW_ACTIVITIES):
        mind.hand_until = None
        return
    by_weather = guarding(mind).stow
    if isinstance(activity, Jogging) or (isinstance(activity, Moving) and activity.kind in BY_HAND):
        _end_by_hand(mind, by_weather)
        return
    mind.hand_until = None
    if isinstance(activity, Showing):
        if by_weather is not None:
            _end_show(mind, activity, by_weather)
        return
    if isinstance(activity, STOW_ACTIVITIES):
        _keep_stowed(mind, feedback, activity, wanted)
    elif wanted is not None and _is_automatic(mind, wanted):
        _begin_by_itself(mind, feedback, wanted)


def step(mind: ControllerState, activity: Stowing | Stowed, feedback: Feedback) -> Turn:
    """Go on until the panel is stowed; one that does not arrive in time is a fault."""
    if isinstance(activity, Stowed):
        return Turn(activity)
    if activity.run is None:
        run = new_run(paced(mind), feedback, place(mind, feedback, activity.stow), mind.now)
        activity = replace(activity, run=run)
    else:
        run = activity.run
    if arrived(run.target, feedback, mind.config.in_position_deg):
        return Turn(_arrived(mind, activity.stow))
    if mind.now >= run.until:
        fail(mind, not_arrived(mind))
        return Turn(mind.activity)
    return Turn(activity, run.command, target_of(mind, run.target, feedback))


def place(mind: ControllerState, feedback: Feedback, name: StowName) -> AxisPair:
    """Return a stow position in axis angles; an azimuth that is not meant stays where it is."""
    config, pointing = mind.config, mind.memory.pointing
    near_deg = feedback.azimuth.position_deg
    if name is StowName.PARK:
        parked = aim(config, pointing, config.park, near_deg)
        return AxisPair(parked.azimuth_deg, parked.elevation_deg)
    spot = config.protection.stows.place(name)
    azimuth_deg = _facing_deg(mind, feedback, name)
    if azimuth_deg is None:
        azimuth_deg = spot.azimuth_deg
    faced = sky(config, pointing, near_deg, feedback.elevation.position_deg)
    towards = Orientation(faced.azimuth_deg if azimuth_deg is None else azimuth_deg, spot.elevation_deg)
    target = aim(config, pointing, towards, near_deg)
    keeps = azimuth_deg is None and config.mount.kind is MountKind.AZIMUTH_ELEVATION
    return AxisPair(None if keeps else target.azimuth_deg, target.elevation_deg)


def not_stowed(mind: ControllerState) -> Reason | None:
    """Return why the panel is not stowed although wind or snow demand it; None: it is, or is on its way."""
    wanted = guarding(mind).stow
    if wanted is None or _is_stowed(mind, wanted):
        return None
    why, hint = _because(mind)
    text = f"{mind.config.name} is NOT STOWED, although {wanted} requires it: {why}"
    return Reason("not_stowed", text, hint)


def _end_by_hand(mind: ControllerState, by_weather: StowName | None) -> None:
    """Let a motion by hand go on for a few seconds, counted down before everybody's eyes, then end it."""
    if by_weather is None:
        mind.hand_until = None
    elif mind.hand_until is None:
        mind.hand_until = mind.now + HAND_GRACE
    elif mind.now >= mind.hand_until:
        mind.hand_until = None
        interrupt(mind, reason(mind))


def _end_show(mind: ControllerState, activity: Showing, by_weather: StowName) -> None:
    """End a show for the weather; one that moved by itself is stowed and stays so."""
    why = reason(mind)
    end_show(mind, activity, f"The show ended early: {why.message}", "interrupted")
    mind.activity, mind.setpoint = HOLDING, NOWHERE
    if activity.phase in MOVES_BY_ITSELF and mind.memory.lock is None:
        mind.remember(stow=by_weather)


def _keep_stowed(
    mind: ControllerState, feedback: Feedback, activity: Stowing | Stowed, wanted: StowName | None
) -> None:
    if wanted is activity.stow:
        return
    if wanted is not None:
        _begin_by_itself(mind, feedback, wanted)
        return
    _go_on(mind)
    if isinstance(mind.activity, Tracking):
        announce(mind, f"{mind.config.name} continues tracking.")


def _is_automatic(mind: ControllerState, wanted: StowName) -> bool:
    """Return whether a person left the tracker in a state in which it may move by itself."""
    match mind.activity:
        case Tracking():
            return True
        case Moving(kind=MoveKind.PARK):
            return wanted is not StowName.PARK
        case Holding():
            return _was_automatic(mind) and wanted is not StowName.PARK and not _blocked(mind)
        case _:
            return False


def _was_automatic(mind: ControllerState) -> bool:
    """Return whether a tracker that holds was left automatic.

    It was by a command, by a show that the restart cut off, or by tracking that has waited since the restart.
    """
    if mind.wait is not None:
        return mind.wait is mind.held_back
    return mind.memory.stow is not None or mind.memory.show_moves


def _blocked(mind: ControllerState) -> bool:
    return bool(unmet(mind, Action.STOW))


def _begin_by_itself(mind: ControllerState, feedback: Feedback, wanted: StowName) -> None:
    """Go to a stow position; after a show that the restart cut off the tracker stays there."""
    if mind.memory.show_moves:
        mind.remember(stow=wanted, show_moves=False)
    if isinstance(mind.activity, Moving):
        leave(mind, reason(mind).message)
    _begin(mind, feedback, wanted)
    if isinstance(mind.activity, Stowing):
        announce(mind, f"{mind.config.name} goes to its {wanted} stow position.")


def _begin(mind: ControllerState, feedback: Feedback, name: StowName) -> None:
    """Be on the way to a stow position, or there at once."""
    mind.warning, mind.setpoint = None, NOWHERE
    if at_rest(feedback) and arrived(place(mind, feedback, name), feedback, mind.config.in_position_deg):
        mind.activity = _arrived(mind, name)
        return
    mind.activity = Stowing(name)
    mind.say(EventKind.STOW_STARTED, f"{mind.config.name} goes to the stow position {name}.", stow=name)


def _arrived(mind: ControllerState, name: StowName) -> Stowed | Holding:
    text = f"{mind.config.name} is in the stow position {name}."
    mind.say(EventKind.STOW_ENDED, text, stow=name, outcome="in_position")
    return HOLDING if name is StowName.PARK else Stowed(name)


def _go_on(mind: ControllerState) -> None:
    """Track again where tracking is on and lacks nothing, else hold."""
    mind.warning = None
    if not mind.memory.tracking_on or mind.wait is not None:
        mind.activity = HOLDING
        return
    mind.activity = Tracking()
    mind.say(EventKind.TRACKING_RESUMED, "Tracking continues after the stow.", mode=mind.memory.mode)


def _facing_deg(mind: ControllerState, feedback: Feedback, name: StowName) -> float | None:
    """Return the azimuth that turns the panel's back or its nearer edge into the wind."""
    facing = mind.config.protection.wind.facing
    wind_from_deg = mind.seen.weather.wind_from_deg if mind.seen else None
    if name is not StowName.WIND or wind_from_deg is None or facing is Facing.ANYTHING:
        return None
    if facing is Facing.BACK:
        return (wind_from_deg + 180.0) % 360.0
    faced = sky(
        mind.config, mind.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg
    )
    to_right_deg = (wind_from_deg + 90.0) % 360.0
    off_deg = abs((to_right_deg - faced.azimuth_deg + 180.0) % 360.0 - 180.0)
    return to_right_deg if off_deg <= 90.0 else (to_right_deg + 180.0) % 360.0


def _is_stowed(mind: ControllerState, wanted: StowName) -> bool:
    """Return whether the panel is in the position, or on its way, or stands there though nobody sent it."""
    if mind.lost or mind.feedback is None or isinstance(mind.activity, Faulted):
        return False
    if isinstance(mind.activity, Stowing | Stowed):
        return mind.activity.stow is wanted or mind.activity.stow is demanded_stow(mind)
    if isinstance(mind.activity, Moving) and mind.activity.kind is MoveKind.PARK:
        return False
    if mind.memory.home is None or not at_rest(mind.feedback):
        return False
    return arrived(place(mind, mind.feedback, wanted), mind.feedback, mind.config.in_position_deg)


def _because(mind: ControllerState) -> tuple[str, str]:
    """Return what keeps the tracker from its stow position, and what to do."""
    against = unmet(mind, Action.STOW)
    if against:
        return " ".join(one.message for one in against), against[0].hint
    if mind.wait is not None:
        return mind.wait.message, "Press Stow. Start tracking also stows the panel first."
    return (
        "the tracker is in manual and does not move automatically.",
        "Clear the area, then press Stow; or jog the panel.",
    )
