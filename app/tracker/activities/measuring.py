"""Measured coming to rest: the stop test, and the link-loss test in which the drive is told nothing."""

from dataclasses import replace
from datetime import timedelta

from app.tracker.activities.drive_testing import free_way
from app.tracker.activity import HOLDING, Asked, Measuring
from app.tracker.axes import Axis, AxisConfig
from app.tracker.commands import RunCommunicationLossTest, RunStopTest
from app.tracker.controller_state import HALTED, NOWHERE, ControllerState, Turn
from app.tracker.drive_tests import LinkLossOutcome, LinkLossProof, ProofKind, StopProof, StopSpeed
from app.tracker.guards import axis_feedback
from app.tracker.interlocks import Action, demand_drive, homed
from app.tracker.motion import AxisFeedback, DriveCommand, Feedback, Position
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import fail, switch_tracking_off

STEADY_S = 1.0
SPARE_S = 0.5
LOOK_EVERY = timedelta(milliseconds=20)
SLOWED = 0.9
LEAST_SHARE = 0.5
STOP_GRACE_S = 5.0
WATCHDOG_SHARE = 1.5
WATCHDOG_GRACE_S = 1.5


def test_stop(mind: ControllerState, command: RunStopTest) -> None:
    """Begin the stop test, or raise `CommandRejected`; at the rated speed the zero must be trusted."""
    settings = mind.config.axis(command.axis)
    rated = command.speed is StopSpeed.RATED
    needs_zero = homed(mind) if rated else None
    feedback = demand_drive(mind, Action.TEST_STOP, needs_zero)
    speed_dps = settings.speed_dps if rated else settings.jog_fast_dps
    most_s = _run_up_s(settings, speed_dps) + speed_dps / settings.acceleration_dps2 + STOP_GRACE_S
    _begin(mind, feedback, command.axis, command.speed, speed_dps, STEADY_S, most_s)


def test_communication_loss(mind: ControllerState, command: RunCommunicationLossTest) -> None:
    """Begin the link-loss test, or raise `CommandRejected`; a drive without a watchdog is never tested."""
    feedback = demand_drive(mind, Action.TEST_COMMUNICATION_LOSS)
    settings = mind.config.axis(command.axis)
    silence_s = (mind.capabilities.watchdog_s or 0.0) * WATCHDOG_SHARE + WATCHDOG_GRACE_S
    speed_dps = settings.jog_slow_dps
    most_s = _run_up_s(settings, speed_dps) + silence_s
    _begin(mind, feedback, command.axis, None, speed_dps, silence_s, most_s)


def step(mind: ControllerState, measuring: Measuring, feedback: Feedback) -> Turn:
    """Run up, then stop (or fall silent) and watch until the axis stands."""
    seen = axis_feedback(feedback, measuring.axis)
    if measuring.asked is None:
        return _run_up(mind, measuring, seen)
    asked = _looked(mind, measuring.asked, seen)
    if not seen.moving:
        _stood(mind, measuring, asked, feedback, seen)
        return Turn(mind.activity)
    if mind.now >= measuring.until:
        _went_on(mind, measuring, asked, feedback, seen)
        return Turn(mind.activity)
    return Turn(replace(measuring, asked=asked))


def is_silent(mind: ControllerState) -> bool:
    """Return whether the drive is told nothing: after the last command of a link-loss test."""
    activity = mind.activity
    if not isinstance(activity, Measuring) or activity.speed is not None or activity.asked is None:
        return False
    return mind.now > activity.asked.at


def _run_up_s(settings: AxisConfig, speed_dps: float) -> float:
    """Return how long an axis takes to have its speed, and a second."""
    return speed_dps / settings.acceleration_dps2 + STEADY_S


def _begin(
    mind: ControllerState,
    feedback: Feedback,
    axis: Axis,
    speed: StopSpeed | None,
    speed_dps: float,
    ahead_s: float,
    most_s: float,
) -> None:
    """Let the axis turn towards a place that lies what it travels in `ahead_s` beyond the run-up."""
    settings, seen = mind.config.axis(axis), axis_feedback(feedback, axis)
    way_deg = speed_dps * (STEADY_S + ahead_s + SPARE_S + speed_dps / settings.acceleration_dps2)
    target_deg = seen.position_deg + free_way(mind, axis, seen, way_deg) * way_deg
    switch_tracking_off(mind, "the drive is being tested.")
    mind.setpoint = NOWHERE
    goal = Position(target_deg, speed_dps)
    command = DriveCommand(azimuth=goal) if axis is Axis.AZIMUTH else DriveCommand(elevation=goal)
    steady_at = mind.now + timedelta(seconds=_run_up_s(settings, speed_dps))
    until = mind.now + timedelta(seconds=most_s)
    mind.activity = Measuring(
        axis, speed, speed_dps, seen.position_deg, command, steady_at, until, mind.actor
    )
    mind.say(
        EventKind.DRIVE_TEST_STARTED,
        f"{_title(mind.activity)} of the {axis} axis at {speed_dps:g} degrees a second.",
        proof=_kind(mind.activity),
        axis=axis,
    )


