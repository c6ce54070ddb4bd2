"""Where every proof of a drive stands: to do, to be confirmed because something changed, or done."""

from dataclasses import dataclass, replace
from datetime import datetime

from app.base.message import N_, NOTHING, Message, say, with_format
from app.tracker.commissioning.steps import StepStatus
from app.tracker.memory.drive_tests import (
    AxisEnd,
    DirectionProof,
    LimitProof,
    LinkLossOutcome,
    LinkLossProof,
    ProofKind,
    ProofMove,
    ScaleProof,
    StopProof,
    StopSpeed,
)
from app.tracker.memory.memory import HomeTrust, TrackerMemory
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import AxisDrive, DriveConfig, TrackerConfig
from app.tracker.values.motion import DriveCapabilities
from app.tracker.values.reason import Reason

WATCHDOG_LATE_S = 0.25
"""A watchdog that acts this much later than its time-out is reported: a tick, the ramp and the reading."""


@dataclass(frozen=True, slots=True)
class ProofState:
    """One proof as pages, the API and the record show it; `result` is empty until there was one.

    `axis` None means the whole drive; `speed` is that of a stop test.
    """

    kind: ProofKind
    axis: Axis | None
    speed: StopSpeed | None
    status: StepStatus
    reasons: tuple[Reason, ...]
    result: Message
    at: datetime | None
    by: str


def proof_states(
    config: TrackerConfig, memory: TrackerMemory, capabilities: DriveCapabilities | None
) -> tuple[ProofState, ...]:
    """Return every proof of a tracker, in the order in which they are best done."""
    return (
        *(_direction(config, memory, axis) for axis in Axis),
        *(_scale(config, memory, axis) for axis in Axis),
        *(_limits(config, memory, axis) for axis in Axis),
        *(_stop(config, memory, axis, speed) for axis in Axis for speed in StopSpeed),
        _link_loss(config, memory, capabilities),
    )


def _direction(config: TrackerConfig, memory: TrackerMemory, axis: Axis) -> ProofState:
    proof, waiting = memory.proofs.direction(axis), _to_judge(memory, ProofKind.DIRECTION, axis)
    if proof is None:
        return _open(ProofKind.DIRECTION, axis, waiting or _NO_DIRECTION)
    changed = _turning(proof.drive, axis) != _turning(config.drive, axis)
    doubts = _known(waiting, _DRIVE_CHANGED if changed else None)
    words = say(
        "The panel turned in the direction that the controller reports, by {moved_deg} degrees.",
        moved_deg=with_format(proof.moved_deg, "+.2f"),
    )
    return _done(ProofKind.DIRECTION, axis, proof, words, doubts)


def _scale(config: TrackerConfig, memory: TrackerMemory, axis: Axis) -> ProofState:
    proof, waiting = memory.proofs.scale(axis), _to_judge(memory, ProofKind.SCALE, axis)
    if proof is None:
        return _open(ProofKind.SCALE, axis, waiting or _NO_SCALE)
    changed = _scaling(proof.drive, axis) != _scaling(config.drive, axis)
    doubts = _known(waiting, _DRIVE_CHANGED if changed else None)
    words = say(
        "The controller reported {moved_deg} degrees; {measured_deg} degrees were measured ({value} %).",
        moved_deg=with_format(proof.moved_deg, ".2f"),
        measured_deg=with_format(proof.measured_deg, ".2f"),
        value=with_format(100.0 * proof.error_share, "+.1f"),
    )
    return _done(ProofKind.SCALE, axis, proof, words, doubts)


def _limits(config: TrackerConfig, memory: TrackerMemory, axis: Axis) -> ProofState:
    set_ones = [proof for end in AxisEnd if (proof := memory.proofs.limit(axis, end)) is not None]
    if len(set_ones) < len(AxisEnd):
        return _open(ProofKind.LIMITS, axis, _NO_LIMITS)
    settings = config.axis(axis)
    moved = any(one.limit_deg != _limit_deg(settings, one.end) for one in set_ones)
    older = any(_older(one, memory.home) for one in set_ones)
    doubts = _known(_LIMITS_CHANGED if moved else None, _ZERO_CHANGED if older else None)
    words = say(
        "Set at the tracker: {minimum_deg} to {maximum_deg} degrees.",
        minimum_deg=with_format(settings.minimum_deg, ".2f"),
        maximum_deg=with_format(settings.maximum_deg, ".2f"),
    )
    return _done(ProofKind.LIMITS, axis, max(set_ones, key=lambda one: one.at), words, doubts)


