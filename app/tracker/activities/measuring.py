"""Measured coming to rest: the stop test, and the link-loss test in which the drive is told nothing."""

from dataclasses import replace
from datetime import timedelta

from app.base.message import N_, Message, say, with_format
from app.tracker.access.interlocks import Action, demand_drive, homed
from app.tracker.activities.drive_testing import free_way
from app.tracker.commands.commands import RunCommunicationLossTest, RunStopTest
from app.tracker.memory.drive_tests import LinkLossOutcome, LinkLossProof, ProofKind, StopProof, StopSpeed
from app.tracker.motion.guards import axis_feedback
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.state.activity import Asked, Measuring
from app.tracker.state.controller_state import HALTED, ControllerState, Turn
from app.tracker.state.setpoints import forget_setpoint
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, fail, hold, switch_tracking_off
from app.tracker.values.motion import AxisFeedback, DriveCommand, Feedback, Position
from app.tracker.values.reason import Reason

STEADY_S = 1.0
SPARE_S = 0.5
LOOK_EVERY = timedelta(milliseconds=20)
SLOWED = 0.9
LEAST_SHARE = 0.5
STOP_GRACE_S = 5.0
WATCHDOG_SHARE = 1.5
WATCHDOG_GRACE_S = 1.5


def test_stop(state: ControllerState, command: RunStopTest) -> None:
    """Begin the stop test, or raise `CommandRejected`; at the rated speed the zero must be trusted."""
    settings = state.config.axis(command.axis)
    rated = command.speed is StopSpeed.RATED
    needs_zero = homed(state) if rated else None
    feedback = demand_drive(state, Action.TEST_STOP, needs_zero)
    speed_dps = settings.speed_dps if rated else settings.jog_fast_dps
    most_s = _run_up_s(settings, speed_dps) + speed_dps / settings.acceleration_dps2 + STOP_GRACE_S
    _begin(state, feedback, command.axis, command.speed, speed_dps, STEADY_S, most_s)


def test_communication_loss(state: ControllerState, command: RunCommunicationLossTest) -> None:
    """Begin the link-loss test, or raise `CommandRejected`; a drive without a watchdog is never tested."""
    feedback = demand_drive(state, Action.TEST_COMMUNICATION_LOSS)
    settings = state.config.axis(command.axis)
    silence_s = (state.capabilities.watchdog_s or 0.0) * WATCHDOG_SHARE + WATCHDOG_GRACE_S
    speed_dps = settings.jog_slow_dps
    most_s = _run_up_s(settings, speed_dps) + silence_s
    _begin(state, feedback, command.axis, None, speed_dps, silence_s, most_s)


def step(state: ControllerState, measuring: Measuring, feedback: Feedback) -> Turn:
    """Run up, then stop (or fall silent) and watch until the axis stands."""
    seen = axis_feedback(feedback, measuring.axis)
    if measuring.asked is None:
        return _run_up(state, measuring, seen)
    asked = _looked(state, measuring.asked, seen)
    if not seen.moving:
        _stood(state, measuring, asked, feedback, seen)
        return Turn(state.activity)
    if state.now >= measuring.until:
        _went_on(state, measuring, asked, feedback, seen)
        return Turn(state.activity)
    return Turn(replace(measuring, asked=asked))


def _run_up_s(settings: AxisConfig, speed_dps: float) -> float:
    """Return how long an axis takes to have its speed, and a second."""
    return speed_dps / settings.acceleration_dps2 + STEADY_S


def _begin(
    state: ControllerState,
    feedback: Feedback,
    axis: Axis,
    speed: StopSpeed | None,
    speed_dps: float,
    ahead_s: float,
    most_s: float,
) -> None:
    """Let the axis turn towards a place that lies what it travels in `ahead_s` beyond the run-up."""
    settings, seen = state.config.axis(axis), axis_feedback(feedback, axis)
    way_deg = speed_dps * (STEADY_S + ahead_s + SPARE_S + speed_dps / settings.acceleration_dps2)
    target_deg = seen.position_deg + free_way(state, axis, seen, way_deg) * way_deg
    switch_tracking_off(state, N_("the drive is being tested."))
    forget_setpoint(state)
    goal = Position(target_deg, speed_dps)
    command = DriveCommand(azimuth=goal) if axis is Axis.AZIMUTH else DriveCommand(elevation=goal)
    steady_at = state.now + timedelta(seconds=_run_up_s(settings, speed_dps))
    until = state.now + timedelta(seconds=most_s)
    measuring = Measuring(axis, speed, speed_dps, seen.position_deg, command, steady_at, until, state.actor)
    begin(state, measuring)
    state.say(
        EventKind.DRIVE_TEST_STARTED,
        say(
            "{activity} of the {axis} axis at {speed_dps} degrees a second.",
            activity=_title(measuring),
            axis=axis,
            speed_dps=with_format(speed_dps, "g"),
        ),
        proof=_kind(measuring),
        axis=axis,
    )


