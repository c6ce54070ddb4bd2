"""Hold-to-run: an axis turns while a lease is renewed, and a press that has ended never lives again."""

from app.tracker.activity import HOLDING, Jogging
from app.tracker.axes import Axis, JogSpeed
from app.tracker.axis_demand import paced
from app.tracker.commands import JOG_LEASE, CommandRejected, EndJog, Jog
from app.tracker.controller_state import ControllerState, Turn
from app.tracker.guards import axis_feedback, room_deg
from app.tracker.interlocks import Action, unmet
from app.tracker.motion import HALT, AxisCommand, AxisFeedback, DriveCommand, Feedback, Position, Velocity
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import leave, switch_tracking_off

BRAKE_REACH_S = 0.5
"""Within what it covers in this time of its braking point, an axis is led to the soft limit by position."""
LAST_FIRST_SEQUENCE = 1
"""A press begins with sequence 0 or 1; an unknown press with a higher one ended before we can remember."""


def jog(mind: ControllerState, command: Jog) -> None:
    """Begin or renew a press, or raise `CommandRejected`; a refused press is dead."""
    jogging = mind.activity
    if isinstance(jogging, Jogging) and mind.now >= jogging.until:
        end(mind, jogging, "the jog command was not renewed in time.", "expired")
    if isinstance(mind.activity, Jogging) and mind.activity.press_id == command.press_id:
        _renew(mind, mind.activity, command)
        return
    reasons = _against(mind, command)
    if reasons:
        mind.kill_press(command.press_id)
        raise CommandRejected(*reasons)
    _begin(mind, command)


def end_jog(mind: ControllerState, command: EndJog) -> None:
    """End a press; one that is not known is dead from now on."""
    mind.kill_press(command.press_id)
    if isinstance(mind.activity, Jogging) and mind.activity.press_id == command.press_id:
        end(mind, mind.activity, "the button was released.", "released")


def end(mind: ControllerState, jogging: Jogging, why: str, outcome: str) -> None:
    """End the jog for good."""
    mind.kill_press(jogging.press_id)
    mind.activity = HOLDING
    mind.say(
        EventKind.JOG_ENDED,
        f"The jog of {axis_title(mind.config.mount, jogging.axis)} ended: {why}",
        outcome=outcome,
    )


def step(mind: ControllerState, jogging: Jogging, feedback: Feedback) -> Turn:
    """Turn the axis while the lease lasts, but not into a switch and not beyond a trusted soft limit."""
    if mind.now >= jogging.until:
        end(mind, jogging, "the jog command was not renewed in time.", "expired")
        return Turn(mind.activity)
    seen = axis_feedback(feedback, jogging.axis)
    if at_switch(seen, jogging.direction):
        end(mind, jogging, "the axis has reached its limit switch.", "limit_switch")
        return Turn(mind.activity)
    command = _turn(mind, jogging, seen)
    if jogging.axis is Axis.AZIMUTH:
        return Turn(jogging, DriveCommand(azimuth=command))
    return Turn(jogging, DriveCommand(elevation=command))


def at_switch(seen: AxisFeedback, direction: int) -> bool:
    """Return whether the limit switch in this direction is pressed."""
    return seen.at_upper_limit if direction > 0 else seen.at_lower_limit


def _renew(mind: ControllerState, jogging: Jogging, command: Jog) -> None:
    if (command.axis, command.direction) != (jogging.axis, jogging.direction):
        leave(mind, "the direction changed while the button was held.")
        raise CommandRejected(
            Reason(
                "press_changed",
                "Axis and direction cannot change while the button is held.",
                "Release the button and press again.",
            )
        )
    if command.sequence > jogging.sequence:
        until = mind.now + min(command.lease, JOG_LEASE)
        mind.activity = Jogging(
            jogging.press_id, jogging.axis, jogging.direction, command.speed, command.sequence, until
        )


def _begin(mind: ControllerState, command: Jog) -> None:
    switch_tracking_off(mind, "the tracker is being jogged.")
    mind.activity = Jogging(
        command.press_id,
        command.axis,
        command.direction,
        command.speed,
        command.sequence,
        mind.now + min(command.lease, JOG_LEASE),
    )
    sign = "+" if command.direction > 0 else "-"
    mind.say(
        EventKind.JOG_STARTED,
        f"Jog of {axis_title(mind.config.mount, command.axis)} in direction {sign}, {command.speed}.",
    )


def _against(mind: ControllerState, command: Jog) -> tuple[Reason, ...]:
    """Return everything that forbids a new press."""
    if command.press_id in mind.dead_presses or command.sequence > LAST_FIRST_SEQUENCE:
        return (
            Reason(
                "press_dead",
                "This button press has ended and no longer moves the axis.",
                "Release the button and press again.",
            ),
        )
    if isinstance(mind.activity, Jogging):
        return (
            Reason(
                "busy",
                f"{mind.config.name} is being jogged by another user or with another button.",
                "Wait until that button is released.",
            ),
        )
    reasons = unmet(mind, Action.JOG)
    return reasons if reasons or mind.feedback is None else _in_the_way(mind, mind.feedback, command)


def _in_the_way(mind: ControllerState, feedback: Feedback, command: Jog) -> tuple[Reason, ...]:
    seen = axis_feedback(feedback, command.axis)
    reasons: list[Reason] = []
    if at_switch(seen, command.direction):
        reasons.append(
            Reason(
                "at_limit_switch",
                f"The {axis_of(mind.config, command.axis)} is on its limit switch.",
                "The axis can only move away from the switch.",
            )
        )
    room = room_deg(mind.config.axis(command.axis), seen.position_deg, command.direction)
    if mind.memory.home is not None and room <= 0.0:
        reasons.append(
            Reason(
                "at_soft_limit",
                f"The {axis_of(mind.config, command.axis)} is at its soft limit.",
                "Move the axis in the opposite direction, or change the limit in the tracker's settings.",
            )
        )
    return tuple(reasons)


def _turn(mind: ControllerState, jogging: Jogging, seen: AxisFeedback) -> AxisCommand:
    """Return the motion of this tick; where a trusted soft limit is near, one that comes to rest there."""
    config = paced(mind).axis(jogging.axis)
    speed_dps = config.jog_fast_dps if jogging.speed is JogSpeed.FAST else config.jog_slow_dps
    braking_deg = max(speed_dps, abs(seen.velocity_dps)) ** 2 / (2.0 * config.acceleration_dps2)
    if mind.memory.home is not None:
        room = room_deg(config, seen.position_deg, jogging.direction)
        if room <= 0.0:
            return HALT
        if room <= braking_deg + speed_dps * BRAKE_REACH_S:
            return Position(seen.position_deg + jogging.direction * room, speed_dps)
    if mind.capabilities.watchdog_s is None:
        reach_deg = speed_dps * JOG_LEASE.total_seconds() + braking_deg
        return Position(seen.position_deg + jogging.direction * reach_deg, speed_dps)
    return Velocity(jogging.direction * speed_dps)
