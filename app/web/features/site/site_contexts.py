"""What the templates about the whole site are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.link.metrics import GatewayMetrics
from app.tracker.memory.memory import ClockSetting
from app.web.shell.contexts import Form, Frame

CONFIRMED = "yes"
"""What a form holds whose question was answered."""


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


@dataclass(frozen=True, slots=True)
class ClockQuestion:
    """The question before a clock is used that differs from this device's, or that `moves` the site's.

    `answer` is what confirms exactly the differences that it names.
    """

    answer: str
    doubt: str
    moves: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ClockPage:
    """Step 2. `source` is what is chosen, `at` what the device's clock showed when it was sent."""

    template: ClassVar[str] = "clock.html"

    frame: Frame
    setting: ClockSetting
    source: str
    at: str
    question: ClockQuestion | None
    is_saved: bool


@dataclass(frozen=True, slots=True)
class ShadowPage:
    """The shadow test of step 2, and the form for a typed clock."""

    template: ClassVar[str] = "clock_shadow.html"

    frame: Frame
    form: Form
    zones: tuple[str, ...]
    doubt: str = ""
    moves: tuple[str, ...] = ()
    asked_for: str = ""
    asked_at: str = ""
    answer: str = CONFIRMED
