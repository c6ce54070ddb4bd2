"""Moves that somebody watches: a small one for the direction, one of 10 degrees or more for the scale."""

from dataclasses import replace

from app.tracker.activity import AxisPair, MoveKind, Moving
from app.tracker.axes import Axis
from app.tracker.axis_demand import paced
from app.tracker.commands import CommandRejected, RunDirectionTest, RunScaleTest
from app.tracker.controller_state import ControllerState
from app.tracker.drive_tests import ProofKind, ProofMove
from app.tracker.guards import axis_feedback, room_deg
from app.tracker.interlocks import Action, demand_drive
from app.tracker.motion import AxisFeedback, Feedback
from app.tracker.positioning import new_run
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import switch_tracking_off

DIRECTION_DEG = 3.0
SCALE_WAYS_DEG = (10.0, 30.0, 90.0)
_KINDS = {MoveKind.DIRECTION: ProofKind.DIRECTION, MoveKind.SCALE: ProofKind.SCALE}


def test_direction(mind: ControllerState, command: RunDirectionTest) -> None:
    """Turn the axis by 3 degrees, or raise `CommandRejected`."""
    _begin(mind, command.axis, DIRECTION_DEG, MoveKind.DIRECTION, Action.TEST_DIRECTION)


def test_scale(mind: ControllerState, command: RunScaleTest) -> None:
    """Turn the axis by 10, 30 or 90 degrees, or raise `CommandRejected`."""
    if command.degrees not in SCALE_WAYS_DEG:
        raise CommandRejected(
            Reason(
                "scale_way",
                f"The scale test uses 10, 30, or 90 degrees, not {command.degrees:g}.",
                "Begin with 10 degrees; a longer travel gives a more accurate result.",
            )
        )
    _begin(mind, command.axis, command.degrees, MoveKind.SCALE, Action.TEST_SCALE)


def arrived(mind: ControllerState, moving: Moving, feedback: Feedback) -> None:
    """Note where the axis stands after a move that somebody watches; other moves are not meant."""
    move = mind.memory.proofs.move
    if moving.kind not in _KINDS or move is None:
        return
    to_deg = axis_feedback(feedback, move.axis).position_deg
    done = replace(move, to_deg=to_deg)
    mind.remember(proofs=replace(mind.memory.proofs, move=done))
    mind.say(
        EventKind.DRIVE_TEST_ENDED,
        f"The {move.axis} axis has turned by {done.moved_deg:+.2f} degrees for the {move.kind} "
        "test. Enter what the panel did.",
        proof=move.kind,
        axis=move.axis,
        outcome="to_be_judged",
    )


def free_way(mind: ControllerState, axis: Axis, seen: AxisFeedback, way_deg: float) -> int:
    """Return the direction (1 or -1) in which an axis may turn this far, or raise `CommandRejected`.

    Upwards where both are free, unless there is more room downwards. Without a trusted zero the limit
    switches alone decide.
    """
    rooms = {sign: _room_deg(mind, axis, seen, sign) for sign in (1, -1)}
    sign = 1 if rooms[1] >= rooms[-1] or rooms[1] >= 2.0 * way_deg else -1
    if rooms[sign] >= way_deg:
        return sign
    raise CommandRejected(
        Reason(
            "no_room",
            f"The {axis} axis of {mind.config.name} cannot turn by {way_deg:.1f} degrees within its range.",
            "Jog the axis away from the ends of its range, then try again.",
        )
    )


def _room_deg(mind: ControllerState, axis: Axis, seen: AxisFeedback, sign: int) -> float:
    if seen.at_upper_limit if sign > 0 else seen.at_lower_limit:
        return 0.0
    if mind.memory.home is None:
        return float("inf")
    return room_deg(mind.config.axis(axis), seen.position_deg, sign)


def _begin(mind: ControllerState, axis: Axis, way_deg: float, kind: MoveKind, action: Action) -> None:
    feedback = demand_drive(mind, action)
    seen = axis_feedback(feedback, axis)
    degrees = free_way(mind, axis, seen, way_deg) * way_deg
    switch_tracking_off(mind, "the drive is being tested.")
    target_deg = seen.position_deg + degrees
    on_azimuth = axis is Axis.AZIMUTH
    target = AxisPair(target_deg if on_azimuth else None, None if on_azimuth else target_deg)
    run = new_run(paced(mind), feedback, target, mind.now, by_hand=True)
    mind.activity = Moving(kind, run, mind.actor)
    move = ProofMove(_KINDS[kind], axis, seen.position_deg, mind.site_time, mind.actor)
    mind.remember(proofs=replace(mind.memory.proofs, move=move))
    mind.say(
        EventKind.DRIVE_TEST_STARTED,
        f"The {axis} axis turns by {degrees:+g} degrees for the {move.kind} test.",
        proof=move.kind,
        axis=axis,
    )
