"""Step 5: start tracking, or show the movement of any day."""

from starlette.requests import Request
from starlette.responses import Response

from app.base.permission import Permission
from app.tracker.memory.memory import StepName
from app.web.features.control.mode import choice
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import RunPage
from app.web.shell.deps import MachineDep
from app.web.shell.render import page
from app.web.shell.scene import scene_now
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/run")


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show what is done and what is missing, and the two ways to begin."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    mode = tracker.state.memory.mode
    frame = wizard_frame(request, tracker, StepName.RUN)
    context = RunPage(
        frame=frame,
        choice=choice(tracker.state.config, mode) if mode else None,
        scene=scene_now(frame.site, tracker.state.config, detail.site.horizon),
    )
    return page(request, context)
