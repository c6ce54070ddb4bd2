"""A site at a glance: what each mode collects in a year, what each deadband costs in motion and error."""

from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.web.contexts import Link
from app.web.deps import MachineDep, PanelDep
from app.web.late_routes import page_router
from app.web.study_contexts import GlancePage
from app.web.study_orders import glance_question
from app.web.ui.frame import site_frame
from app.web.ui.render import page

router = page_router(prefix="/studies/glance")


@router.get("")
async def glance(
    request: Request, machine: MachineDep, built: PanelDep, *, ready: Annotated[bool, Query()] = False
) -> Response:
    """Show the page at once, and what it compares as soon as that is worked out."""
    detail = await machine.detail()
    latest = machine.latest()
    year = (latest.at if latest else built.clock.now()).year
    question = None if detail.site.location is None else glance_question(detail, detail.site.location, year)
    context = GlancePage(
        frame=site_frame(request, "At a glance", back=Link("Studies", "/studies")),
        located=question is not None,
        comparison=await built.studies.compare(question) if ready and question else None,
    )
    return page(request, context, block="body")
