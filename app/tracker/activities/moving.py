"""Going to a place and staying there: moves, the park position and the operator's small steps."""

from math import isfinite

from app.tracker.activities import drive_testing
from app.tracker.activity import HOLDING, AxisPair, MoveKind, Moving
from app.tracker.announce import announce_if_remote, begins_at
from app.tracker.axes import Axis
from app.tracker.axis_demand import paced
from app.tracker.commands import Move, Step
from app.tracker.config import Orientation
from app.tracker.controller_state import ControllerState, Turn
from app.tracker.guards import axis_feedback
from app.tracker.interlocks import Action, demand_drive
from app.tracker.motion import Feedback
from app.tracker.mount import aim, sky
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.positioning import arrived, new_run
from app.tracker.protections.words import StowName
from app.tracker.reason import Reason
from app.tracker.regions import entered, forbidden
from app.tracker.selection import at_orientation, confirm_mode, out_of_reach
from app.tracker.snapshot import EventKind
from app.tracker.transitions import fail, switch_tracking_off

LARGEST_STEP_DEG = 5.0


def move(mind: ControllerState, command: Move) -> None:
    """Go to an orientation, or raise `CommandRejected`."""
    feedback = demand_drive(
        mind, Action.MOVE, out_of_reach(mind, command.orientation), _in_the_way(mind, command.orientation)
    )
    switch_tracking_off(mind, "a move was commanded.")
    _go(mind, feedback, command.orientation, MoveKind.MOVE)


def park(mind: ControllerState) -> None:
    """Go to the park position, or raise `CommandRejected`."""
    feedback = demand_drive(mind, Action.PARK)
    switch_tracking_off(mind, "the tracker is being parked.")
    mind.remember(stow=StowName.PARK)
    _go(mind, feedback, mind.config.park, MoveKind.PARK)


def step_by(mind: ControllerState, command: Step) -> None:
    """Move one axis by an increment, also before homing, or raise `CommandRejected`."""
    feedback = demand_drive(mind, Action.STEP, _step_size(command), _step_room(mind, command))
    switch_tracking_off(mind, "the tracker is being jogged.")
    target_deg = axis_feedback(feedback, command.axis).position_deg + command.degrees
    on_azimuth = command.axis is Axis.AZIMUTH
    target = AxisPair(target_deg if on_azimuth else None, None if on_azimuth else target_deg)
    text = (
        f"Incremental jog of {axis_title(mind.config.mount, command.axis)} by {command.degrees:+g} degrees."
    )
    _begin(mind, feedback, target, MoveKind.STEP, text)


def step(mind: ControllerState, moving: Moving, feedback: Feedback) -> Turn:
    """Go on until both axes stand at the target; a move that does not arrive in time is a fault."""
    run = moving.run
    if arrived(run.target, feedback, mind.config.in_position_deg):
        mind.activity = HOLDING
        mind.say(EventKind.MOVE_ENDED, "The panel is in position.", outcome="in_position", move=moving.kind)
        drive_testing.arrived(mind, moving, feedback)
        if at_orientation(mind, feedback):
            confirm_mode(mind, moving.actor)
        return Turn(HOLDING)
    if mind.now >= run.until:
        fail(mind, not_arrived(mind))
        return Turn(mind.activity)
    return Turn(moving, run.command, target_of(mind, run.target, feedback))


def not_arrived(mind: ControllerState) -> Reason:
    """Return that a motion took more than twice the time it should."""
    return Reason(
        "move_overdue",
        f"{mind.config.name} did not arrive within twice the expected time.",
        "Check the axes for obstructions, check the drive, then reset the fault.",
    )


def target_of(mind: ControllerState, target: AxisPair, feedback: Feedback) -> Orientation:
    """Return axis targets as a direction of the sky; an axis that is not meant counts where it is."""
    azimuth_deg = feedback.azimuth.position_deg if target.azimuth_deg is None else target.azimuth_deg
    elevation_deg = feedback.elevation.position_deg if target.elevation_deg is None else target.elevation_deg
    return sky(mind.config, mind.memory.pointing, azimuth_deg, elevation_deg)


def _go(mind: ControllerState, feedback: Feedback, orientation: Orientation, kind: MoveKind) -> None:
    target = aim(mind.config, mind.memory.pointing, orientation, feedback.azimuth.position_deg)
    place = f"azimuth {orientation.azimuth_deg:.1f}, elevation {orientation.elevation_deg:.1f} degrees"
    pair = AxisPair(target.azimuth_deg, target.elevation_deg)
    _begin(mind, feedback, pair, kind, f"Going to {place}.")


def _begin(mind: ControllerState, feedback: Feedback, target: AxisPair, kind: MoveKind, text: str) -> None:
    announce_if_remote(mind, text)
    run = new_run(paced(mind), feedback, target, begins_at(mind), by_hand=kind is MoveKind.STEP)
    mind.activity = Moving(kind, run, mind.actor)
    mind.say(EventKind.MOVE_STARTED, text, move=kind)


def _in_the_way(mind: ControllerState, orientation: Orientation) -> Reason | None:
    """Return the forbidden region that a move would lead through."""
    feedback = mind.feedback
    if feedback is None or not mind.config.machine.regions:
        return None
    target = aim(mind.config, mind.memory.pointing, orientation, feedback.azimuth.position_deg)
    pair = AxisPair(target.azimuth_deg, target.elevation_deg)
    run = new_run(paced(mind), feedback, pair, mind.now)
    region = entered(mind.config, run.command, feedback)
    return None if region is None else forbidden(mind.config, region)


def _step_size(command: Step) -> Reason | None:
    if isfinite(command.degrees) and 0.0 < abs(command.degrees) <= LARGEST_STEP_DEG:
        return None
    return Reason(
        "step_size",
        (
            f"An increment may be up to {LARGEST_STEP_DEG:g} degrees in either direction, not "
            f"{command.degrees:g}."
        ),
        "Use 0.1, 1, or 5 degrees.",
    )


def _step_room(mind: ControllerState, command: Step) -> Reason | None:
    if mind.feedback is None or mind.memory.home is None:
        return None
    config = mind.config.axis(command.axis)
    position_deg = axis_feedback(mind.feedback, command.axis).position_deg
    if config.beyond_deg(position_deg + command.degrees) <= config.beyond_deg(position_deg):
        return None
    return Reason(
        "at_soft_limit",
        f"This increment would move the {axis_of(mind.config, command.axis)} beyond its soft limit.",
        "Use a smaller increment, or move in the opposite direction.",
    )
