"""The site: its weather, and how the machine's other doors are doing."""

from fastapi import APIRouter
from starlette.requests import Request
from starlette.responses import Response

from app.web.deps import MachineDep
from app.web.metrics import counted
from app.web.site_contexts import SitePage
from app.web.ui.frame import site_frame
from app.web.ui.render import page

router = APIRouter(prefix="/site")


@router.get("")
async def site(request: Request, machine: MachineDep) -> Response:
    """Show the newest weather and the state of every gateway."""
    metrics = await counted(machine)
    context = SitePage(
        frame=site_frame(request, "Site"), gateways=None if metrics is None else metrics.gateways
    )
    return page(request, context, block="gateways")