def _run_up(mind: ControllerState, measuring: Measuring, seen: AxisFeedback) -> Turn:
    """Go on until the speed is steady; the last command before the measurement is still one to move."""
    if mind.now < measuring.steady_at:
        return Turn(measuring, measuring.command)
    asked = Asked(mind.now, seen.position_deg, seen.velocity_dps, mind.now)
    way_deg = abs(seen.position_deg - measuring.from_deg)
    if not seen.moving or way_deg < LEAST_SHARE * STEADY_S * measuring.speed_dps:
        _end(mind, measuring, "failed", "the axis did not move.")
        return Turn(mind.activity)
    begun = replace(measuring, asked=asked)
    return Turn(begun, measuring.command if measuring.speed is None else HALTED)


def _looked(mind: ControllerState, asked: Asked, seen: AxisFeedback) -> Asked:
    slowed = abs(seen.velocity_dps) < SLOWED * abs(asked.velocity_dps)
    reacted_at = mind.now if asked.reacted_at is None and slowed else asked.reacted_at
    return replace(asked, reacted_at=reacted_at, looked_at=mind.now if seen.moving else asked.looked_at)


def _stood(
    mind: ControllerState, measuring: Measuring, asked: Asked, feedback: Feedback, seen: AxisFeedback
) -> None:
    if measuring.speed is None:
        _keep_link_loss(mind, measuring, asked, feedback, seen, LinkLossOutcome.STOPPED)
        return
    proof = StopProof(
        measuring.axis,
        measuring.speed,
        abs(asked.velocity_dps) or measuring.speed_dps,
        (mind.now - asked.at).total_seconds(),
        abs(seen.position_deg - asked.position_deg),
        (mind.now - asked.looked_at).total_seconds(),
        mind.site_time,
        measuring.actor,
        mind.config.drive,
        mind.config.axis(measuring.axis),
    )
    mind.remember(proofs=mind.memory.proofs.keep(proof))
    _end(
        mind,
        measuring,
        "measured",
        (
            f"the axis was at standstill {proof.stopped_after_s:.2f} s and {proof.overrun_deg:.2f} "
            "degrees after the stop command."
        ),
    )


def _went_on(
    mind: ControllerState, measuring: Measuring, asked: Asked, feedback: Feedback, seen: AxisFeedback
) -> None:
    """The axis did not come to rest in time: a fault after a stop, a result of the link-loss test."""
    if measuring.speed is None:
        _keep_link_loss(mind, measuring, asked, feedback, seen, LinkLossOutcome.WENT_ON)
        return
    fail(
        mind,
        Reason(
            "stop_overdue",
            f"The {measuring.axis} axis of {mind.config.name} did not stop after the stop command.",
            "Use the emergency stop. Check the drive and its deceleration before you continue.",
        ),
    )


def _keep_link_loss(
    mind: ControllerState,
    measuring: Measuring,
    asked: Asked,
    feedback: Feedback,
    seen: AxisFeedback,
    outcome: LinkLossOutcome,
) -> None:
    """Keep what the drive did by itself; a trusted zero counts as kept if the drive still reports it."""
    stood = outcome is LinkLossOutcome.STOPPED
    after_s = (mind.now - asked.at).total_seconds()
    proof = LinkLossProof(
        axis=measuring.axis,
        outcome=outcome,
        speed_dps=abs(asked.velocity_dps) or measuring.speed_dps,
        expected_s=mind.capabilities.watchdog_s,
        reacted_after_s=(asked.reacted_at - asked.at).total_seconds() if asked.reacted_at else None,
        stopped_after_s=after_s if stood else None,
        overrun_deg=abs(seen.position_deg - asked.position_deg),
        resolution_s=(mind.now - asked.looked_at).total_seconds() if stood else 0.0,
        reported=feedback.watchdog_tripped,
        fault_code=feedback.fault_code,
        home_kept=feedback.azimuth.homed and feedback.elevation.homed,
        at=mind.site_time,
        by=measuring.actor,
        drive=mind.config.drive,
    )
    mind.remember(proofs=mind.memory.proofs.keep(proof))
    words = (
        f"the drive stopped automatically; it was at standstill {after_s:.2f} s after the last command."
        if stood
        else f"the drive had not stopped {after_s:.1f} s after the last command; a stop command was sent."
    )
    _end(mind, measuring, outcome, words)


def _end(mind: ControllerState, measuring: Measuring, outcome: str, words: str) -> None:
    mind.activity = HOLDING
    mind.say(
        EventKind.DRIVE_TEST_ENDED,
        f"{_title(measuring)} of the {measuring.axis} axis: {words}",
        proof=_kind(measuring),
        axis=measuring.axis,
        outcome=outcome,
    )


def _kind(measuring: Measuring) -> ProofKind:
    return ProofKind.LINK_LOSS if measuring.speed is None else ProofKind.STOP


def _title(measuring: Measuring) -> str:
    return "Communication-loss test" if measuring.speed is None else "Stop test"
