"""Step 3: the panel is driven to north and horizon by hand, and that is called zero."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import TrackerDetail
from app.tracker.commands.commands import EndJog, Home, SetHome, Step, UndoHome
from app.tracker.memory.memory import StepName
from app.tracker.settings.axes import Axis
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.contexts import HomingPage
from app.web.shell.deps import MachineDep
from app.web.shell.frame import snapshot_of
from app.web.shell.orders import PressDep
from app.web.shell.render import page
from app.web.shell.wizard import tracker_of, wizard_frame
from app.web.shell.zero import is_answer, readings, zero_doubts

pages = page_router(prefix="/trackers/{tracker_id}/commissioning/homing")
router = page_router(prefix="/trackers/{tracker_id}")
INCREMENTS = {f"{axis} {by_deg:+g}": (axis, by_deg) for axis in Axis for by_deg in (-1.0, -0.1, 0.1, 1.0)}
"""The increments of the page, by the values of their buttons."""


@pages.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the hold keys, the live position and "Set as zero"."""
    return page(request, _page(request, tracker_of(await machine.detail(), tracker_id)))


def _page(request: Request, tracker: TrackerDetail, doubts: tuple[str, ...] = ()) -> HomingPage:
    frame, mount = wizard_frame(request, tracker, StepName.HOMING), tracker.state.config.mount
    return HomingPage(
        frame=frame,
        capabilities=tracker.capabilities,
        config=tracker.state.config,
        doubts=doubts,
        asked=readings(mount, frame.tracker) if doubts and frame.tracker else "",
    )


@router.post("/zero")
@needs(Permission.CONFIGURE)
async def zero(
    tracker_id: str,
    press: PressDep,
    machine: MachineDep,
    confirmed: Annotated[str, Form(), MAY_BE_ABSENT] = "",
) -> Response:
    """Call the present position zero on both axes; ask first where the drive reads another angle.

    What is confirmed is what the question named: of other readings it is asked again.
    """
    tracker, now = tracker_of(await machine.detail(), tracker_id), snapshot_of(machine.latest(), tracker_id)
    doubts = () if now is None else zero_doubts(tracker.state.config.mount, now, tuple(Axis))
    if doubts and not (now is not None and is_answer(confirmed, readings(tracker.state.config.mount, now))):
        return page(press.request, _page(press.request, tracker, doubts), block="question", status=422)
    await press.send(SetHome(), tracker_id)
    return press.answer()


@router.post("/zero/undo")
@needs(Permission.CONFIGURE)
async def undo_home(tracker_id: str, press: PressDep) -> Response:
    """Bring back the home position as it was before it was set last."""
    await press.send(UndoHome(), tracker_id)
    return press.answer()


@router.post("/home")
@needs(Permission.CONFIGURE)
async def home(tracker_id: str, press: PressDep) -> Response:
    """Start the automatic search for the origin switches."""
    await press.send(Home(), tracker_id)
    return press.answer()


@router.post("/step")
@needs(Permission.OPERATE)
async def step(tracker_id: str, press: PressDep, increment: Annotated[str, Form()] = "") -> Response:
    """Move one axis by a small step."""
    if increment not in INCREMENTS:
        raise NotAcceptable(N_("Choose an increment of 0.1 or 1 degree of one axis."))
    await press.send(Step(*INCREMENTS[increment]), tracker_id)
    return press.answer()


@router.post("/end-jog")
@needs(Permission.STOP)
async def end_jog(
    tracker_id: str, press: PressDep, press_id: Annotated[str, Form(max_length=64)]
) -> Response:
    """End a held key by HTTP too, for a page whose socket is gone."""
    await press.send(EndJog(press_id), tracker_id)
    return Response(status_code=204)