def _stop(config: TrackerConfig, memory: TrackerMemory, axis: Axis, speed: StopSpeed) -> ProofState:
    proof = memory.proofs.stop(axis, speed)
    if proof is None:
        return replace(_open(ProofKind.STOP, axis, _NO_STOP), speed=speed)
    drive = _whole(proof.drive, axis) != _whole(config.drive, axis)
    ramps = _ramp(proof.settings) != _ramp(config.axis(axis))
    doubts = _known(_DRIVE_CHANGED if drive else None, _SPEED_CHANGED if ramps else None)
    words = say(
        "From {speed_dps} degrees a second, the axis was at standstill {stopped_after_s} s "
        "and {overrun_deg} degrees after the stop command.",
        speed_dps=with_format(proof.speed_dps, ".2f"),
        stopped_after_s=with_format(proof.stopped_after_s, ".2f"),
        overrun_deg=with_format(proof.overrun_deg, ".2f"),
    )
    return replace(_done(ProofKind.STOP, axis, proof, words, doubts), speed=speed)


def _link_loss(
    config: TrackerConfig, memory: TrackerMemory, capabilities: DriveCapabilities | None
) -> ProofState:
    proof, kind = memory.proofs.link_loss, ProofKind.LINK_LOSS
    if capabilities is not None and capabilities.watchdog_s is None:
        return ProofState(kind, None, None, StepStatus.DONE, (), _NONE_TO_TEST, None, "")
    if proof is None:
        return _open(kind, None, _NO_LINK_LOSS)
    changed = _connection(proof.drive) != _connection(config.drive)
    other = capabilities is not None and capabilities.watchdog_s != proof.expected_s
    doubts = _known(_DRIVE_CHANGED if changed else None, _WATCHDOG_CHANGED if other else None, _unsafe(proof))
    return _done(kind, None, proof, _link_loss_words(proof), doubts)


def _link_loss_words(proof: LinkLossProof) -> Message:
    if proof.outcome is LinkLossOutcome.WENT_ON or proof.stopped_after_s is None:
        return N_("Without commands, the drive continued; a stop command was sent.")
    home = N_("kept its home reference") if proof.home_kept else N_("has no home reference")
    stood = say(
        "stopped after {stopped_after_s} s and {overrun_deg} degrees; it {home}.",
        stopped_after_s=with_format(proof.stopped_after_s, ".2f"),
        overrun_deg=with_format(proof.overrun_deg, ".2f"),
        home=home,
    )
    text = say("Without commands the drive {stood}", stood=stood)
    if proof.reacted_after_s is not None:
        text = say(
            "Without commands the drive slowed down after {reacted_after_s} s and {stood}",
            reacted_after_s=with_format(proof.reacted_after_s, ".2f"),
            stood=stood,
        )
    return (
        say("{text} The drive reported fault {fault_code}.", text=text, fault_code=proof.fault_code)
        if proof.fault_code
        else text
    )


def _unsafe(proof: LinkLossProof) -> Reason | None:
    """Return what the test found against the drive's watchdog."""
    if proof.outcome is LinkLossOutcome.WENT_ON:
        return _WENT_ON
    acted_s, expected_s = proof.reacted_after_s or proof.stopped_after_s, proof.expected_s
    if acted_s is None or expected_s is None or acted_s <= expected_s + WATCHDOG_LATE_S:
        return None
    return Reason(
        "watchdog_late",
        say(
            "The drive's watchdog acted after {acted_s} s instead of {expected_s} s.",
            acted_s=with_format(acted_s, ".2f"),
            expected_s=with_format(expected_s, "g"),
        ),
        N_("Check the timeout that is set in the drive, then test again."),
    )


def _to_judge(memory: TrackerMemory, kind: ProofKind, axis: Axis) -> Reason | None:
    move = memory.proofs.move
    if move is None or (move.kind, move.axis) != (kind, axis):
        return None
    return _MOVES if move.to_deg is None else _judge(move)


def _judge(move: ProofMove) -> Reason:
    text = say(
        "The axis was turned by {moved_deg} degrees; the observed panel movement has not been entered.",
        moved_deg=with_format(move.moved_deg, "+.2f"),
    )
    return Reason("move_to_judge", text, N_("Enter what you saw or measured, or turn the axis again."))


def _older(proof: LimitProof, home: HomeTrust | None) -> bool:
    """Return whether the zero, from which limits are counted, was lost or set anew since."""
    return home is None or home.set_at > proof.at


