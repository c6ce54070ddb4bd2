"""What the operator selects: mode and orientation, and whether the panel has been there."""

from math import isfinite
from typing import assert_never

from app.angles import separation_deg, wrap180
from app.tracker.commands import SelectMode
from app.tracker.conditions import Action, demand
from app.tracker.config import Orientation
from app.tracker.memory import Confirmation, StepName
from app.tracker.mind import Mind
from app.tracker.mode import Mode
from app.tracker.motion import Feedback
from app.tracker.mount import aim, sky
from app.tracker.reason import Reason
from app.tracker.runs import at_rest
from app.tracker.snapshot import EventKind


def select_mode(mind: Mind, command: SelectMode) -> None:
    """Store mode and orientation, or raise `CommandRejected`; step 4 is done once the panel is there."""
    orientation = command.orientation or mind.memory.orientation
    demand(mind, Action.SET_MODE, _held_out_of_reach(mind, command.mode, orientation))
    confirmations = {
        step: saved for step, saved in mind.memory.confirmations.items() if step is not StepName.MODE
    }
    mind.remember(mode=command.mode, orientation=orientation, confirmations=confirmations)
    mind.say(EventKind.MODE_SELECTED, f"Mode {command.mode} selected.", mode=command.mode)
    if mind.feedback is not None and not mind.misses and at_orientation(mind, mind.feedback):
        confirm_mode(mind, mind.actor)


def at_orientation(mind: Mind, feedback: Feedback) -> bool:
    """Return whether the panel stands where the selected mode holds it; dual-axis holds nothing."""
    mode = mind.memory.mode
    if mode is None:
        return False
    if mode is Mode.DUAL:
        return True
    if mind.memory.home is None or not at_rest(feedback):
        return False
    off_deg = _off_held_deg(mind, mode, feedback)
    return off_deg <= mind.config.in_position_deg


def confirm_mode(mind: Mind, actor: str) -> None:
    """Remember that step 4 is done, for the present location."""
    confirm_step(mind, StepName.MODE, actor)


def confirm_step(mind: Mind, step: StepName, actor: str) -> None:
    """Remember that a step is done, for the present location."""
    revision = mind.seen.location_revision if mind.seen else 0
    saved = Confirmation(mind.site_time, actor, revision)
    mind.remember(confirmations={**mind.memory.confirmations, step: saved})


def out_of_reach(mind: Mind, orientation: Orientation) -> Reason | None:
    """Return that an orientation lies beyond the soft limits by more than the deadband."""
    config = mind.config
    if isfinite(orientation.azimuth_deg) and isfinite(orientation.elevation_deg):
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
        f"{orientation.elevation_deg:g} degrees: its axes turn from {config.azimuth.minimum_deg:g} to "
        f"{config.azimuth.maximum_deg:g} and from {config.elevation.minimum_deg:g} to "
        f"{config.elevation.maximum_deg:g} degrees.",
        "Choose an orientation within the soft limits.",
    )


def _held_out_of_reach(mind: Mind, mode: Mode, orientation: Orientation) -> Reason | None:
    """Judge only the axes that the mode holds: the others are judged in the middle of their range."""
    azimuth, elevation = mind.config.azimuth, mind.config.elevation
    middle_azimuth_deg = (azimuth.minimum_deg + azimuth.maximum_deg) / 2.0
    middle_elevation_deg = (elevation.minimum_deg + elevation.maximum_deg) / 2.0
    match mode:
        case Mode.FIXED:
            return out_of_reach(mind, orientation)
        case Mode.AZIMUTH:
            return out_of_reach(mind, Orientation(middle_azimuth_deg, orientation.elevation_deg))
        case Mode.ELEVATION:
            return out_of_reach(mind, Orientation(orientation.azimuth_deg, middle_elevation_deg))
        case Mode.DUAL:
            return None
    assert_never(mode)


def _off_held_deg(mind: Mind, mode: Mode, feedback: Feedback) -> float:
    """Return how far the axes that the mode holds are off, the larger of both."""
    faced = sky(
        mind.config, mind.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg
    )
    held = mind.memory.orientation
    azimuth_deg = abs(wrap180(faced.azimuth_deg - held.azimuth_deg)) if mode is not Mode.AZIMUTH else 0.0
    elevation_deg = abs(faced.elevation_deg - held.elevation_deg) if mode is not Mode.ELEVATION else 0.0
    return max(azimuth_deg, elevation_deg)


def _near_deg(mind: Mind) -> float:
    return mind.feedback.azimuth.position_deg if mind.feedback else mind.config.azimuth.minimum_deg