def _run_up(state: ControllerState, measuring: Measuring, seen: AxisFeedback) -> Turn:
    """Go on until the speed is steady; the last command before the measurement is still one to move."""
    if state.now < measuring.steady_at:
        return Turn(measuring, measuring.command)
    asked = Asked(state.now, seen.position_deg, seen.velocity_dps, state.now)
    way_deg = abs(seen.position_deg - measuring.from_deg)
    if not seen.moving or way_deg < LEAST_SHARE * STEADY_S * measuring.speed_dps:
        _end(state, measuring, "failed", N_("the axis did not move."))
        return Turn(state.activity)
    begun = replace(measuring, asked=asked)
    return Turn(begun, measuring.command if measuring.speed is None else HALTED)


def _looked(state: ControllerState, asked: Asked, seen: AxisFeedback) -> Asked:
    slowed = abs(seen.velocity_dps) < SLOWED * abs(asked.velocity_dps)
    reacted_at = state.now if asked.reacted_at is None and slowed else asked.reacted_at
    return replace(asked, reacted_at=reacted_at, looked_at=state.now if seen.moving else asked.looked_at)


def _stood(
    state: ControllerState, measuring: Measuring, asked: Asked, feedback: Feedback, seen: AxisFeedback
) -> None:
    if measuring.speed is None:
        _keep_link_loss(state, measuring, asked, feedback, seen, LinkLossOutcome.STOPPED)
        return
    proof = StopProof(
        measuring.axis,
        measuring.speed,
        abs(asked.velocity_dps) or measuring.speed_dps,
        (state.now - asked.at).total_seconds(),
        abs(seen.position_deg - asked.position_deg),
        (state.now - asked.looked_at).total_seconds(),
        state.site_time,
        measuring.actor,
        state.config.drive,
        state.config.axis(measuring.axis),
    )
    state.remember(proofs=state.memory.proofs.keep(proof))
    _end(
        state,
        measuring,
        "measured",
        (
            say(
                "the axis was at standstill {stopped_after_s} s and {overrun_deg} degrees after the "
                "stop command.",
                stopped_after_s=with_format(proof.stopped_after_s, ".2f"),
                overrun_deg=with_format(proof.overrun_deg, ".2f"),
            )
        ),
    )


def _went_on(
    state: ControllerState, measuring: Measuring, asked: Asked, feedback: Feedback, seen: AxisFeedback
) -> None:
    """The axis did not come to rest in time: a fault after a stop, a result of the link-loss test."""
    if measuring.speed is None:
        _keep_link_loss(state, measuring, asked, feedback, seen, LinkLossOutcome.WENT_ON)
        return
    fail(
        state,
        Reason(
            "stop_overdue",
            say(
                "The {axis} axis of {name} did not stop after the stop command.",
                axis=measuring.axis,
                name=state.config.name,
            ),
            N_("Use the emergency stop. Check the drive and its deceleration before you continue."),
        ),
    )


def _keep_link_loss(
    state: ControllerState,
    measuring: Measuring,
    asked: Asked,
    feedback: Feedback,
    seen: AxisFeedback,
    outcome: LinkLossOutcome,
) -> None:
    """Keep what the drive did by itself; a trusted zero counts as kept if the drive still reports it."""
    stood = outcome is LinkLossOutcome.STOPPED
    after_s = (state.now - asked.at).total_seconds()
    proof = LinkLossProof(
        axis=measuring.axis,
        outcome=outcome,
        speed_dps=abs(asked.velocity_dps) or measuring.speed_dps,
        expected_s=state.capabilities.watchdog_s,
        reacted_after_s=(asked.reacted_at - asked.at).total_seconds() if asked.reacted_at else None,
        stopped_after_s=after_s if stood else None,
        overrun_deg=abs(seen.position_deg - asked.position_deg),
        resolution_s=(state.now - asked.looked_at).total_seconds() if stood else 0.0,
        reported=feedback.watchdog_tripped,
        fault_code=feedback.fault_code,
        home_kept=feedback.azimuth.homed and feedback.elevation.homed,
        at=state.site_time,
        by=measuring.actor,
        drive=state.config.drive,
    )
    state.remember(proofs=state.memory.proofs.keep(proof))
    words = (
        say(
            "the drive stopped automatically; it was at standstill {after_s} s after the last command.",
            after_s=with_format(after_s, ".2f"),
        )
        if stood
        else say(
            "the drive had not stopped {after_s} s after the last command; a stop command was sent.",
            after_s=with_format(after_s, ".1f"),
        )
    )
    _end(state, measuring, outcome, words)


def _end(state: ControllerState, measuring: Measuring, outcome: str, words: str) -> None:
    hold(state)
    state.say(
        EventKind.DRIVE_TEST_ENDED,
        say(
            "{measuring} of the {axis} axis: {words}",
            measuring=_title(measuring),
            axis=measuring.axis,
            words=words,
        ),
        proof=_kind(measuring),
        axis=measuring.axis,
        outcome=outcome,
    )


def _kind(measuring: Measuring) -> ProofKind:
    return ProofKind.LINK_LOSS if measuring.speed is None else ProofKind.STOP


def _title(measuring: Measuring) -> Message:
    return N_("Communication-loss test") if measuring.speed is None else N_("Stop test")
