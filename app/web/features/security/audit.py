"""The audit: who ordered what, newest first, for administrators."""

from urllib.parse import urlencode

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.store.store import AuditFilter
from app.web.features.security.security_contexts import AccessRecordPage, AuditPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep, ReaderDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/audit")
A_PAGE = 60


@router.get("/access")
@needs(Permission.ADMINISTER)
async def access(request: Request, built: PanelDep, before: int | None = None) -> Response:
    """Show one page of what happened at the panel's door."""
    cursor = before if before is not None and 0 < before < 2**63 else None
    found = await built.keeper.events(cursor, A_PAGE)
    context = AccessRecordPage(
        frame=site_frame(request, N_("Audit")),
        entries=tuple(found),
        older=f"/audit/access?before={found[-1].number}" if len(found) == A_PAGE else None,
    )
    return page(request, context)


@router.get("")
@needs(Permission.ADMINISTER)
def audit(request: Request, reader: ReaderDep, actor: str = "", before: int | None = None) -> Response:
    """Show one page of the audit; `before` is the number of the oldest entry of the page before."""
    cursor = before if before is not None and 0 < before < 2**63 else None
    found = reader.audit(AuditFilter(before=cursor, limit=A_PAGE, actor=actor[:64] or None))
    older = {"before": str(found[-1].seq)} | ({"actor": actor} if actor else {}) if found else {}
    context = AuditPage(
        frame=site_frame(request, N_("Audit")),
        entries=tuple(found),
        head=next(iter(reader.audit(AuditFilter(limit=1))), None),
        actor=actor,
        older=f"/audit?{urlencode(older)}" if len(found) == A_PAGE else None,
    )
    return page(request, context)
