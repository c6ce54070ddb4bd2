"""What the pages of the audit and of the certificate show."""

from dataclasses import dataclass
from typing import ClassVar

from app.access.events import Recorded
from app.audit.entry import Sealed
from app.base.network import Network
from app.web.features.security.trust import Trust
from app.web.http.network import Outcome
from app.web.shell.contexts import Form, Frame


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
class AccessRecordPage:
    """What happened at the panel's door, newest first."""

    template: ClassVar[str] = "audit_access.html"

    frame: Frame
    entries: tuple[Recorded, ...]
    older: str | None


@dataclass(frozen=True, slots=True)
class CertificatePage:
    """How a tablet comes to trust this panel."""

    template: ClassVar[str] = "certificate.html"

    frame: Frame
    trust: Trust
    is_loopback: bool


@dataclass(frozen=True, slots=True)
class NetworkPage:
    """Where the panel listens, and the form to change that; with `ways` the change is about to be tried.

    `ticket` is what keeps it, `fixed` what the environment sets, `seconds` how long one has to confirm.
    """

    template: ClassVar[str] = "network.html"

    frame: Frame
    form: Form
    in_force: Network
    here: tuple[str, ...]
    fixed: frozenset[str]
    outcome: Outcome | None
    on_trial: bool
    has_own_certificate: bool
    leaves_https: bool = False
    ways: tuple[str, ...] = ()
    ticket: str = ""
    seconds: int = 0


@dataclass(frozen=True, slots=True)
class NetworkTrialPage:
    """The panel at its new address, to be confirmed; without a ticket there is nothing to confirm."""

    template: ClassVar[str] = "network_trial.html"

    frame: Frame
    in_force: Network
    ticket: str
    seconds: int
    problem: str
    kept: bool
