"""What the templates about the whole site are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.link.metrics import GatewayMetrics
from app.web.shell.contexts import Form, Frame


@dataclass(frozen=True, slots=True)
class SitePage:
    """The site's weather, where it comes from, and its other doors; `gateways` None where it does not tell.

    `is_known` says that the machine told its settings; `real_trackers` are those that forbid made-up weather;
    `held` has the trackers that each gateway has control of.
    """

    template: ClassVar[str] = "site.html"

    frame: Frame
    gateways: tuple[GatewayMetrics, ...] | None
    is_known: bool
    form: Form
    simulation: Form
    scenarios: tuple[tuple[str, str], ...]
    is_simulated: bool
    real_trackers: tuple[str, ...]
    windows: Form
    window_hints: dict[str, str]
    held: dict[str, tuple[str, ...]]