def _limit_deg(settings: AxisConfig, end: AxisEnd) -> float:
    return settings.minimum_deg if end is AxisEnd.LOWER else settings.maximum_deg


def _ramp(settings: AxisConfig) -> tuple[float, float, float]:
    return settings.speed_dps, settings.acceleration_dps2, settings.jog_fast_dps


def _whole(drive: DriveConfig, axis: Axis) -> DriveConfig:
    """Return the drive's settings without those of the other axis."""
    if axis is Axis.AZIMUTH:
        return replace(drive, elevation=AxisDrive())
    return replace(drive, azimuth=AxisDrive())


def _turning(drive: DriveConfig, axis: Axis) -> DriveConfig:
    """Return what decides the direction of an axis."""
    own = drive.axis(axis)
    return _with_axis(drive, axis, AxisDrive(unit=own.unit, inverted=own.inverted))


def _scaling(drive: DriveConfig, axis: Axis) -> DriveConfig:
    """Return what decides the scale of an axis."""
    return _with_axis(drive, axis, replace(drive.axis(axis), inverted=False))


def _connection(drive: DriveConfig) -> DriveConfig:
    """Return what decides how the drive is reached, and which."""
    azimuth, elevation = AxisDrive(unit=drive.azimuth.unit), AxisDrive(unit=drive.elevation.unit)
    return replace(drive, azimuth=azimuth, elevation=elevation)


def _with_axis(drive: DriveConfig, axis: Axis, own: AxisDrive) -> DriveConfig:
    if axis is Axis.AZIMUTH:
        return replace(drive, azimuth=own, elevation=AxisDrive())
    return replace(drive, azimuth=AxisDrive(), elevation=own)


def _known(*reasons: Reason | None) -> tuple[Reason, ...]:
    return tuple(reason for reason in reasons if reason is not None)


def _open(kind: ProofKind, axis: Axis | None, reason: Reason) -> ProofState:
    return ProofState(kind, axis, None, StepStatus.TO_DO, (reason,), NOTHING, None, "")


def _done(
    kind: ProofKind,
    axis: Axis | None,
    proof: DirectionProof | ScaleProof | LimitProof | StopProof | LinkLossProof,
    result: Message,
    doubts: tuple[Reason, ...],
) -> ProofState:
    status = StepStatus.TO_BE_CONFIRMED if doubts else StepStatus.DONE
    return ProofState(kind, axis, None, status, doubts, result, proof.at, proof.by)


_NO_DIRECTION = Reason(
    "direction_not_proven",
    N_("The direction of panel movement has not been checked."),
    N_("Turn the axis and enter what you saw."),
)
_NO_SCALE = Reason(
    "scale_not_proven",
    N_("The angle of panel movement has not been measured."),
    N_("Turn the axis by 10 degrees and measure with an inclinometer or a protractor."),
)
_NO_LIMITS = Reason(
    "limits_not_set",
    N_("The soft limits were not set at the tracker."),
    N_("Set the home position, jog to each end, and set it as the limit."),
)
_NO_STOP = Reason("stop_not_measured", N_("Stopping was not measured."), N_("Start the stop test."))
_NO_LINK_LOSS = Reason(
    "link_loss_not_tested",
    N_("The drive has not been tested for communication loss."),
    N_("Start the communication-loss test."),
)
_MOVES = Reason("move_under_way", N_("The axis is turning."), N_("Watch the panel."))
_DRIVE_CHANGED = Reason(
    "drive_changed", N_("The drive settings have changed since this test."), N_("Repeat this drive test.")
)
_SPEED_CHANGED = Reason(
    "speed_changed",
    N_("Speeds or acceleration of the axis have changed since this test."),
    N_("Repeat this test."),
)
_LIMITS_CHANGED = Reason(
    "limits_changed",
    N_("The soft limits have been changed manually since this test."),
    N_("Set the soft limits at the tracker again."),
)
_ZERO_CHANGED = Reason(
    "zero_changed",
    N_("The home position, the reference for the limits, was lost or set again since this test."),
    N_("Check both ends and set them as limits again."),
)
_WATCHDOG_CHANGED = Reason(
    "watchdog_changed",
    N_("The timeout of the drive's watchdog has changed since this test."),
    N_("Repeat the communication-loss test."),
)
_WENT_ON = Reason(
    "watchdog_does_not_act",
    N_("The drive did not stop automatically when no command reached it."),
    N_("Switch the drive's watchdog on, then test again. Until then, rely on the emergency stop."),
)
_NONE_TO_TEST = N_(
    "This drive has no watchdog: it does not stop automatically. Jogging is limited to short increments."
)
