"""What the pages of the audit and of the certificate show."""

from dataclasses import dataclass
from typing import ClassVar

from app.audit.entry import Sealed
from app.web.contexts import Frame
from app.web.trust import Trust


@dataclass(frozen=True, slots=True)
class AuditPage:
    """Who ordered what, newest first."""

    template: ClassVar[str] = "audit.html"

    frame: Frame
    entries: tuple[Sealed, ...]
    head: Sealed | None
    actor: str
    older: str | None


@dataclass(frozen=True, slots=True)
class CertificatePage:
    """How a tablet comes to trust this panel."""

    template: ClassVar[str] = "certificate.html"

    frame: Frame
    trust: Trust
    is_loopback: bool
