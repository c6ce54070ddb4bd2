"""Training on a simulated tracker: play a fault and see what an operator would see."""

from typing import Annotated

from fastapi import APIRouter, Form
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import ClearFaults, PlayFault
from app.tracker.config import DriveKind
from app.tracker.training import LESSONS
from app.web.deps import MachineDep
from app.web.drive_contexts import TrainingPage
from app.web.ui.frame import tracker_frame
from app.web.ui.orders import PressDep
from app.web.ui.render import page
from app.web.ui.wizard import tracker_of

router = APIRouter(prefix="/trackers/{tracker_id}/training")


@router.get("")
async def training(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show every fault that can be played."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    simulated = tracker.state.config.drive.kind is DriveKind.SIMULATED
    frame = tracker_frame(request, tracker_id, "Training")
    return page(request, TrainingPage(frame, LESSONS if simulated else (), simulated))


@router.post("/play")
async def play(tracker_id: str, press: PressDep, fault: Annotated[str, Form(max_length=40)] = "") -> Response:
    """Play one fault."""
    await press.send(PlayFault(tracker_id, fault))
    return press.answer("The fault is played.")


@router.post("/clear")
async def clear(tracker_id: str, press: PressDep) -> Response:
    """End every fault that is played."""
    await press.send(ClearFaults(tracker_id))
    return press.answer("No fault is played any more. What is latched waits for you.")
