"""The page from which a tablet gets the authority that it has to trust."""

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.web.features.security.security_contexts import CertificatePage
from app.web.features.security.trust import trusted
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/certificate")


@router.get("")
@needs(Permission.OPEN)
def certificate(request: Request, built: PanelDep) -> Response:
    """Say how this panel is protected on the network and how a tablet comes to trust it."""
    found, settings = trusted(built.settings), built.settings
    context = CertificatePage(
        frame=site_frame(request, N_("Certificate")), trust=found, is_loopback=settings.is_loopback
    )
    return page(request, context)


@router.get("/ca.crt")
@needs(Permission.OPEN)
def authority(built: PanelDep) -> Response:
    """Give the authority's certificate as tablets install it."""
    found = trusted(built.settings)
    headers = {"Content-Disposition": 'attachment; filename="heliopanel-ca.crt"'}
    if not found.authority:
        return Response(
            N_("Heliopanel has no certificate authority of its own."), 404, media_type="text/plain"
        )
    return Response(found.authority, headers=headers, media_type="application/x-x509-ca-cert")
