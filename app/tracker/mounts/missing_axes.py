"""What a mount does not have: modes, and a second axis, which stands at its fixed angle and is not moved."""

from dataclasses import replace

from app.base.message import Word, join, say
from app.tracker.mounts.capabilities import abilities
from app.tracker.mounts.kinematics import fixed_deg
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.mode import Mode
from app.tracker.values.motion import HALT, AxisFeedback, DriveCommand, Feedback, Position
from app.tracker.values.reason import Reason


def as_mounted(config: TrackerConfig, feedback: Feedback | None) -> Feedback | None:
    """Return a reading in which an axis that the mount does not have stands where it is fixed."""
    if feedback is None or not config.mount.single_axis:
        return feedback
    fixed = AxisFeedback(fixed_deg(config.mount), 0.0, moving=False, homed=True)
    return replace(feedback, elevation=fixed)


def absent_axis(config: TrackerConfig) -> Reason:
    """Return that the mount has no second axis."""
    known = abilities(config.mount)
    return Reason(
        "no_second_axis",
        say(
            "{name} has a {lower} mount and no second axis.",
            name=config.name,
            lower=Word(known.title.lower()),
        ),
        say("Use its first axis, {lower}.", lower=Word(known.first.title.lower())),
    )


def mode_absent(config: TrackerConfig, mode: Mode) -> Reason | None:
    """Return that the mount does not have a mode."""
    known = abilities(config.mount)
    if mode in known.modes:
        return None
    return Reason(
        "mode_not_possible",
        say(
            "{name} has a {lower} mount and does not support the mode {mode}.",
            name=config.name,
            lower=Word(known.title.lower()),
            mode=mode,
        ),
        say("Choose one of these: {modes}.", modes=join(", ", known.modes)),
    )


def for_drive(config: TrackerConfig, command: DriveCommand) -> DriveCommand:
    """Return a command that does not send an axis anywhere that the mount does not have."""
    if isinstance(command.elevation, Position) and config.mount.single_axis:
        return replace(command, elevation=HALT)
    return command
