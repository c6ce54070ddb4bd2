"""Going to a place and staying there: moves, the park position and the operator's small steps."""

from math import isfinite

from app.base.message import N_, Message, say, with_format
from app.tracker.access.interlocks import Action, demand_drive
from app.tracker.activities import drive_testing
from app.tracker.commands.commands import Move, Step
from app.tracker.commissioning.selection import at_orientation, confirm_mode, out_of_reach
from app.tracker.motion.guards import axis_feedback
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.mounts.mount import aim, sky
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation
from app.tracker.settings.protections import StowName
from app.tracker.state.activity import HOLDING, AxisPair, MoveKind, Moving
from app.tracker.state.announce import announce_if_remote, begins_at
from app.tracker.state.axis_demand import paced
from app.tracker.state.controller_state import ControllerState, Turn
from app.tracker.state.positioning import arrived, new_run
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, fail, hold, switch_tracking_off
from app.tracker.supervision.regions import entered, forbidden
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason

LARGEST_STEP_DEG = 5.0


def move(state: ControllerState, command: Move) -> None:
    """Go to an orientation, or raise `CommandRejected`."""
    feedback = demand_drive(
        state, Action.MOVE, out_of_reach(state, command.orientation), _in_the_way(state, command.orientation)
    )
    switch_tracking_off(state, N_("a move was commanded."))
    _go(state, feedback, command.orientation, MoveKind.MOVE)


def park(state: ControllerState) -> None:
    """Go to the park position, or raise `CommandRejected`."""
    feedback = demand_drive(state, Action.PARK)
    switch_tracking_off(state, N_("the tracker is being parked."))
    state.remember(stow=StowName.PARK)
    _go(state, feedback, state.config.park, MoveKind.PARK)


def step_by(state: ControllerState, command: Step) -> None:
    """Move one axis by an increment, also before homing, or raise `CommandRejected`."""
    feedback = demand_drive(state, Action.STEP, _step_size(command), _step_room(state, command))
    switch_tracking_off(state, N_("the tracker is being jogged."))
    target_deg = axis_feedback(feedback, command.axis).position_deg + command.delta_deg
    on_azimuth = command.axis is Axis.AZIMUTH
    target = AxisPair(target_deg if on_azimuth else None, None if on_azimuth else target_deg)
    text = say(
        "Incremental jog of {mount} by {degrees} degrees.",
        mount=axis_title(state.config.mount, command.axis),
        degrees=with_format(command.delta_deg, "+g"),
    )
    _begin(state, feedback, target, MoveKind.STEP, text)


def step(state: ControllerState, moving: Moving, feedback: Feedback) -> Turn:
    """Go on until both axes stand at the target; a move that does not arrive in time is a fault."""
    run = moving.run
    if arrived(run.target, feedback, state.config.in_position_deg):
        hold(state)
        state.say(
            EventKind.MOVE_ENDED, N_("The panel is in position."), outcome="in_position", move=moving.kind
        )
        drive_testing.arrived(state, moving, feedback)
        if at_orientation(state, feedback):
            confirm_mode(state, moving.actor)
        return Turn(HOLDING)
    if state.now >= run.until:
        fail(state, not_arrived(state))
        return Turn(state.activity)
    return Turn(moving, run.command, target_of(state, run.target, feedback))


def not_arrived(state: ControllerState) -> Reason:
    """Return that a motion took more than twice the time it should."""
    return Reason(
        "move_overdue",
        say("{name} did not arrive within twice the expected time.", name=state.config.name),
        N_("Check the axes for obstructions, check the drive, then reset the fault."),
    )


def target_of(state: ControllerState, target: AxisPair, feedback: Feedback) -> Orientation:
    """Return axis targets as a direction of the sky; an axis that is not meant counts where it is."""
    azimuth_deg = feedback.azimuth.position_deg if target.azimuth_deg is None else target.azimuth_deg
    elevation_deg = feedback.elevation.position_deg if target.elevation_deg is None else target.elevation_deg
    return sky(state.config, state.memory.pointing, azimuth_deg, elevation_deg)


def _go(state: ControllerState, feedback: Feedback, orientation: Orientation, kind: MoveKind) -> None:
    target = aim(state.config, state.memory.pointing, orientation, feedback.azimuth.position_deg)
    place = say(
        "azimuth {azimuth_deg}, elevation {elevation_deg} degrees",
        azimuth_deg=with_format(orientation.azimuth_deg, ".1f"),
        elevation_deg=with_format(orientation.elevation_deg, ".1f"),
    )
    pair = AxisPair(target.azimuth_deg, target.elevation_deg)
    _begin(state, feedback, pair, kind, say("Going to {place}.", place=place))


def _begin(
    state: ControllerState, feedback: Feedback, target: AxisPair, kind: MoveKind, text: Message
) -> None:
    announce_if_remote(state, text)
    run = new_run(paced(state), feedback, target, begins_at(state), by_hand=kind is MoveKind.STEP)
    begin(state, Moving(kind, run, state.actor))
    state.say(EventKind.MOVE_STARTED, text, move=kind)


def _in_the_way(state: ControllerState, orientation: Orientation) -> Reason | None:
    """Return the forbidden region that a move would lead through."""
    feedback = state.feedback
    if feedback is None or not state.config.machine.regions:
        return None
    target = aim(state.config, state.memory.pointing, orientation, feedback.azimuth.position_deg)
    pair = AxisPair(target.azimuth_deg, target.elevation_deg)
    run = new_run(paced(state), feedback, pair, state.now)
    region = entered(state.config, run.command, feedback)
    return None if region is None else forbidden(state.config, region)


def _step_size(command: Step) -> Reason | None:
    if isfinite(command.delta_deg) and 0.0 < abs(command.delta_deg) <= LARGEST_STEP_DEG:
        return None
    return Reason(
        "step_size",
        (
            say(
                "An increment may be up to {largest_step_deg} degrees in either direction, not {degrees}.",
                largest_step_deg=with_format(LARGEST_STEP_DEG, "g"),
                degrees=with_format(command.delta_deg, "g"),
            )
        ),
        N_("Use 0.1, 1, or 5 degrees."),
    )


def _step_room(state: ControllerState, command: Step) -> Reason | None:
    if state.feedback is None or state.memory.home is None:
        return None
    config = state.config.axis(command.axis)
    position_deg = axis_feedback(state.feedback, command.axis).position_deg
    if config.beyond_deg(position_deg + command.delta_deg) <= config.beyond_deg(position_deg):
        return None
    return Reason(
        "at_soft_limit",
        say(
            "This increment would move the {config} beyond its soft limit.",
            config=axis_of(state.config, command.axis),
        ),
        N_("Use a smaller increment, or move in the opposite direction."),
    )
