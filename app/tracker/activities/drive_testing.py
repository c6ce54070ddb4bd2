"""Moves that somebody watches: a small one for the direction, one of 10 degrees or more for the scale."""

from dataclasses import replace

from app.base.message import N_, say, with_format
from app.tracker.access.interlocks import Action, demand_drive
from app.tracker.commands.commands import CommandRejected, RunDirectionTest, RunScaleTest
from app.tracker.memory.drive_tests import ProofKind, ProofMove
from app.tracker.motion.guards import axis_feedback, room_deg
from app.tracker.settings.axes import Axis
from app.tracker.state.activity import AxisPair, MoveKind, Moving
from app.tracker.state.axis_demand import paced
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.positioning import new_run
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, switch_tracking_off
from app.tracker.values.motion import AxisFeedback, Feedback
from app.tracker.values.reason import Reason

DIRECTION_DEG = 3.0
SCALE_WAYS_DEG = (10.0, 30.0, 90.0)
_KINDS = {MoveKind.DIRECTION: ProofKind.DIRECTION, MoveKind.SCALE: ProofKind.SCALE}


def test_direction(state: ControllerState, command: RunDirectionTest) -> None:
    """Turn the axis by 3 degrees, or raise `CommandRejected`."""
    _begin(state, command.axis, DIRECTION_DEG, MoveKind.DIRECTION, Action.TEST_DIRECTION)


def test_scale(state: ControllerState, command: RunScaleTest) -> None:
    """Turn the axis by 10, 30 or 90 degrees, or raise `CommandRejected`."""
    if command.delta_deg not in SCALE_WAYS_DEG:
        raise CommandRejected(
            Reason(
                "scale_way",
                say(
                    "The scale test uses 10, 30, or 90 degrees, not {degrees}.",
                    degrees=with_format(command.delta_deg, "g"),
                ),
                N_("Begin with 10 degrees; a longer travel gives a more accurate result."),
            )
        )
    _begin(state, command.axis, command.delta_deg, MoveKind.SCALE, Action.TEST_SCALE)


def arrived(state: ControllerState, moving: Moving, feedback: Feedback) -> None:
    """Note where the axis stands after a move that somebody watches; other moves are not meant."""
    move = state.memory.proofs.move
    if moving.kind not in _KINDS or move is None:
        return
    to_deg = axis_feedback(feedback, move.axis).position_deg
    done = replace(move, to_deg=to_deg)
    state.remember(proofs=replace(state.memory.proofs, move=done))
    state.say(
        EventKind.DRIVE_TEST_ENDED,
        say(
            "The {axis} axis has turned by {moved_deg} degrees for the {kind} test. Enter what "
            "the panel did.",
            axis=move.axis,
            moved_deg=with_format(done.moved_deg, "+.2f"),
            kind=move.kind,
        ),
        proof=move.kind,
        axis=move.axis,
        outcome="to_be_judged",
    )


def free_way(state: ControllerState, axis: Axis, seen: AxisFeedback, way_deg: float) -> int:
    """Return the direction (1 or -1) in which an axis may turn this far, or raise `CommandRejected`.

    Upwards where both are free, unless there is more room downwards. Without a trusted zero the limit
    switches alone decide.
    """
    rooms = {sign: _room_deg(state, axis, seen, sign) for sign in (1, -1)}
    sign = 1 if rooms[1] >= rooms[-1] or rooms[1] >= 2.0 * way_deg else -1
    if rooms[sign] >= way_deg:
        return sign
    raise CommandRejected(
        Reason(
            "no_room",
            say(
                "The {axis} axis of {name} cannot turn by {way_deg} degrees within its range.",
                axis=axis,
                name=state.config.name,
                way_deg=with_format(way_deg, ".1f"),
            ),
            N_("Jog the axis away from the ends of its range, then try again."),
        )
    )


def _room_deg(state: ControllerState, axis: Axis, seen: AxisFeedback, sign: int) -> float:
    if seen.at_upper_limit if sign > 0 else seen.at_lower_limit:
        return 0.0
    if state.memory.home is None:
        return float("inf")
    return room_deg(state.config.axis(axis), seen.position_deg, sign)


def _begin(state: ControllerState, axis: Axis, way_deg: float, kind: MoveKind, action: Action) -> None:
    feedback = demand_drive(state, action)
    seen = axis_feedback(feedback, axis)
    degrees = free_way(state, axis, seen, way_deg) * way_deg
    switch_tracking_off(state, N_("the drive is being tested."))
    target_deg = seen.position_deg + degrees
    on_azimuth = axis is Axis.AZIMUTH
    target = AxisPair(target_deg if on_azimuth else None, None if on_azimuth else target_deg)
    run = new_run(paced(state), feedback, target, state.now, by_hand=True)
    begin(state, Moving(kind, run, state.actor))
    move = ProofMove(_KINDS[kind], axis, seen.position_deg, state.site_time, state.actor)
    state.remember(proofs=replace(state.memory.proofs, move=move))
    state.say(
        EventKind.DRIVE_TEST_STARTED,
        say(
            "The {axis} axis turns by {degrees} degrees for the {kind} test.",
            axis=axis,
            degrees=with_format(degrees, "+g"),
            kind=move.kind,
        ),
        proof=move.kind,
        axis=axis,
    )
