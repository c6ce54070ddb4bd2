"""What the templates about the whole site are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.link.metrics import GatewayMetrics
from app.web.contexts import Form, Frame


@dataclass(frozen=True, slots=True)
class SitePage:
    """The site's weather and its other doors; `gateways` None where the machine does not tell."""

    template: ClassVar[str] = "site.html"

    frame: Frame
    gateways: tuple[GatewayMetrics, ...] | None
    form: Form
