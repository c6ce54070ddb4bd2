"""What the page of components is given."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.values.reason import Reason
from app.web.shell.contexts import Form, Frame

COLOURS = (
    "ground", "panel", "sunken", "text", "second", "line", "hair", "key", "key-border", "blue", "blue-wash",
    "ok", "stop", "p1", "p2", "p3", "p4",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class ComponentsPage:
    """Example values for every component, once for each theme."""

    template: ClassVar[str] = "components.html"

    frame: Frame
    themes: tuple[str, ...]
    form: Form
    reasons: tuple[Reason, ...]
    colours: tuple[str, ...] = COLOURS
