"""Step 4: what the tracker shall do, and where it holds the axes that do not follow the sun."""

from typing import Annotated

from fastapi import APIRouter, Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import TrackerDetail
from app.tracker.commands import Move, SelectMode
from app.tracker.config import Orientation, TrackerConfig
from app.tracker.memory import StepName
from app.tracker.mode import Mode
from app.web.contexts import ModeChoice, ModePage, OrientationPage
from app.web.deps import MachineDep
from app.web.errors import NotAcceptable
from app.web.ui.forms import Typed
from app.web.ui.orders import Press, PressDep
from app.web.ui.render import go, page
from app.web.ui.sunpath import todays_arc
from app.web.ui.wizard import tracker_of, wizard_frame

router = APIRouter(prefix="/trackers/{tracker_id}/commissioning/mode")
CHOICES = (
    ModeChoice(Mode.DUAL, "Dual-axis tracking", "Both axes follow the sun. The most energy."),
    ModeChoice(Mode.AZIMUTH, "Azimuth tracking", "The panel turns with the sun and keeps one elevation."),
    ModeChoice(Mode.ELEVATION, "Elevation tracking", "The panel tilts with the sun and keeps one azimuth."),
    ModeChoice(Mode.FIXED, "Fixed", "The panel goes to one orientation and stays there."),
)
HELD = {
    Mode.FIXED: ("azimuth", "elevation"),
    Mode.AZIMUTH: ("elevation",),
    Mode.ELEVATION: ("azimuth",),
    Mode.DUAL: (),
}


class OrientationForm(BaseModel):
    """The form as it was typed; an axis that follows the sun is not asked for."""

    azimuth: str = ""
    elevation: str = ""


@router.get("")
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the four modes."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    frame = wizard_frame(request, tracker, StepName.MODE)
    return page(request, ModePage(frame=frame, choices=CHOICES, chosen=tracker.state.memory.mode))


@router.post("")
async def choose(tracker_id: str, press: PressDep, mode: Annotated[str, Form()] = "") -> Response:
    """Save the mode; go on to its orientation, or to the last step."""
    if mode not in list(Mode):
        raise NotAcceptable("Choose one of the four modes.")
    await press.send(SelectMode(Mode(mode)), tracker_id)
    root = f"/trackers/{tracker_id}/commissioning"
    return go(press.request, f"{root}/run" if Mode(mode) is Mode.DUAL else f"{root}/mode/orientation")


@router.get("/orientation")
async def orientation(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the angles that the chosen mode holds."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    held = tracker.state.memory.orientation
    texts = {"azimuth": f"{held.azimuth_deg:g}", "elevation": f"{held.elevation_deg:g}"}
    return _orientation(request, tracker, Typed(texts))


@router.post("/orientation")
async def go_there(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[OrientationForm, Form()]
) -> Response:
    """Save the angles and move the panel there."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    mode = tracker.state.memory.mode or Mode.DUAL
    found = Typed(typed.model_dump())
    wanted = _read(found, tracker, mode)
    if found.errors:
        return _orientation(press.request, tracker, found, status=422)
    await _save_and_move(press, tracker_id, mode, wanted)
    return go(press.request, press.request.url.path)


async def _save_and_move(press: Press, tracker_id: str, mode: Mode, wanted: Orientation) -> None:
    key = press.key
    await press.send(SelectMode(mode, wanted), tracker_id)
    press.key = f"{key}-go" if key else None
    await press.send(Move(wanted), tracker_id)


def _read(found: Typed, tracker: TrackerDetail, mode: Mode) -> Orientation:
    config, held = tracker.state.config, tracker.state.memory.orientation
    azimuth_deg, elevation_deg = held.azimuth_deg, held.elevation_deg
    if "azimuth" in HELD[mode]:
        azimuth_deg = found.number("azimuth", "Azimuth", 0, 360)
    if "elevation" in HELD[mode]:
        limits = config.elevation
        elevation_deg = found.number("elevation", "Elevation", limits.minimum_deg, limits.maximum_deg)
    return Orientation(azimuth_deg, elevation_deg)


def _orientation(request: Request, tracker: TrackerDetail, typed: Typed, *, status: int = 200) -> Response:
    mode = tracker.state.memory.mode or Mode.DUAL
    frame = wizard_frame(request, tracker, StepName.MODE)
    context = OrientationPage(
        frame=frame,
        form=typed.form(("azimuth", "elevation")),
        held=HELD[mode],
        choice=choice(mode),
        limits=limits_text(tracker.state.config),
        arc=todays_arc(frame.site, tracker.state.config),
    )
    return page(request, context, block="form", status=status)


def choice(mode: Mode) -> ModeChoice:
    """Return a mode's label and what it does."""
    return next(one for one in CHOICES if one.mode is mode)


def limits_text(config: TrackerConfig) -> str:
    """Return the soft limits as a sentence."""
    azimuth, elevation = config.azimuth, config.elevation
    return (
        f"Soft limits: azimuth {azimuth.minimum_deg:g} to {azimuth.maximum_deg:g}°, "
        f"elevation {elevation.minimum_deg:g} to {elevation.maximum_deg:g}°."
    )
