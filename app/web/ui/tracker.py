"""One tracker live, and the keys that move it."""

from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import SiteDetail, TrackerDetail
from app.tracker.commands import Move, Park, ResetFault, Stop, Track
from app.tracker.config import Orientation
from app.web.contexts import TrackerPage
from app.web.deps import MachineDep
from app.web.late_routes import page_router
from app.web.ui.forms import Typed
from app.web.ui.frame import tracker_frame
from app.web.ui.mode import choice, limits_text
from app.web.ui.orders import PressDep
from app.web.ui.render import page
from app.web.ui.scene import scene_now
from app.web.ui.sunpath import diagram
from app.web.ui.wizard import tracker_of
from app.web.ui.zero import blocked_without_zero

router = page_router(prefix="/trackers/{tracker_id}")


class GoForm(BaseModel):
    """A direction as it was typed."""

    azimuth: str = ""
    elevation: str = ""


@router.get("")
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the tracker as it is now."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    held = tracker.state.memory.orientation
    typed = Typed({"azimuth": f"{held.azimuth_deg:g}", "elevation": f"{held.elevation_deg:g}"})
    return _answer(request, detail, tracker, typed)


@router.post("/stop")
async def stop(tracker_id: str, press: PressDep) -> Response:
    """Stop both axes now."""
    await press.send(Stop(), tracker_id)
    return press.answer("Stopped.")


@router.post("/track")
async def track(tracker_id: str, press: PressDep) -> Response:
    """Follow the selected mode from now on."""
    await press.send(Track(), tracker_id)
    return press.answer("Tracking is on.")


@router.post("/park")
async def park(tracker_id: str, press: PressDep) -> Response:
    """Go to the park position."""
    await press.send(Park(), tracker_id)
    return press.answer("The panel is moving to its park position.")


@router.post("/reset-fault")
async def reset_fault(tracker_id: str, press: PressDep) -> Response:
    """Clear the fault after its cause is removed."""
    await press.send(ResetFault(), tracker_id)
    return press.answer("The fault reset was sent to the drive.")


@router.post("/move")
async def move(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[GoForm, Form()]
) -> Response:
    """Go to a typed direction and stay there."""
    found = Typed(typed.model_dump())
    azimuth_deg = found.number("azimuth", "Azimuth", 0, 360)
    elevation_deg = found.number("elevation", "Elevation", 0, 90)
    if found.errors:
        detail = await machine.detail()
        return _answer(press.request, detail, tracker_of(detail, tracker_id), found, status=422)
    await press.send(Move(Orientation(azimuth_deg, elevation_deg)), tracker_id)
    return press.answer("The panel is moving to the target.")


def _answer(
    request: Request, detail: SiteDetail, tracker: TrackerDetail, typed: Typed, *, status: int = 200
) -> Response:
    config, memory = tracker.state.config, tracker.state.memory
    frame = tracker_frame(request, config.tracker_id, "Live")
    context = TrackerPage(
        frame=frame,
        config=config,
        memory=memory,
        choice=choice(config, memory.mode) if memory.mode else None,
        form=typed.form(("azimuth", "elevation")),
        limits=limits_text(config),
        diagram=diagram(frame.site, config, detail.site.horizon),
        scene=scene_now(frame.site, config, detail.site.horizon),
        blocked=blocked_without_zero(),
    )
    return page(request, context, block="go", status=status)
