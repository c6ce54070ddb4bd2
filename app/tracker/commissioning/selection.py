"""What the operator selects: mode and orientation, and whether the panel has been there."""

from math import isfinite

from app.base.angles import separation_deg, wrap180
from app.base.message import N_, Message, join, say, with_format
from app.sun.trigonometry import SCALAR
from app.tracker.access.interlocks import Action, demand
from app.tracker.commands.commands import SelectMode
from app.tracker.memory.memory import Confirmation, StepName
from app.tracker.mounts.kinematics import FIRST_FOLLOWS, SECOND_FOLLOWS, angles, direction
from app.tracker.mounts.missing_axes import mode_absent
from app.tracker.mounts.mount import aim, sky
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.positioning import at_rest
from app.tracker.state.snapshot import EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason


def select_mode(state: ControllerState, command: SelectMode) -> None:
    """Store mode and orientation, or raise `CommandRejected`; step 4 is done once the panel is there."""
    orientation = command.orientation or state.memory.orientation
    impossible = mode_absent(state.config, command.mode)
    beyond = None if impossible else _held_out_of_reach(state, command.mode, orientation)
    demand(state, Action.SET_MODE, impossible, beyond)
    confirmations = {
        step: saved for step, saved in state.memory.confirmations.items() if step is not StepName.MODE
    }
    state.remember(mode=command.mode, orientation=orientation, confirmations=confirmations)
    state.say(EventKind.MODE_SELECTED, say("Mode {mode} selected.", mode=command.mode), mode=command.mode)
    if state.feedback is not None and not state.connection.misses and at_orientation(state, state.feedback):
        confirm_mode(state, state.actor)


def at_orientation(state: ControllerState, feedback: Feedback) -> bool:
    """Return whether the panel stands where the selected mode holds it; dual-axis holds nothing."""
    mode = state.memory.mode
    if mode is None:
        return False
    if mode is Mode.DUAL or (state.config.mount.single_axis and mode is not Mode.FIXED):
        return True
    if state.memory.home is None or not at_rest(feedback):
        return False
    off_deg = _off_held_deg(state, mode, feedback)
    return off_deg <= state.config.in_position_deg


def confirm_mode(state: ControllerState, actor: str) -> None:
    """Remember that step 4 is done, for the present location."""
    confirm_step(state, StepName.MODE, actor)


def confirm_step(state: ControllerState, step: StepName, actor: str) -> None:
    """Remember that a step is done, for the present location."""
    revision = state.seen.location_revision if state.seen else 0
    saved = Confirmation(state.site_time, actor, revision)
    state.remember(confirmations={**state.memory.confirmations, step: saved})


def out_of_reach(state: ControllerState, orientation: Orientation) -> Reason | None:
    """Return that an orientation lies beyond the soft limits by more than the deadband."""
    config = state.config
    if isfinite(orientation.azimuth_deg) and isfinite(orientation.elevation_deg):
        orientation = _nearest(config, orientation)
        reached = aim(config, state.memory.pointing, orientation, _near_deg(state))
        if not reached.limited:
            return None
        faced = sky(config, state.memory.pointing, reached.azimuth_deg, reached.elevation_deg)
        off_deg = separation_deg(
            faced.azimuth_deg, faced.elevation_deg, orientation.azimuth_deg, orientation.elevation_deg
        )
        if off_deg <= config.deadband_deg:
            return None
    return Reason(
        "beyond_limits",
        say(
            "{name} cannot face azimuth {azimuth_deg}, elevation {elevation_deg} degrees: {config}.",
            name=config.name,
            azimuth_deg=with_format(orientation.azimuth_deg, "g"),
            elevation_deg=with_format(orientation.elevation_deg, "g"),
            config=_ranges(config),
        ),
        N_("Choose an orientation within the soft limits."),
    )


def _ranges(config: TrackerConfig) -> Message:
    """Return how far the axes turn, in a part of a sentence."""
    turns = [
        say(
            "from {minimum_deg} to {maximum_deg}",
            minimum_deg=with_format(config.axis(axis).minimum_deg, "g"),
            maximum_deg=with_format(config.axis(axis).maximum_deg, "g"),
        )
        for axis in config.mount.axes
    ]
    return (
        say("its axis turns {turns} degrees", turns=join(" and ", turns))
        if len(turns) == 1
        else say("its axes turn {turns} degrees", turns=join(" and ", turns))
    )


def _nearest(config: TrackerConfig, orientation: Orientation) -> Orientation:
    """Return the direction that a single axis means by an orientation: the nearest that it can face."""
    if not config.mount.single_axis:
        return orientation
    held = angles(config.mount, orientation.azimuth_deg, orientation.elevation_deg, SCALAR)
    return Orientation(*direction(config.mount, *held, SCALAR))


def _held_out_of_reach(state: ControllerState, mode: Mode, orientation: Orientation) -> Reason | None:
    """Judge only the axes that the mode holds: the others are judged in the middle of their range."""
    config = state.config
    if mode is Mode.FIXED:
        return out_of_reach(state, orientation)
    if mode is Mode.DUAL or config.mount.single_axis:
        return None
    first_deg, second_deg = angles(config.mount, orientation.azimuth_deg, orientation.elevation_deg, SCALAR)
    if mode in FIRST_FOLLOWS:
        first_deg = (config.azimuth.minimum_deg + config.azimuth.maximum_deg) / 2.0
    if mode in SECOND_FOLLOWS:
        second_deg = (config.elevation.minimum_deg + config.elevation.maximum_deg) / 2.0
    return out_of_reach(state, Orientation(*direction(config.mount, first_deg, second_deg, SCALAR)))


def _off_held_deg(state: ControllerState, mode: Mode, feedback: Feedback) -> float:
    """Return how far the axes that the mode holds are off, the larger of both."""
    config, held = state.config, state.memory.orientation
    stands = sky(
        config, state.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg
    )
    faced = angles(config.mount, stands.azimuth_deg, stands.elevation_deg, SCALAR)
    wanted = angles(config.mount, held.azimuth_deg, held.elevation_deg, SCALAR)
    first_deg = 0.0 if mode in FIRST_FOLLOWS else abs(wrap180(faced[0] - wanted[0]))
    second_deg = 0.0 if mode in SECOND_FOLLOWS else abs(faced[1] - wanted[1])
    return max(first_deg, second_deg)


def _near_deg(state: ControllerState) -> float:
    return state.feedback.azimuth.position_deg if state.feedback else state.config.azimuth.minimum_deg
