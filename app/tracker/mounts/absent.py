"""The second axis of a mount that has none: it stands at its fixed angle, homed, and is not moved."""

from dataclasses import replace

from app.tracker.config import TrackerConfig
from app.tracker.motion import HALT, AxisFeedback, DriveCommand, Feedback, Position
from app.tracker.mounts.abilities import abilities
from app.tracker.mounts.kinematics import fixed_deg
from app.tracker.reason import Reason


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
        f"{config.name} stands on a {known.title.lower()} and has no second axis.",
        f"Use its first axis, {known.first.title.lower()}.",
    )


def for_drive(config: TrackerConfig, command: DriveCommand) -> DriveCommand:
    """Return a command that does not send an axis anywhere that the mount does not have."""
    if config.mount.single_axis and isinstance(command.elevation, Position):
        return replace(command, elevation=HALT)
    return command
