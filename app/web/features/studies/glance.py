"""A site at a glance: what each mode collects in a year, what each deadband costs in motion and error."""

from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.web.features.studies.study_contexts import GlancePage
from app.web.features.studies.study_orders import glance_question
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import MachineDep, PanelDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/studies/glance")


@router.get("")
@needs(Permission.READ)
async def glance(
    request: Request, machine: MachineDep, built: PanelDep, *, ready: Annotated[bool, Query()] = False
) -> Response:
    """Show the page at once, and what it compares as soon as that is worked out."""
    detail = await machine.detail()
    year = built.site_now().year
    question = None if detail.site.location is None else glance_question(detail, detail.site.location, year)
    context = GlancePage(
        frame=site_frame(request, N_("At a glance"), back=Link(N_("Studies"), "/studies")),
        located=question is not None,
        comparison=await built.studies.compare(question) if ready and question else None,
    )
    return page(request, context, block="body")
