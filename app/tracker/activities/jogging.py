"""Hold-to-run: an axis turns while a lease is renewed, and a press that has ended never lives again."""

from app.base.message import N_, Message, say
from app.tracker.access.interlocks import Action, unmet
from app.tracker.commands.commands import JOG_LEASE, CommandRejected, EndJog, Jog
from app.tracker.motion.guards import axis_feedback, room_deg
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.state.activity import Jogging
from app.tracker.state.axis_demand import paced
from app.tracker.state.controller_state import ControllerState, Turn
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, hold, leave, switch_tracking_off
from app.tracker.values.motion import (
    HALT,
    AxisCommand,
    AxisFeedback,
    DriveCommand,
    Feedback,
    Position,
    Velocity,
)
from app.tracker.values.reason import Reason

BRAKE_REACH_S = 0.5
"""Within what it covers in this time of its braking point, an axis is led to the soft limit by position."""
LAST_FIRST_SEQUENCE = 1
"""A press begins with sequence 0 or 1; an unknown press with a higher one ended before we can remember."""


def jog(state: ControllerState, command: Jog) -> None:
    """Begin or renew a press, or raise `CommandRejected`; a refused press is dead."""
    jogging = state.activity
    if isinstance(jogging, Jogging) and state.now >= jogging.until:
        end(state, jogging, N_("the jog command was not renewed in time."), "expired")
    if isinstance(state.activity, Jogging) and state.activity.press_id == command.press_id:
        _renew(state, state.activity, command)
        return
    reasons = _against(state, command)
    if reasons:
        state.kill_press(command.press_id)
        raise CommandRejected(*reasons)
    _begin(state, command)


def end_jog(state: ControllerState, command: EndJog) -> None:
    """End a press; one that is not known is dead from now on."""
    state.kill_press(command.press_id)
    if isinstance(state.activity, Jogging) and state.activity.press_id == command.press_id:
        end(state, state.activity, N_("the button was released."), "released")


def end(state: ControllerState, jogging: Jogging, why: Message, outcome: str) -> None:
    """End the jog for good."""
    state.kill_press(jogging.press_id)
    hold(state)
    state.say(
        EventKind.JOG_ENDED,
        say("The jog of {mount} ended: {why}", mount=axis_title(state.config.mount, jogging.axis), why=why),
        outcome=outcome,
    )


def step(state: ControllerState, jogging: Jogging, feedback: Feedback) -> Turn:
    """Turn the axis while the lease lasts, but not into a switch and not beyond a trusted soft limit."""
    if state.now >= jogging.until:
        end(state, jogging, N_("the jog command was not renewed in time."), "expired")
        return Turn(state.activity)
    seen = axis_feedback(feedback, jogging.axis)
    if at_switch(seen, jogging.direction):
        end(state, jogging, N_("the axis has reached its limit switch."), "limit_switch")
        return Turn(state.activity)
    command = _turn(state, jogging, seen)
    if jogging.axis is Axis.AZIMUTH:
        return Turn(jogging, DriveCommand(azimuth=command))
    return Turn(jogging, DriveCommand(elevation=command))


def at_switch(seen: AxisFeedback, direction: int) -> bool:
    """Return whether the limit switch in this direction is pressed."""
    return seen.at_upper_limit if direction > 0 else seen.at_lower_limit


def _renew(state: ControllerState, jogging: Jogging, command: Jog) -> None:
    if (command.axis, command.direction) != (jogging.axis, jogging.direction):
        leave(state, N_("the direction changed while the button was held."))
        raise CommandRejected(
            Reason(
                "press_changed",
                N_("Axis and direction cannot change while the button is held."),
                N_("Release the button and press again."),
            )
        )
    if command.sequence > jogging.sequence:
        until = state.now + min(command.lease, JOG_LEASE)
        begin(
            state,
            Jogging(
                jogging.press_id, jogging.axis, jogging.direction, command.speed, command.sequence, until
            ),
        )


def _begin(state: ControllerState, command: Jog) -> None:
    switch_tracking_off(state, N_("the tracker is being jogged."))
    begin(
        state,
        Jogging(
            command.press_id,
            command.axis,
            command.direction,
            command.speed,
            command.sequence,
            state.now + min(command.lease, JOG_LEASE),
        ),
    )
    sign = "+" if command.direction > 0 else "-"
    state.say(
        EventKind.JOG_STARTED,
        say(
            "Jog of {mount} in direction {sign}, {speed}.",
            mount=axis_title(state.config.mount, command.axis),
            sign=sign,
            speed=command.speed,
        ),
    )


def _against(state: ControllerState, command: Jog) -> tuple[Reason, ...]:
    """Return everything that forbids a new press."""
    if command.press_id in state.dead_presses or command.sequence > LAST_FIRST_SEQUENCE:
        return (
            Reason(
                "press_dead",
                N_("This button press has ended and no longer moves the axis."),
                N_("Release the button and press again."),
            ),
        )
    if isinstance(state.activity, Jogging):
        return (
            Reason(
                "busy",
                say("{name} is being jogged by another user or with another button.", name=state.config.name),
                N_("Wait until that button is released."),
            ),
        )
    reasons = unmet(state, Action.JOG)
    return reasons if reasons or state.feedback is None else _in_the_way(state, state.feedback, command)


def _in_the_way(state: ControllerState, feedback: Feedback, command: Jog) -> tuple[Reason, ...]:
    seen = axis_feedback(feedback, command.axis)
    reasons: list[Reason] = []
    if at_switch(seen, command.direction):
        reasons.append(
            Reason(
                "at_limit_switch",
                say("The {config} is on its limit switch.", config=axis_of(state.config, command.axis)),
                N_("The axis can only move away from the switch."),
            )
        )
    room = room_deg(state.config.axis(command.axis), seen.position_deg, command.direction)
    if state.memory.home is not None and room <= 0.0:
        reasons.append(
            Reason(
                "at_soft_limit",
                say("The {config} is at its soft limit.", config=axis_of(state.config, command.axis)),
                N_("Move the axis in the opposite direction, or change the limit in the tracker's settings."),
            )
        )
    return tuple(reasons)


def _turn(state: ControllerState, jogging: Jogging, seen: AxisFeedback) -> AxisCommand:
    """Return the motion of this tick; where a trusted soft limit is near, one that comes to rest there."""
    config = paced(state).axis(jogging.axis)
    speed_dps = config.jog_fast_dps if jogging.speed is JogSpeed.FAST else config.jog_slow_dps
    braking_deg = max(speed_dps, abs(seen.velocity_dps)) ** 2 / (2.0 * config.acceleration_dps2)
    if state.memory.home is not None:
        room = room_deg(config, seen.position_deg, jogging.direction)
        if room <= 0.0:
            return HALT
        if room <= braking_deg + speed_dps * BRAKE_REACH_S:
            return Position(seen.position_deg + jogging.direction * room, speed_dps)
    if state.capabilities.watchdog_s is None:
        reach_deg = speed_dps * JOG_LEASE.total_seconds() + braking_deg
        return Position(seen.position_deg + jogging.direction * reach_deg, speed_dps)
    return Velocity(jogging.direction * speed_dps)
