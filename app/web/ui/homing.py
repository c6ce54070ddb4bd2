"""Step 3: the panel is driven to north and horizon by hand, and that is called zero."""

from typing import Annotated

from fastapi import APIRouter, Form
from starlette.requests import Request
from starlette.responses import Response

from app.tracker.axes import Axis
from app.tracker.commands import EndJog, Home, SetZero, Step
from app.tracker.memory import StepName
from app.web.contexts import HomingPage
from app.web.deps import MachineDep
from app.web.errors import NotAcceptable
from app.web.ui.orders import PressDep
from app.web.ui.render import page
from app.web.ui.wizard import tracker_of, wizard_frame

pages = APIRouter(prefix="/trackers/{tracker_id}/commissioning/homing")
router = APIRouter(prefix="/trackers/{tracker_id}")
STEP_SIZES = ("0.1", "1", "5")
MOVES = {
    "azimuth-minus": (Axis.AZIMUTH, -1),
    "azimuth-plus": (Axis.AZIMUTH, 1),
    "elevation-minus": (Axis.ELEVATION, -1),
    "elevation-plus": (Axis.ELEVATION, 1),
}


@pages.get("")
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the hold keys, the live position and "Set as zero"."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    context = HomingPage(
        frame=wizard_frame(request, tracker, StepName.HOMING),
        capabilities=tracker.capabilities,
        config=tracker.state.config,
    )
    return page(request, context)


@router.post("/zero")
async def zero(tracker_id: str, press: PressDep) -> Response:
    """Call the present position zero on both axes."""
    await press.send(SetZero(), tracker_id)
    return press.answer("The drive was told to set zero.")


@router.post("/home")
async def home(tracker_id: str, press: PressDep) -> Response:
    """Start the automatic search for the origin switches."""
    await press.send(Home(), tracker_id)
    return press.answer("The drive is looking for its origin switches.")


@router.post("/step")
async def step(
    tracker_id: str, press: PressDep, move: Annotated[str, Form()] = "", size: Annotated[str, Form()] = ""
) -> Response:
    """Move one axis by a small step."""
    if move not in MOVES or size not in STEP_SIZES:
        raise NotAcceptable("Choose a step of 0.1, 1 or 5 degrees and press one of the four keys.")
    axis, direction = MOVES[move]
    await press.send(Step(axis, direction * float(size)), tracker_id)
    return press.answer(f"{axis.value.capitalize()} {'+' if direction > 0 else '−'}{size}°.")


@router.post("/end-jog")
async def end_jog(
    tracker_id: str, press: PressDep, press_id: Annotated[str, Form(max_length=64)]
) -> Response:
    """End a held key by HTTP too, for a page whose socket is gone."""
    await press.send(EndJog(press_id), tracker_id)
    return Response(status_code=204)
