"""What one reading of the drive says against going on. Each guard returns a reason, or None."""

from typing import assert_never

from app.tracker.axes import Axis, AxisConfig
from app.tracker.config import TrackerConfig
from app.tracker.following_error import AxisWatch
from app.tracker.memory import HomeTrust
from app.tracker.motion import (
    AxisCommand,
    AxisFeedback,
    Feedback,
    Halt,
    Position,
    Velocity,
)
from app.tracker.mounts.capabilities import axis_of, axis_words
from app.tracker.reason import Reason

JUMP_FACTOR = 1.5
JUMP_NOISE_DEG = 0.5


def axis_feedback(feedback: Feedback, axis: Axis) -> AxisFeedback:
    """Return what one axis reports."""
    return feedback.azimuth if axis is Axis.AZIMUTH else feedback.elevation


def drive_fault(name: str, feedback: Feedback) -> Reason | None:
    """Return the drive's own fault."""
    if feedback.fault_code == 0:
        return None
    return Reason(
        "drive_fault",
        f"The drive of {name} reports fault code {feedback.fault_code}.",
        "Look up the code in the drive's manual, remove the cause, then reset the fault.",
    )


def wiring_fault(config: TrackerConfig, feedback: Feedback) -> Reason | None:
    """Return the axis whose two limit switches are pressed at once, which no position can do."""
    for axis in Axis:
        seen = axis_feedback(feedback, axis)
        if seen.at_lower_limit and seen.at_upper_limit:
            return Reason(
                "limit_switch_wiring",
                (
                    f"Both limit switches of the {axis_of(config, axis)} are on at the same time, "
                    "which is impossible."
                ),
                "Check the wiring of the switches, then reset the fault.",
            )
    return None


def pressed_switches(config: TrackerConfig, feedback: Feedback) -> tuple[Reason, ...]:
    """Return every limit switch that is on alone, with the one way that is free."""
    return tuple(
        reason
        for axis in config.mount.axes
        if (reason := _pressed_switch(config, axis, axis_feedback(feedback, axis))) is not None
    )


def _pressed_switch(config: TrackerConfig, axis: Axis, seen: AxisFeedback) -> Reason | None:
    words = axis_words(config.mount, axis)
    if seen.at_lower_limit is seen.at_upper_limit or words is None:
        return None
    end, free = ("upper", words.falls) if seen.at_upper_limit else ("lower", words.grows)
    inside = config.axis(axis).contains(seen.position_deg)
    return Reason(
        "at_limit_switch",
        f"The {end} limit switch of the {axis_of(config, axis)} is on"
        f"{' although the axis is within its soft limits' if inside else ''}: the axis moves {free} only.",
        (
            "Jog the axis away from the switch. If the axis is not at its end, check the switch and "
            "the home position."
        ),
    )


def restart(name: str, before: Feedback, feedback: Feedback) -> Reason | None:
    """Return that the drive has restarted between two readings."""
    if before.boot_count == feedback.boot_count:
        return None
    return Reason(
        "drive_restarted",
        f"The drive of {name} has restarted, so its home reference is lost.",
        "Go to step 3, Homing, and set the home position again.",
    )


def came_back(name: str, before: Feedback | None, feedback: Feedback) -> Reason:
    """Return what a drive that did not answer for a while did meanwhile, as far as it tells."""
    again = f"The drive of {name} answers again."
    lost_zero = before is not None and _homed(before) and not _homed(feedback)
    if before is not None and (before.boot_count != feedback.boot_count or lost_zero):
        lost = "" if _homed(feedback) else " and has lost its home reference"
        return Reason(
            "drive_restarted",
            f"{again} The drive has restarted{lost}.",
            "Set the home position again in step 3.",
        )
    if feedback.watchdog_tripped:
        return Reason(
            "watchdog_tripped",
            (
                f"{again} The drive had stopped automatically: its watchdog tripped because no command "
                "reached it."
            ),
            "The home reference is kept. Find out why the connection failed before you continue.",
        )
    if before is not None and _moves(before) and not _moves(feedback):
        return Reason(
            "stopped_meanwhile",
            (
                f"{again} The drive was moving and is now at standstill: its watchdog or a last "
                "command stopped it."
            ),
            "The home reference is kept. Find out why the connection failed before you continue.",
        )
    if before is not None and not _moves(before) and _apart_deg(before, feedback) > JUMP_NOISE_DEG:
        return Reason(
            "drive_elsewhere",
            f"{again} The position has changed: the drive restarted, or an axis was turned.",
            "Compare the angles with the panel. If they differ, set the home position again in step 3.",
        )
    return Reason(
        "drive_back",
        f"{again} The drive reports no restart.",
        "Find out why the connection failed before you continue.",
    )


