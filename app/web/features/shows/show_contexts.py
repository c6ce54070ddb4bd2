"""What the pages of a show are rendered from."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.programs.show import ShowPlan
from app.tracker.values.reason import Reason
from app.web.charts.drawings import DayChart, Scene, SunDiagram
from app.web.shell.contexts import Form, Frame, Link


@dataclass(frozen=True, slots=True)
class Preset:
    """A day that one key chooses; `what` says what is special about it."""

    label: str
    what: str
    href: str
    current: bool


@dataclass(frozen=True, slots=True)
class Verdict:
    """What the check of a show's plan says, in the words of the page.

    `longer` says why the page proposes more minutes than usual, `instead` what works where this does not.
    """

    feasible: bool
    headline: str
    facts: tuple[tuple[str, str], ...]
    reasons: tuple[Reason, ...]
    longer: Reason | None
    notices: tuple[Reason, ...]
    instead: Link | None
    chart: DayChart | None


@dataclass(frozen=True, slots=True)
class ShowPlanPage:
    """A show is planned."""

    template: ClassVar[str] = "show.html"

    frame: Frame
    form: Form
    presets: tuple[Preset, ...]
    verdict: Verdict | None


@dataclass(frozen=True, slots=True)
class ShowRunPage:
    """A show on the machine."""

    template: ClassVar[str] = "show_run.html"

    frame: Frame
    plan: ShowPlan
    minutes: str
    again: str
    diagram: SunDiagram
    scene: Scene
