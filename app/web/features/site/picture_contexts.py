"""What the templates of sun path, horizon and trends are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.base.message import Message
from app.tracker.settings.config import TrackerConfig
from app.web.charts.drawings import Cartesian, SunDiagram
from app.web.shell.contexts import Form, Frame, Link


@dataclass(frozen=True, slots=True)
class SunPathPage:
    """Both sun paths of a tracker; None while the site has no location."""

    template: ClassVar[str] = "sun_path.html"

    frame: Frame
    config: TrackerConfig
    polar: SunDiagram | None
    cartesian: Cartesian | None


@dataclass(frozen=True, slots=True)
class HorizonPage:
    """The horizon as it is typed, and how it cuts the year's sun; None while the site has no location."""

    template: ClassVar[str] = "horizon.html"

    frame: Frame
    form: Form
    count: int
    cartesian: Cartesian | None
    notes: tuple[Message, ...] = ()


@dataclass(frozen=True, slots=True)
class TrendsPage:
    """Curves of one span; `seconds` is its length."""

    template: ClassVar[str] = "trends.html"

    frame: Frame
    spans: tuple[Link, ...]
    seconds: int
    words: str
