"""One tracker live, and the keys that move it."""

from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import SiteDetail, TrackerDetail
from app.tracker.commands.commands import Move, Park, ResetFault, Stop, Track
from app.tracker.settings.config import Orientation
from app.tracker.values.typed_numbers import written
from app.web.charts.sunpath import diagram
from app.web.features.control.mode import choice, limits_text
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import TrackerPage
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page
from app.web.shell.scene import scene_now
from app.web.shell.without_zero import blocked_without_zero
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}")


class GoForm(BaseModel):
    """A direction as it was typed."""

    azimuth: str = ""
    elevation: str = ""


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the tracker as it is now."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    held = tracker.state.memory.orientation
    typed = Typed({"azimuth": written(held.azimuth_deg), "elevation": written(held.elevation_deg)})
    return _answer(request, detail, tracker, typed)


@router.post("/stop")
@needs(Permission.STOP)
async def stop(tracker_id: str, press: PressDep) -> Response:
    """Stop both axes now."""
    await press.send(Stop(), tracker_id)
    return press.answer()


@router.post("/track")
@needs(Permission.OPERATE)
async def track(tracker_id: str, press: PressDep) -> Response:
    """Follow the selected mode from now on."""
    await press.send(Track(), tracker_id)
    return press.answer()


@router.post("/park")
@needs(Permission.OPERATE)
async def park(tracker_id: str, press: PressDep) -> Response:
    """Go to the park position."""
    await press.send(Park(), tracker_id)
    return press.answer()


@router.post("/reset-fault")
@needs(Permission.OPERATE)
async def reset_fault(tracker_id: str, press: PressDep) -> Response:
    """Clear the fault after its cause is removed."""
    await press.send(ResetFault(), tracker_id)
    return press.answer()


@router.post("/move")
@needs(Permission.OPERATE)
async def move(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[GoForm, Form()]
) -> Response:
    """Go to a typed direction and stay there."""
    found = Typed(typed.model_dump())
    azimuth_deg = found.number("azimuth", N_("Azimuth"), 0, 360, "°")
    elevation_deg = found.number("elevation", N_("Elevation"), 0, 90, "°")
    if found.errors:
        detail = await machine.detail()
        return _answer(press.request, detail, tracker_of(detail, tracker_id), found, status=422)
    await press.send(Move(Orientation(azimuth_deg, elevation_deg)), tracker_id)
    return press.answer()


def _answer(
    request: Request, detail: SiteDetail, tracker: TrackerDetail, typed: Typed, *, status: int = 200
) -> Response:
    config, memory = tracker.state.config, tracker.state.memory
    frame = tracker_frame(request, config.tracker_id, N_("Live"))
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
