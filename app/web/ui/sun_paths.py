"""The sun path of a tracker in both forms: seen from above, and azimuth against elevation."""

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import SiteDetail
from app.web.deps import MachineDep
from app.web.late_routes import page_router
from app.web.picture_contexts import SunPathPage
from app.web.ui.cartesian import cartesian
from app.web.ui.frame import tracker_frame
from app.web.ui.render import page
from app.web.ui.sunpath import diagram
from app.web.ui.wizard import tracker_of
from app.zones import zone_of

router = page_router(prefix="/trackers/{tracker_id}/sun-path")


@router.get("")
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the year's sun over the tracker, with its limits and the horizon."""
    return await run_in_threadpool(_answer, request, tracker_id, await machine.detail())


def _answer(request: Request, tracker_id: str, detail: SiteDetail) -> Response:
    config = tracker_of(detail, tracker_id).state.config
    frame = tracker_frame(request, tracker_id, "Sun path")
    drawn = None
    if frame.site is not None and frame.site.location is not None:
        zone = frame.site.time_zone
        today = frame.site.at.astimezone(zone_of(zone)).date()
        drawn = cartesian(config, frame.site.location, zone, today, detail.site.horizon)
    polar = diagram(frame.site, config, detail.site.horizon)
    context = SunPathPage(frame=frame, config=config, polar=polar, cartesian=drawn)
    return page(request, context)
