"""What the templates of the pages about accuracy and about the papers are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.research.result import Erratum, Gap
from app.web.charts.logchart import LogChart
from app.web.shell.contexts import Form, Frame


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
    """A survey, ready to be shown; `query` asks the API for the same."""

    title: str
    query: str
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


@dataclass(frozen=True, slots=True)
class FigureRow:
    """A figure of a paper as text; `published` and `difference` are empty where nothing is published."""

    name: str
    unit: str
    published: str
    ours: str
    difference: str
    standing: str


@dataclass(frozen=True, slots=True)
class GroupTable:
    """A table of a paper; a long one is folded, and one with nothing published has one column of numbers."""

    title: str
    note: str
    folded: bool
    figures: tuple[FigureRow, ...]
    remarks: tuple[str, ...]
    compared: bool


@dataclass(frozen=True, slots=True)
class PaperSection:
    """One paper on its page."""

    key: str
    name: str
    citation: str
    summary: str
    groups: tuple[GroupTable, ...]
    errata: tuple[Erratum, ...]
    gaps: tuple[Gap, ...]


@dataclass(frozen=True, slots=True)
class PapersPage:
    """The five papers; with `load` the page asks for them by itself."""

    template: ClassVar[str] = "papers.html"

    frame: Frame
    papers: tuple[PaperSection, ...]
    load: bool
