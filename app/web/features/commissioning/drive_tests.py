"""The drive is proven at the machine: direction, scale, limits, stopping, and losing contact."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, Word, say, told_by
from app.base.permission import Permission
from app.link.messages import AnswerDirection, AnswerScale, SetSoftLimit
from app.tracker.commands.commands import (
    RunCommunicationLossTest,
    RunDirectionTest,
    RunScaleTest,
    RunStopTest,
)
from app.tracker.commissioning.steps import StepStatus
from app.tracker.memory.drive_tests import AxisEnd, ProofKind, ProofMove, StopSpeed
from app.tracker.settings.axes import Axis
from app.web.features.commissioning.drive_contexts import ProofsPage
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/drive-tests")
SCALE_WAYS = {"10": 10.0, "30": 30.0, "90": 90.0}
QUESTIONS = {
    (Axis.AZIMUTH, True): N_("Did the panel turn to the right, clockwise as seen from above?"),
    (Axis.AZIMUTH, False): N_("Did the panel turn to the left, counterclockwise as seen from above?"),
    (Axis.ELEVATION, True): N_("Did the front of the panel tilt up, toward the sky?"),
    (Axis.ELEVATION, False): N_("Did the front of the panel tilt down, toward the horizon?"),
}
AxisField = Annotated[Axis, Form()]


@router.get("")
@needs(Permission.READ)
async def proofs(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show every proof, its state, its result and its keys."""
    return await _answer(request, tracker_id, machine, Typed({"measured": ""}))


@router.post("/direction")
@needs(Permission.CONFIGURE)
async def direction(tracker_id: str, press: PressDep, axis: AxisField) -> Response:
    """Turn one axis a little."""
    await press.send(RunDirectionTest(axis), tracker_id)
    return press.answer(N_("Watch the panel."))


@router.post("/direction/answer")
@needs(Permission.CONFIGURE)
async def answer_direction(tracker_id: str, press: PressDep, answer: Annotated[str, Form()] = "") -> Response:
    """Take what was seen; the wrong way turns the direction round in the settings."""
    if answer not in ("right", "wrong"):
        raise NotAcceptable(N_("Select whether the panel turned as the question says, or the other way."))
    await press.send(AnswerDirection(tracker_id, answer == "right"))
    return press.answer(
        N_("Result recorded.")
        if answer == "right"
        else N_("The direction is inverted; repeat the direction test.")
    )


@router.post("/scale")
@needs(Permission.CONFIGURE)
async def scale(
    tracker_id: str, press: PressDep, axis: AxisField, way: Annotated[str, Form()] = "10"
) -> Response:
    """Turn one axis by 10, 30 or 90 degrees."""
    if way not in SCALE_WAYS:
        raise NotAcceptable(N_("Choose 10, 30, or 90 degrees."))
    await press.send(RunScaleTest(axis, SCALE_WAYS[way]), tracker_id)
    return press.answer(N_("Wait until the axis is at standstill, then measure."))


@router.post("/scale/answer")
@needs(Permission.CONFIGURE)
async def answer_scale(
    tracker_id: str, press: PressDep, machine: MachineDep, measured: Annotated[str, Form()] = ""
) -> Response:
    """Take the measured angle; one that differs corrects the gear ratio."""
    typed = Typed({"measured": measured})
    measured_deg = typed.number("measured", N_("Measured angle"), 0.1, 720, "°")
    if typed.errors:
        return await _answer(press.request, tracker_id, machine, typed, status=422)
    try:
        await press.send(AnswerScale(tracker_id, measured_deg))
    except NotAcceptable as refusal:
        typed.errors["measured"] = told_by(refusal)
        return await _answer(press.request, tracker_id, machine, typed, status=422)
    return press.answer(N_("Result recorded."))


@router.post("/limit")
@needs(Permission.CONFIGURE)
async def limit(
    tracker_id: str, press: PressDep, axis: AxisField, end: Annotated[AxisEnd, Form()]
) -> Response:
    """Take the place where the axis stands as a soft limit."""
    await press.send(SetSoftLimit(tracker_id, axis, end))
    return press.answer(say("The {end} limit is set.", end=Word(end)))


@router.post("/stop")
@needs(Permission.CONFIGURE)
async def stop_test(
    tracker_id: str, press: PressDep, axis: AxisField, speed: Annotated[StopSpeed, Form()]
) -> Response:
    """Start the stop test."""
    await press.send(RunStopTest(axis, speed), tracker_id)
    return press.answer()


@router.post("/link-loss")
@needs(Permission.CONFIGURE)
async def link_loss_test(tracker_id: str, press: PressDep, axis: AxisField) -> Response:
    """Start the link-loss test."""
    await press.send(RunCommunicationLossTest(axis), tracker_id)
    return press.answer()


async def _answer(
    request: Request, tracker_id: str, machine: MachineDep, typed: Typed, *, status: int = 200
) -> Response:
    tracker = tracker_of(await machine.detail(), tracker_id)
    memory = tracker.state.memory
    states = {kind.value: tuple(one for one in tracker.proofs if one.kind is kind) for kind in ProofKind}
    context = ProofsPage(
        frame=tracker_frame(request, tracker_id, N_("Drive tests")),
        config=tracker.state.config,
        memory=memory,
        capabilities=tracker.capabilities,
        states=states,
        move=memory.proofs.move,
        question=_question(memory.proofs.move),
        form=typed.form(("measured",)),
        left=sum(one.status is not StepStatus.DONE for one in tracker.proofs),
    )
    return page(request, context, block="proofs", status=status)


def _question(move: ProofMove | None) -> str:
    if move is None or move.to_deg is None or move.kind is not ProofKind.DIRECTION:
        return ""
    return QUESTIONS[move.axis, move.moved_deg > 0.0]
