"""What the page of the audit shows."""

from dataclasses import dataclass
from typing import ClassVar

from app.audit.entry import Sealed
from app.web.contexts import Frame


@dataclass(frozen=True, slots=True)
class AuditPage:
    """Who ordered what, newest first."""

    template: ClassVar[str] = "audit.html"

    frame: Frame
    entries: tuple[Sealed, ...]
    head: Sealed | None
    actor: str
    older: str | None
