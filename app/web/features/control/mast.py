"""The page for a phone at the tracker: four buttons to hold, two angles, STOP."""

from dataclasses import dataclass
from typing import ClassVar

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.tracker.settings.config import TrackerConfig
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Frame
from app.web.shell.deps import MachineDep
from app.web.shell.frame import tracker_frame
from app.web.shell.render import page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/mast")


@dataclass(frozen=True, slots=True)
class MastPage:
    """What the hand at the tracker needs."""

    template: ClassVar[str] = "mast.html"

    frame: Frame
    config: TrackerConfig


@router.get("")
@needs(Permission.READ)
async def mast(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the buttons to hold, as large as the screen lets them be."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    frame = tracker_frame(request, tracker_id, N_("Hold to move"))
    return page(request, MastPage(frame=frame, config=tracker.state.config))
