"""What somebody says about a drive at the machine: which way, how far, where the ends are; and undoing."""

from dataclasses import replace
from math import isfinite

from app.link.messages import AnswerDirection, AnswerScale, CheckConnection, RestoreDrive, SetSoftLimit
from app.site import tracker_setup
from app.site.loop import TrackerLoop
from app.site.model import SiteModel
from app.site.validation import check_drive
from app.tracker.axes import Axis, AxisConfig
from app.tracker.commands import CommandRejected
from app.tracker.config import AxisDrive, DriveConfig, TrackerConfig
from app.tracker.drive_check import DriveCheck
from app.tracker.drive_tests import (
    AxisEnd,
    DirectionProof,
    LimitProof,
    ProofKind,
    ProofMove,
    Proofs,
    ScaleProof,
)
from app.tracker.guards import axis_feedback
from app.tracker.interlocks import Action
from app.tracker.reason import Reason
from app.tracker.snapshot import Event, EventKind

LARGEST_CORRECTION = 20.0
LIMIT_DECIMALS = 2
RATIO_DIGITS = 6
"""More than can be measured, and as many as people read and type."""
NOTHING_TO_JUDGE = Reason(
    "nothing_to_judge",
    "The axis has not been moved for this drive test.",
    "Move the axis first, then enter what you saw.",
)
NOTHING_TO_UNDO = Reason(
    "nothing_to_undo", "The drive settings have not been changed.", "No action is needed."
)


async def answer_direction(model: SiteModel, answer: AnswerDirection, actor: str) -> tuple[Event, ...]:
    """Keep that the direction is right, or turn it round in the settings so that it can be proven again."""
    loop, move = _judged(model, answer.tracker_id, ProofKind.DIRECTION)
    config, done = loop.config, replace(loop.memory.proofs, move=None)
    if answer.right:
        proof = DirectionProof(move.axis, move.moved_deg, model.now(), actor, config.drive)
        text = f"The {move.axis} axis moves in the right direction."
        return await _keep(model, loop, done.keep(proof), _event(model, loop, move, text, "proven", actor))
    own = config.drive.axis(move.axis)
    drive = _with_axis(config.drive, move.axis, replace(own, inverted=not own.inverted))
    text = (
        f"The {move.axis} axis moved in the wrong direction; its direction is now inverted. "
        "Repeat the drive test."
    )
    event = _event(model, loop, move, text, "reversed", actor)
    return await _change(model, loop, replace(config, drive=drive), done, event, actor)


async def answer_scale(model: SiteModel, answer: AnswerScale, actor: str) -> tuple[Event, ...]:
    """Keep that the scale is right, or correct the gear ratio so that it can be proven again."""
    loop, move = _judged(model, answer.tracker_id, ProofKind.SCALE)
    moved_deg, measured_deg = abs(move.moved_deg), answer.measured_deg
    if (
        not isfinite(measured_deg)
        or not 1.0 / LARGEST_CORRECTION < measured_deg / moved_deg < LARGEST_CORRECTION
    ):
        raise ValueError(
            f"The axis moved {moved_deg:.2f} degrees by the controller's count. Enter the degrees "
            "that the panel turned, without a sign."
        )
    config, done = loop.config, replace(loop.memory.proofs, move=None)
    proof = ScaleProof(move.axis, moved_deg, measured_deg, model.now(), actor, config.drive)
    if proof.within_tolerance:
        text = f"The {move.axis} axis was measured: {measured_deg:.2f} of {moved_deg:.2f} degrees."
        return await _keep(model, loop, done.keep(proof), _event(model, loop, move, text, "proven", actor))
    own = config.drive.axis(move.axis)
    gear_ratio = float(f"{own.gear_ratio * moved_deg / measured_deg:.{RATIO_DIGITS}g}")
    drive = _with_axis(config.drive, move.axis, replace(own, gear_ratio=gear_ratio))
    text = (
        f"The {move.axis} axis moved {measured_deg:.2f} instead of {moved_deg:.2f} degrees; its "
        f"gear ratio is now {gear_ratio:g}. Repeat the drive test."
    )
    event = _event(model, loop, move, text, "corrected", actor)
    return await _change(model, loop, replace(config, drive=drive), done, event, actor)


