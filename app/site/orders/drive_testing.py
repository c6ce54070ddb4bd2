"""What somebody says about a drive at the machine: which way, how far, where the ends are; and undoing."""

from dataclasses import replace
from math import isfinite

from app.base.message import N_, Message, join, say, told_by, with_format
from app.link.messages import AnswerDirection, AnswerScale, CheckConnection, RestoreDrive, SetSoftLimit
from app.site.loop.loop import TrackerLoop
from app.site.orders import tracker_setup
from app.site.state.model import SiteModel
from app.site.state.validation import check_drive
from app.tracker.access.interlocks import Action
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.drive_check import CheckOutcome, DriveCheck, DriveReadings
from app.tracker.memory.drive_tests import (
    AxisEnd,
    DirectionProof,
    LimitProof,
    ProofKind,
    ProofMove,
    Proofs,
    ScaleProof,
)
from app.tracker.motion.guards import axis_feedback
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import AxisDrive, DriveConfig, TrackerConfig
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason

LARGEST_CORRECTION = 20.0
LIMIT_DECIMALS = 2
RATIO_DIGITS = 6
"""More than can be measured, and as many as people read and type."""
NOTHING_TO_JUDGE = Reason(
    "nothing_to_judge",
    N_("The axis has not been moved for this drive test."),
    N_("Move the axis first, then enter what you saw."),
)
NOTHING_TO_UNDO = Reason(
    "nothing_to_undo", N_("The drive settings have not been changed."), N_("No action is needed.")
)


async def answer_direction(model: SiteModel, answer: AnswerDirection, actor: str) -> tuple[Event, ...]:
    """Keep that the direction is right, or turn it round in the settings so that it can be proven again."""
    loop, move = _judged(model, answer.tracker_id, ProofKind.DIRECTION)
    config, done = loop.config, replace(loop.memory.proofs, move=None)
    if answer.right:
        proof = DirectionProof(move.axis, move.moved_deg, model.now(), actor, config.drive)
        text = say("The {axis} axis moves in the right direction.", axis=move.axis)
        return await _keep(model, loop, done.keep(proof), _event(model, loop, move, text, "proven", actor))
    own = config.drive.axis(move.axis)
    drive = _with_axis(config.drive, move.axis, replace(own, inverted=not own.inverted))
    text = say(
        "The {axis} axis moved in the wrong direction; its direction is now inverted. Repeat the drive test.",
        axis=move.axis,
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
            say(
                "The axis moved {moved_deg} degrees by the controller's count. Enter the degrees "
                "that the panel turned, without a sign.",
                moved_deg=with_format(moved_deg, ".2f"),
            )
        )
    config, done = loop.config, replace(loop.memory.proofs, move=None)
    proof = ScaleProof(move.axis, moved_deg, measured_deg, model.now(), actor, config.drive)
    if proof.within_tolerance:
        text = say(
            "The {axis} axis was measured: {measured_deg} of {moved_deg} degrees.",
            axis=move.axis,
            measured_deg=with_format(measured_deg, ".2f"),
            moved_deg=with_format(moved_deg, ".2f"),
        )
        return await _keep(model, loop, done.keep(proof), _event(model, loop, move, text, "proven", actor))
    own = config.drive.axis(move.axis)
    gear_ratio = float(f"{own.gear_ratio * moved_deg / measured_deg:.{RATIO_DIGITS}g}")
    drive = _with_axis(config.drive, move.axis, replace(own, gear_ratio=gear_ratio))
    text = say(
        "The {axis} axis moved {measured_deg} instead of {moved_deg} degrees; its gear ratio "
        "is now {gear_ratio}. Repeat the drive test.",
        axis=move.axis,
        measured_deg=with_format(measured_deg, ".2f"),
        moved_deg=with_format(moved_deg, ".2f"),
        gear_ratio=with_format(gear_ratio, "g"),
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
    text = say(
        "The {end} soft limit of the {axis} axis is set to {limit_deg} degrees, its present position.",
        end=wanted.end,
        axis=axis,
        limit_deg=with_format(limit_deg, ".2f"),
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
    tracker_setup.refuse_while_busy(loop)
    check_drive(wanted.drive)
    readings = _judged_fit(
        model, replace(loop.config, drive=wanted.drive), await model.checks.look(wanted.drive)
    )
    model.checks.keep(wanted.tracker_id, DriveCheck(wanted.drive, model.now(), actor, readings))
    event = model.event(
        EventKind.DRIVE_CHECKED,
        say(
            "The connection to the drive of {name} was tested: {message}",
            name=loop.config.name,
            message=readings.message,
        ),
        actor,
        wanted.tracker_id,
        outcome=readings.outcome,
    )
    await model.ledger.append((event,))
    return (event,)


def _judged_fit(model: SiteModel, config: TrackerConfig, readings: DriveReadings) -> DriveReadings:
    """Return the readings of a drive that answers, with what of the settings does not fit its registers."""
    if readings.outcome is not CheckOutcome.ANSWERED:
        return readings
    try:
        model.check_drive(config)
    except ValueError as error:
        return replace(readings, message=join(" ", (readings.message, told_by(error))))
    return readings


def _judged(model: SiteModel, tracker_id: str, kind: ProofKind) -> tuple[TrackerLoop, ProofMove]:
    """Return a tracker at rest and its finished move of this kind, or raise `CommandRejected`."""
    loop = model.tracker(tracker_id)
    tracker_setup.refuse_while_busy(loop)
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
    model: SiteModel, loop: TrackerLoop, move: ProofMove, text: Message, outcome: str, actor: str
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
