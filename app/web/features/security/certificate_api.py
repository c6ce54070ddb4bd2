"""The panel's certificate, and the authority that tablets have to trust."""

from datetime import datetime

from pydantic import Field

from app.base.permission import Permission
from app.web.api.base import Output, api_router
from app.web.features.security.trust import trusted
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep

router = api_router(tags=["site"])


class Certificate(Output):
    """What a tablet needs to trust this panel."""

    names: tuple[str, ...] = Field(description="Names and addresses that the panel's certificate is for.")
    not_after: datetime | None = Field(description="Until when it is valid; None without a certificate.")
    authority: str = Field(description="The authority's certificate, PEM; empty without one of one's own.")
    authority_fingerprint: str = Field(description="Its SHA-256 fingerprint.")


@router.get("/certificate", summary="The panel's certificate and its authority")
@needs(Permission.OPEN)
def read_certificate(built: PanelDep) -> Certificate:
    """Return what a tablet needs to trust this panel; nothing in it is secret."""
    found = trusted(built.settings)
    return Certificate(
        names=found.names,
        not_after=found.not_after,
        authority=found.authority,
        authority_fingerprint=found.fingerprint,
    )
