"""Where the axes were told to go, and what the light sensors add to it; nobody else writes that."""

from app.tracker.motion.hybrid import Corrected
from app.tracker.state.activity import AxisPair
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.parts import NO_SETPOINTS, NOWHERE
from app.tracker.values.motion import AxisCommand, DriveCommand, Halt, Position


def note_setpoint(state: ControllerState, command: DriveCommand) -> None:
    """Keep where the axes are told to go by this command."""
    before = state.setpoints.axes
    axes = AxisPair(
        _setpoint_deg(command.azimuth, before.azimuth_deg),
        _setpoint_deg(command.elevation, before.elevation_deg),
    )
    if axes != before:
        state.setpoints = state.setpoints._replace(axes=axes)


def forget_setpoint(state: ControllerState) -> None:
    """Go by no setpoint until the next motion."""
    state.setpoints = state.setpoints._replace(axes=NOWHERE)


def note_correction(state: ControllerState, correction: Corrected) -> None:
    """Keep what the light sensors add."""
    state.setpoints = state.setpoints._replace(correction=correction)


def forget_correction(state: ControllerState) -> None:
    """Begin the search of the light sensors anew."""
    state.setpoints = state.setpoints._replace(correction=None)


def forget_setpoints(state: ControllerState) -> None:
    """Go by neither setpoint nor correction: the angles mean something else from now on."""
    state.setpoints = NO_SETPOINTS


def _setpoint_deg(command: AxisCommand, before_deg: float | None) -> float | None:
    match command:
        case Position():
            return command.position_deg
        case Halt():
            return before_deg
        case _:
            return None
