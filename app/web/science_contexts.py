"""What the templates of the pages about accuracy and about the papers are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.web.contexts import Form, Frame
from app.web.ui.logchart import LogChart


@dataclass(frozen=True, slots=True)
class AccuracyRow:
    """An algorithm in the table of accuracy; angles in degrees."""

    title: str
    source: str
    doi: str
    expected_deg: float
    max_deg: float
    rms_deg: float
    seen_max_deg: float
    unrefracted_deg: float


@dataclass(frozen=True, slots=True)
class AccuracyResult:
    """A survey, ready to be shown."""

    title: str
    rows: tuple[AccuracyRow, ...]
    charts: tuple[LogChart, ...]


@dataclass(frozen=True, slots=True)
class AccuracyPage:
    """The question about accuracy, and the answer once it has been asked; `load` asks for it by itself."""

    template: ClassVar[str] = "accuracy.html"

    frame: Frame
    form: Form
    places: tuple[tuple[str, str], ...]
    result: AccuracyResult | None
    load: str
