"""What one reading of the drive says against going on. Each guard returns a reason, or None."""

from typing import assert_never

from app.base.message import N_, Word, join, say, with_format
from app.tracker.memory.memory import HomeTrust
from app.tracker.motion.following_error import AxisWatch
from app.tracker.mounts.capabilities import axis_of, axis_words
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.motion import (
    AxisCommand,
    AxisFeedback,
    Feedback,
    Halt,
    Position,
    Velocity,
)
from app.tracker.values.reason import Reason

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
        say(
            "The drive of {name} reports fault code {fault_code}.", name=name, fault_code=feedback.fault_code
        ),
        N_("Look up the code in the drive's manual, remove the cause, then reset the fault."),
    )


def wiring_fault(config: TrackerConfig, feedback: Feedback) -> Reason | None:
    """Return the axis whose two limit switches are pressed at once, which no position can do."""
    for axis in Axis:
        seen = axis_feedback(feedback, axis)
        if seen.at_lower_limit and seen.at_upper_limit:
            return Reason(
                "limit_switch_wiring",
                (
                    say(
                        "Both limit switches of the {config} are on at the same time, which is impossible.",
                        config=axis_of(config, axis),
                    )
                ),
                N_("Check the wiring of the switches, then reset the fault."),
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
        (
            say(
                "The {end} limit switch of the {config} is on although the axis is within its soft "
                "limits: the axis moves {free} only.",
                end=Word(end),
                config=axis_of(config, axis),
                free=Word(free),
            )
            if inside
            else say(
                "The {end} limit switch of the {config} is on: the axis moves {free} only.",
                end=Word(end),
                config=axis_of(config, axis),
                free=Word(free),
            )
        ),
        N_(
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
        say("The drive of {name} has restarted, so its home reference is lost.", name=name),
        N_("Go to step 3, Homing, and set the home position again."),
    )


def came_back(name: str, before: Feedback | None, feedback: Feedback) -> Reason:
    """Return what a drive that did not answer for a while did meanwhile, as far as it tells."""
    again = say("The drive of {name} answers again.", name=name)
    lost_zero = before is not None and _homed(before) and not _homed(feedback)
    if before is not None and (before.boot_count != feedback.boot_count or lost_zero):
        restarted = (
            N_("The drive has restarted.")
            if _homed(feedback)
            else N_("The drive has restarted and has lost its home reference.")
        )
        return Reason(
            "drive_restarted",
            join(" ", (again, restarted)),
            N_("Set the home position again in step 3."),
        )
    if feedback.watchdog_tripped:
        return Reason(
            "watchdog_tripped",
            (
                say(
                    "{again} The drive had stopped automatically: its watchdog tripped because no "
                    "command reached it.",
                    again=again,
                )
            ),
            N_("The home reference is kept. Find out why the connection failed before you continue."),
        )
    if before is not None and _moves(before) and not _moves(feedback):
        return Reason(
            "stopped_meanwhile",
            (
                say(
                    "{again} The drive was moving and is now at standstill: its watchdog or a last "
                    "command stopped it.",
                    again=again,
                )
            ),
            N_("The home reference is kept. Find out why the connection failed before you continue."),
        )
    if before is not None and not _moves(before) and _apart_deg(before, feedback) > JUMP_NOISE_DEG:
        return Reason(
            "drive_elsewhere",
            say("{again} The position has changed: the drive restarted, or an axis was turned.", again=again),
            N_("Compare the angles with the panel. If they differ, set the home position again in step 3."),
        )
    return Reason(
        "drive_back",
        say("{again} The drive reports no restart.", again=again),
        N_("Find out why the connection failed before you continue."),
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
            say("The drive of {name} has restarted since the home position was set.", name=config.name),
            N_("Go to step 3, Homing, and set the home position again."),
        )
    if feedback.azimuth.homed and feedback.elevation.homed:
        return None
    axis = Axis.ELEVATION if feedback.azimuth.homed else Axis.AZIMUTH
    return Reason(
        "not_homed",
        say("The drive reports that the {config} has lost its home reference.", config=axis_of(config, axis)),
        N_("Go to step 3, Homing, and set the home position again."),
    )


def jump(config: TrackerConfig, before: Feedback, feedback: Feedback, elapsed_s: float) -> Reason | None:
    """Return an axis whose position changed by more than it can have moved."""
    for axis in Axis:
        moved_deg = abs(axis_feedback(feedback, axis).position_deg - axis_feedback(before, axis).position_deg)
        if moved_deg > config.axis(axis).speed_dps * elapsed_s * JUMP_FACTOR + JUMP_NOISE_DEG:
            return Reason(
                "encoder_jump",
                say(
                    "The position of the {config} jumped by {moved_deg} degrees.",
                    config=axis_of(config, axis),
                    moved_deg=with_format(moved_deg, ".1f"),
                ),
                N_("Check the encoder and its cable, then set the home position again in step 3, Homing."),
            )
    return None


def not_following(config: TrackerConfig, axis: Axis, watch: AxisWatch) -> Reason:
    """Return that an axis stays behind its command."""
    return Reason(
        "following_error",
        say(
            "The {config} does not follow its setpoint: the following error is {error_deg} degrees.",
            config=axis_of(config, axis),
            error_deg=with_format(abs(watch.error_deg), ".1f"),
        ),
        N_("Check the axis for obstructions, check motor and coupling, then reset the fault."),
    )


def wrong_way(config: TrackerConfig, axis: Axis) -> Reason:
    """Return that an axis moves against its command."""
    return Reason(
        "wrong_direction",
        say("The {config} moves opposite to its command.", config=axis_of(config, axis)),
        N_(
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