async def set_soft_limit(model: SiteModel, wanted: SetSoftLimit, actor: str) -> tuple[Event, ...]:
    """Take the place where an axis stands as its lower or upper soft limit."""
    loop = model.tracker(wanted.tracker_id)
    reasons = loop.snapshot(model.now()).actions[Action.SET_LIMIT]
    if reasons or loop.feedback is None:
        raise CommandRejected(*reasons)
    config, axis = loop.config, wanted.axis
    limit_deg = round(axis_feedback(loop.feedback, axis).position_deg, LIMIT_DECIMALS)
    settings = _limited(config.axis(axis), wanted.end, limit_deg)
    proof = LimitProof(axis, wanted.end, limit_deg, model.now(), actor)
    text = (
        f"The {wanted.end} soft limit of the {axis} axis is set to {limit_deg:.2f} degrees, its "
        "present position."
    )
    event = model.event(
        EventKind.DRIVE_TEST_ENDED,
        text,
        actor,
        config.tracker_id,
        proof=ProofKind.LIMITS,
        axis=axis,
        outcome="set",
    )
    azimuth, elevation = (settings, config.elevation) if axis is Axis.AZIMUTH else (config.azimuth, settings)
    changed = replace(config, azimuth=azimuth, elevation=elevation)
    return await _change(model, loop, changed, loop.memory.proofs.keep(proof), event, actor)


async def restore_drive(model: SiteModel, wanted: RestoreDrive, actor: str) -> tuple[Event, ...]:
    """Set the drive as it was before the last change; the present settings can be restored the same way."""
    loop = model.tracker(wanted.tracker_id)
    former = loop.memory.former_drive
    if former is None:
        raise CommandRejected(NOTHING_TO_UNDO)
    return await tracker_setup.configure(model, replace(loop.config, drive=former), actor)


async def check_connection(model: SiteModel, wanted: CheckConnection, actor: str) -> tuple[Event, ...]:
    """Read a drive while the tracker stands still, change nothing, and keep what it answered."""
    loop = model.tracker(wanted.tracker_id)
    tracker_setup.refuse_while_busy(model, loop)
    check_drive(wanted.drive)
    readings = await model.checks.look(wanted.drive)
    model.checks.keep(wanted.tracker_id, DriveCheck(wanted.drive, model.now(), actor, readings))
    event = model.event(
        EventKind.DRIVE_CHECKED,
        f"The connection to the drive of {loop.config.name} was tested: {readings.message}",
        actor,
        wanted.tracker_id,
        outcome=readings.outcome,
    )
    await model.ledger.append((event,))
    return (event,)


def _judged(model: SiteModel, tracker_id: str, kind: ProofKind) -> tuple[TrackerLoop, ProofMove]:
    """Return a tracker at rest and its finished move of this kind, or raise `CommandRejected`."""
    loop = model.tracker(tracker_id)
    tracker_setup.refuse_while_busy(model, loop)
    move = loop.memory.proofs.move
    if move is None or move.kind is not kind or move.to_deg is None:
        raise CommandRejected(NOTHING_TO_JUDGE)
    return loop, move


def _limited(settings: AxisConfig, end: AxisEnd, limit_deg: float) -> AxisConfig:
    """Return an axis with another limit; raise `ValueError` for one beyond the other end."""
    if end is AxisEnd.LOWER:
        return replace(settings, minimum_deg=limit_deg)
    return replace(settings, maximum_deg=limit_deg)


def _with_axis(drive: DriveConfig, axis: Axis, own: AxisDrive) -> DriveConfig:
    return replace(drive, azimuth=own) if axis is Axis.AZIMUTH else replace(drive, elevation=own)


def _event(
    model: SiteModel, loop: TrackerLoop, move: ProofMove, text: str, outcome: str, actor: str
) -> Event:
    return model.event(
        EventKind.DRIVE_TEST_ENDED,
        text,
        actor,
        loop.config.tracker_id,
        proof=move.kind,
        axis=move.axis,
        outcome=outcome,
    )


async def _keep(model: SiteModel, loop: TrackerLoop, proofs: Proofs, event: Event) -> tuple[Event, ...]:
    memory = replace(loop.memory, proofs=proofs)
    await model.ledger.save_tracker(replace(loop.state, memory=memory), (event,))
    loop.controller.set_proofs(proofs)
    return (event,)


async def _change(
    model: SiteModel, loop: TrackerLoop, config: TrackerConfig, proofs: Proofs, event: Event, actor: str
) -> tuple[Event, ...]:
    """Change the configuration, then keep the proofs on the tracker that comes of it."""
    changed = await tracker_setup.configure(model, config, actor)
    return changed + await _keep(model, model.tracker(loop.config.tracker_id), proofs, event)
