"""The service page: the switch at the cabinet, service mode with its clear area, trust in the zero."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.tracker.commands import BeginServiceMode, ConfirmAreaClear, EndServiceMode
from app.web.deps import MachineDep
from app.web.errors import NotAcceptable
from app.web.late_routes import page_router
from app.web.protection_contexts import ServicePage
from app.web.ui.frame import tracker_frame
from app.web.ui.orders import PressDep
from app.web.ui.render import page
from app.web.ui.wizard import tracker_of
from app.web.ui.zero import blocked_without_zero

router = page_router(prefix="/trackers/{tracker_id}/service")
LOOK_FIRST = "Check the area, then confirm that no one is within reach of the panel."


@router.get("")
async def service(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show who may move the machine now, and the keys to serve it."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    context = ServicePage(
        frame=tracker_frame(request, tracker_id, "Service"),
        config=tracker.state.config,
        blocked=blocked_without_zero(),
    )
    return page(request, context)


@router.post("")
async def begin(tracker_id: str, press: PressDep, name: Annotated[str, Form(max_length=60)] = "") -> Response:
    """Begin service mode in somebody's name."""
    await press.send(BeginServiceMode(name), tracker_id)
    return press.answer("Service mode is on. The tracker moves only after you press Confirm area clear.")


@router.post("/clear")
async def clear(
    tracker_id: str, press: PressDep, looked: Annotated[str, Form(max_length=10)] = ""
) -> Response:
    """Take the word that nobody stands where the panel moves; it must be given, not just sent."""
    if looked != "yes":
        raise NotAcceptable(LOOK_FIRST)
    await press.send(ConfirmAreaClear(), tracker_id)
    return press.answer("Area confirmed clear. The confirmation is valid for the time shown.")


@router.post("/end")
async def end(tracker_id: str, press: PressDep) -> Response:
    """Leave service mode."""
    await press.send(EndServiceMode(), tracker_id)
    return press.answer("Service mode has ended; this starts no motion.")
