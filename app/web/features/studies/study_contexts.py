"""What the templates of the pages about energy studies and step programs are given."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from app.fast.comparison import Comparison
from app.studies.folder import StudyState, WeatherFile
from app.studies.jobs import ProgramAnswer
from app.studies.request import StudyRequest
from app.studies.result import CaseResult, StudyResult
from app.web.charts.heatmap import HeatMap
from app.web.charts.plot import Plot
from app.web.shell.contexts import Form, Frame, Link

Options = tuple[tuple[str, str], ...]
"""Values of a choice and what people read."""


@dataclass(frozen=True, slots=True)
class Choice:
    """One box that can be ticked."""

    value: str
    label: str
    chosen: bool


@dataclass(frozen=True, slots=True)
class StudyOptions:
    """What the form of a study offers."""

    spans: Options
    lights: Options
    transpositions: Options
    fidelities: Options
    trackers: Options
    modes: tuple[Choice, ...]
    strategies: tuple[Choice, ...]


@dataclass(frozen=True, slots=True)
class StudiesPage:
    """The form of a new study, the studies so far, and the weather files."""

    template: ClassVar[str] = "studies.html"

    frame: Frame
    form: Form
    hints: Mapping[str, str]
    options: StudyOptions
    studies: tuple[StudyState, ...]
    files: tuple[WeatherFile, ...]
    any_open: bool


@dataclass(frozen=True, slots=True)
class GlancePage:
    """A site at a glance; without a comparison it is being worked out, or the site has no location."""

    template: ClassVar[str] = "glance.html"

    frame: Frame
    located: bool
    comparison: Comparison | None


@dataclass(frozen=True, slots=True)
class StudyView:
    """The pictures of a result: what is shown of which case and day."""

    chosen: int
    case: CaseResult
    days: tuple[Link, ...]
    curves: Plot
    panel: Plot
    months: Plot | None
    heads: tuple[str, ...]
    gains: tuple[tuple[str, tuple[str, ...]], ...]
    heat: HeatMap | None


@dataclass(frozen=True, slots=True)
class StudyPage:
    """One study: how far it is, and once it is done what was found."""

    template: ClassVar[str] = "study.html"

    frame: Frame
    state: StudyState
    asked: StudyRequest
    settings: tuple[tuple[str, str], ...]
    result: StudyResult | None
    view: StudyView | None


@dataclass(frozen=True, slots=True)
class ProgramView:
    """The answer about step programs, with the pictures of the chosen one."""

    answer: ProgramAnswer
    chosen: int
    energy: Plot
    day: Plot
    times: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True, slots=True)
class StepProgramPage:
    """The question about step programs, and the answer once it has been asked."""

    template: ClassVar[str] = "step_program.html"

    frame: Frame
    form: Form
    lights: Options
    windows: Options
    trackers: Options
    query: str
    view: ProgramView | None
    load: str
