"""Step 5: start tracking, or show the movement of any day."""

from datetime import datetime

from starlette.requests import Request
from starlette.responses import Response

from app.base.permission import Permission
from app.link.messages import SiteDetail
from app.tracker.memory.memory import StepName
from app.tracker.motion.target_change import axis_target
from app.tracker.mounts.mount import AxisTarget
from app.tracker.state.snapshot import Snapshot
from app.web.features.control.mode import choice
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import RunPage
from app.web.shell.deps import Panel, PanelDep
from app.web.shell.render import page
from app.web.shell.scene import scene_now
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/run")


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, built: PanelDep) -> Response:
    """Show where the tracker is and would go, and the two ways to begin."""
    return await _answer(request, tracker_id, built)


@router.get("/aim")
@needs(Permission.READ)
async def aim(request: Request, tracker_id: str, built: PanelDep) -> Response:
    """Return anew where the axes would go."""
    return await _answer(request, tracker_id, built, block="aim")


async def _answer(request: Request, tracker_id: str, built: Panel, block: str | None = None) -> Response:
    detail = await built.machine.detail()
    tracker = tracker_of(detail, tracker_id)
    config, mode = tracker.state.config, tracker.state.memory.mode
    frame = wizard_frame(request, tracker, StepName.RUN)
    context = RunPage(
        frame=frame,
        config=config,
        choice=choice(config, mode) if mode else None,
        scene=scene_now(frame.site, config, detail.site.horizon),
        aim=_aim(detail, tracker_id, frame.tracker, built.site_now()),
    )
    return page(request, context, block=block)


def _aim(detail: SiteDetail, tracker_id: str, now: Snapshot | None, at: datetime) -> AxisTarget | None:
    """Return where the axes would go if tracking began now; None with no sun, or where that is not known."""
    state, location = detail.trackers[tracker_id].state, detail.site.location
    stands = None if now is None or now.azimuth is None else now.azimuth.position_deg
    if location is None or state.memory.mode is None or stands is None:
        return None
    return axis_target(state, location, at, stands)
