"""The page from which a tablet gets the authority that it has to trust."""

from starlette.requests import Request
from starlette.responses import Response

from app.web.deps import PanelDep
from app.web.late_routes import page_router
from app.web.security_contexts import CertificatePage
from app.web.trust import trusted
from app.web.ui.frame import site_frame
from app.web.ui.render import page

router = page_router(prefix="/certificate")


@router.get("")
def certificate(request: Request, built: PanelDep) -> Response:
    """Say how this panel is protected on the network and how a tablet comes to trust it."""
    found, settings = trusted(built.settings), built.settings
    context = CertificatePage(
        frame=site_frame(request, "Certificate"), trust=found, is_loopback=settings.is_loopback
    )
    return page(request, context)


@router.get("/ca.crt")
def authority(built: PanelDep) -> Response:
    """Give the authority's certificate as tablets install it."""
    found = trusted(built.settings)
    headers = {"Content-Disposition": 'attachment; filename="heliopanel-ca.crt"'}
    if not found.authority:
        return Response("Heliopanel has no certificate authority of its own.", 404, media_type="text/plain")
    return Response(found.authority, headers=headers, media_type="application/x-x509-ca-cert")
