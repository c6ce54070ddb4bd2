"""What the operator selects: mode and orientation, and whether the panel has been there."""

from math import isfinite

from app.angles import separation_deg, wrap180
from app.sun.trigonometry import SCALAR
from app.tracker.commands import SelectMode
from app.tracker.config import Orientation, TrackerConfig
from app.tracker.controller_state import ControllerState
from app.tracker.interlocks import Action, demand
from app.tracker.memory import Confirmation, StepName
from app.tracker.mode import Mode
from app.tracker.motion import Feedback
from app.tracker.mount import aim, sky
from app.tracker.mounts.kinematics import FIRST_FOLLOWS, SECOND_FOLLOWS, angles, direction
from app.tracker.mounts.missing_axes import mode_absent
from app.tracker.positioning import at_rest
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind


def select_mode(mind: ControllerState, command: SelectMode) -> None:
    """Store mode and orientation, or raise `CommandRejected`; step 4 is done once the panel is there."""
    orientation = command.orientation or mind.memory.orientation
    impossible = mode_absent(mind.config, command.mode)
    beyond = None if impossible else _held_out_of_reach(mind, command.mode, orientation)
    demand(mind, Action.SET_MODE, impossible, beyond)
    confirmations = {
        step: saved for step, saved in mind.memory.confirmations.items() if step is not StepName.MODE
    }
    mind.remember(mode=command.mode, orientation=orientation, confirmations=confirmations)
    mind.say(EventKind.MODE_SELECTED, f"Mode {command.mode} selected.", mode=command.mode)
    if mind.feedback is not None and not mind.misses and at_orientation(mind, mind.feedback):
        confirm_mode(mind, mind.actor)


def at_orientation(mind: ControllerState, feedback: Feedback) -> bool:
    """Return whether the panel stands where the selected mode holds it; dual-axis holds nothing."""
    mode = mind.memory.mode
    if mode is None:
        return False
    if mode is Mode.DUAL or (mind.config.mount.single_axis and mode is not Mode.FIXED):
        return True
    if mind.memory.home is None or not at_rest(feedback):
        return False
    off_deg = _off_held_deg(mind, mode, feedback)
    return off_deg <= mind.config.in_position_deg


def confirm_mode(mind: ControllerState, actor: str) -> None:
    """Remember that step 4 is done, for the present location."""
    confirm_step(mind, StepName.MODE, actor)


def confirm_step(mind: ControllerState, step: StepName, actor: str) -> None:
    """Remember that a step is done, for the present location."""
    revision = mind.seen.location_revision if mind.seen else 0
    saved = Confirmation(mind.site_time, actor, revision)
    mind.remember(confirmations={**mind.memory.confirmations, step: saved})


def out_of_reach(mind: ControllerState, orientation: Orientation) -> Reason | None:
    """Return that an orientation lies beyond the soft limits by more than the deadband."""
    config = mind.config
    if isfinite(orientation.azimuth_deg) and isfinite(orientation.elevation_deg):
        orientation = _nearest(config, orientation)
        reached = aim(config, mind.memory.pointing, orientation, _near_deg(mind))
        if not reached.limited:
            return None
        faced = sky(config, mind.memory.pointing, reached.azimuth_deg, reached.elevation_deg)
        off_deg = separation_deg(
            faced.azimuth_deg, faced.elevation_deg, orientation.azimuth_deg, orientation.elevation_deg
        )
        if off_deg <= config.deadband_deg:
            return None
    return Reason(
        "beyond_limits",
        f"{config.name} cannot face azimuth {orientation.azimuth_deg:g}, elevation "
        f"{orientation.elevation_deg:g} degrees: {_ranges(config)}.",
        "Choose an orientation within the soft limits.",
    )


def _ranges(config: TrackerConfig) -> str:
    """Return how far the axes turn, in a part of a sentence."""
    turns = [
        f"from {config.axis(axis).minimum_deg:g} to {config.axis(axis).maximum_deg:g}"
        for axis in config.mount.axes
    ]
    return f"its {'axis turns' if len(turns) == 1 else 'axes turn'} {' and '.join(turns)} degrees"


def _nearest(config: TrackerConfig, orientation: Orientation) -> Orientation:
    """Return the direction that a single axis means by an orientation: the nearest that it can face."""
    if not config.mount.single_axis:
        return orientation
    held = angles(config.mount, orientation.azimuth_deg, orientation.elevation_deg, SCALAR)
    return Orientation(*direction(config.mount, *held, SCALAR))


def _held_out_of_reach(mind: ControllerState, mode: Mode, orientation: Orientation) -> Reason | None:
    """Judge only the axes that the mode holds: the others are judged in the middle of their range."""
    config = mind.config
    if mode is Mode.FIXED:
        return out_of_reach(mind, orientation)
    if mode is Mode.DUAL or config.mount.single_axis:
        return None
    first_deg, second_deg = angles(config.mount, orientation.azimuth_deg, orientation.elevation_deg, SCALAR)
    if mode in FIRST_FOLLOWS:
        first_deg = (config.azimuth.minimum_deg + config.azimuth.maximum_deg) / 2.0
    if mode in SECOND_FOLLOWS:
        second_deg = (config.elevation.minimum_deg + config.elevation.maximum_deg) / 2.0
    return out_of_reach(mind, Orientation(*direction(config.mount, first_deg, second_deg, SCALAR)))


def _off_held_deg(mind: ControllerState, mode: Mode, feedback: Feedback) -> float:
    """Return how far the axes that the mode holds are off, the larger of both."""
    config, held = mind.config, mind.memory.orientation
    stands = sky(config, mind.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg)
    faced = angles(config.mount, stands.azimuth_deg, stands.elevation_deg, SCALAR)
    wanted = angles(config.mount, held.azimuth_deg, held.elevation_deg, SCALAR)
    first_deg = 0.0 if mode in FIRST_FOLLOWS else abs(wrap180(faced[0] - wanted[0]))
    second_deg = 0.0 if mode in SECOND_FOLLOWS else abs(faced[1] - wanted[1])
    return max(first_deg, second_deg)


def _near_deg(mind: ControllerState) -> float:
    return mind.feedback.azimuth.position_deg if mind.feedback else mind.config.azimuth.minimum_deg
