"""The service page: the switch at the cabinet, service mode with its clear area, trust in the zero."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.names import LONGEST_TYPED
from app.base.permission import Permission
from app.tracker.commands.commands import BeginServiceMode, ConfirmAreaClear, EndServiceMode
from app.web.features.setup.protection_contexts import ServicePage
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.deps import MachineDep
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page
from app.web.shell.without_zero import blocked_without_zero
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/service")
LOOK_FIRST = N_("Check the area, then confirm that no one is within reach of the panel.")


@router.get("")
@needs(Permission.READ)
async def service(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show who may move the machine now, and the keys to serve it."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    context = ServicePage(
        frame=tracker_frame(request, tracker_id, N_("Service")),
        config=tracker.state.config,
        blocked=blocked_without_zero(),
    )
    return page(request, context)


@router.post("")
@needs(Permission.OPERATE)
async def begin(
    tracker_id: str, press: PressDep, name: Annotated[str, Form(max_length=LONGEST_TYPED)] = ""
) -> Response:
    """Begin service mode in somebody's name."""
    await press.send(BeginServiceMode(name), tracker_id)
    return press.answer()


@router.post("/clear")
@needs(Permission.OPERATE)
async def clear(
    tracker_id: str, press: PressDep, looked: Annotated[str, Form(max_length=10), MAY_BE_ABSENT] = ""
) -> Response:
    """Take the word that nobody stands where the panel moves; it must be given, not just sent."""
    if looked != "yes":
        raise NotAcceptable(LOOK_FIRST)
    await press.send(ConfirmAreaClear(), tracker_id)
    return press.answer()


@router.post("/end")
@needs(Permission.OPERATE)
async def end(tracker_id: str, press: PressDep) -> Response:
    """Leave service mode."""
    await press.send(EndServiceMode(), tracker_id)
    return press.answer()
