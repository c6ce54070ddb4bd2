"""What the panel tells of its certificate, and the authority to install on a tablet."""

from dataclasses import dataclass
from datetime import datetime

from app.base.settings import Settings
from app.base.startup import late


@dataclass(frozen=True, slots=True)
class Trust:
    """The panel's certificate, and its authority as PEM with its fingerprint; empty where there is none."""

    names: tuple[str, ...] = ()
    not_after: datetime | None = None
    authority: str = ""
    fingerprint: str = ""


def trusted(settings: Settings) -> Trust:
    """Return what these settings serve; an authority only where the panel made its certificate itself."""
    if settings.certificate is None:
        return Trust()
    certificates = late("app.base.certificates")
    served = certificates.read(settings.certificate[0])
    authority = settings.tls_dir / certificates.AUTHORITY
    if settings.tls_cert_file is not None or not authority.is_file():
        return Trust(served.names, served.not_after)
    fingerprint = certificates.read(authority).fingerprint
    return Trust(served.names, served.not_after, authority.read_text("ascii"), fingerprint)