def _homed(feedback: Feedback) -> bool:
    return feedback.azimuth.homed and feedback.elevation.homed


def _apart_deg(before: Feedback, feedback: Feedback) -> float:
    """Return by how much the positions of two readings differ, the axis that differs more, degrees."""
    return max(
        abs(axis_feedback(before, axis).position_deg - axis_feedback(feedback, axis).position_deg)
        for axis in Axis
    )


def _moves(feedback: Feedback) -> bool:
    return feedback.azimuth.moving or feedback.elevation.moving


def home_doubt(config: TrackerConfig, home: HomeTrust, feedback: Feedback) -> Reason | None:
    """Return why a zero that was trusted no longer is, judged from one reading."""
    if home.boot_count != feedback.boot_count:
        return Reason(
            "drive_restarted",
            f"The drive of {config.name} has restarted since the home position was set.",
            "Go to step 3, Homing, and set the home position again.",
        )
    if feedback.azimuth.homed and feedback.elevation.homed:
        return None
    axis = Axis.ELEVATION if feedback.azimuth.homed else Axis.AZIMUTH
    return Reason(
        "not_homed",
        f"The drive reports that the {axis_of(config, axis)} has lost its home reference.",
        "Go to step 3, Homing, and set the home position again.",
    )


def jump(config: TrackerConfig, before: Feedback, feedback: Feedback, elapsed_s: float) -> Reason | None:
    """Return an axis whose position changed by more than it can have moved."""
    for axis in Axis:
        moved_deg = abs(axis_feedback(feedback, axis).position_deg - axis_feedback(before, axis).position_deg)
        if moved_deg > config.axis(axis).speed_dps * elapsed_s * JUMP_FACTOR + JUMP_NOISE_DEG:
            return Reason(
                "encoder_jump",
                f"The position of the {axis_of(config, axis)} jumped by {moved_deg:.1f} degrees.",
                "Check the encoder and its cable, then set the home position again in step 3, Homing.",
            )
    return None


def not_following(config: TrackerConfig, axis: Axis, watch: AxisWatch) -> Reason:
    """Return that an axis stays behind its command."""
    return Reason(
        "following_error",
        f"The {axis_of(config, axis)} does not follow its setpoint: the following error is "
        f"{abs(watch.error_deg):.1f} degrees.",
        "Check the axis for obstructions, check motor and coupling, then reset the fault.",
    )


def wrong_way(config: TrackerConfig, axis: Axis) -> Reason:
    """Return that an axis moves against its command."""
    return Reason(
        "wrong_direction",
        f"The {axis_of(config, axis)} moves opposite to its command.",
        (
            "Check the motor's phases and the direction set in the drive. Reset the fault, then set "
            "the home position again."
        ),
    )


def heads_into_switch(command: AxisCommand, seen: AxisFeedback, tolerance_deg: float) -> bool:
    """Return whether a command would move an axis further towards a limit switch that is pressed."""
    match command:
        case Halt():
            return False
        case Velocity():
            heading = command.velocity_dps
        case Position():
            away_deg = command.position_deg - seen.position_deg
            heading = away_deg if abs(away_deg) > tolerance_deg else 0.0
        case _:
            assert_never(command)
    return (heading > 0.0 and seen.at_upper_limit) or (heading < 0.0 and seen.at_lower_limit)


def room_deg(config: AxisConfig, position_deg: float, direction: int) -> float:
    """Return how far an axis may still turn in a direction before its soft limit; negative: beyond it."""
    return config.maximum_deg - position_deg if direction > 0 else position_deg - config.minimum_deg
