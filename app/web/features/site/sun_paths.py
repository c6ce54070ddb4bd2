"""The sun path of a tracker in both forms: seen from above, and azimuth against elevation."""

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import SiteDetail
from app.web.charts.cartesian import cartesian
from app.web.charts.sunpath import diagram
from app.web.features.site.picture_contexts import SunPathPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep
from app.web.shell.frame import tracker_frame
from app.web.shell.render import page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/sun-path")


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the year's sun over the tracker, with its limits and the horizon."""
    return await run_in_threadpool(_answer, request, tracker_id, await machine.detail())


def _answer(request: Request, tracker_id: str, detail: SiteDetail) -> Response:
    config = tracker_of(detail, tracker_id).state.config
    frame = tracker_frame(request, tracker_id, N_("Sun path"))
    drawn = None
    if frame.site is not None and frame.site.location is not None:
        zone = frame.site.time_zone
        today = day_in(zone, frame.site.at)
        drawn = cartesian(config, frame.site.location, zone, today, detail.site.horizon)
    polar = diagram(frame.site, config, detail.site.horizon)
    context = SunPathPage(frame=frame, config=config, polar=polar, cartesian=drawn)
    return page(request, context)
