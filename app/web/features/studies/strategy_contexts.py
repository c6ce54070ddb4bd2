"""What the templates of the strategy page are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.show.strategy_told import StrategyDay
from app.web.charts.plot import Plot
from app.web.shell.contexts import Form, Frame

Options = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class StrategyChoice:
    """One strategy to choose: what it is called and what it does, in plain words."""

    kind: str
    label: str
    text: str


@dataclass(frozen=True, slots=True)
class ProgramRow:
    """One row of the program's table as it was typed."""

    at: str = ""
    first: str = ""
    second: str = ""


@dataclass(frozen=True, slots=True)
class ProgramTable:
    """A program as it was typed: its head, its rows, the names of its angles, and what is wrong with it."""

    form: Form
    rows: tuple[ProgramRow, ...]
    angles: tuple[str, str]
    wrong: tuple[str, ...] = ()
    note: str = ""


@dataclass(frozen=True, slots=True)
class StrategyPage:
    """Strategy, step program and hybrid correction of one tracker; `done`: what was just saved."""

    template: ClassVar[str] = "strategy.html"

    frame: Frame
    form: Form
    choices: tuple[StrategyChoice, ...]
    program: ProgramTable
    hybrid: Form
    keeps_program: bool
    aims: Options
    bases: Options
    frames: Options
    examples: Options
    done: str


@dataclass(frozen=True, slots=True)
class StrategyDayPart:
    """Today by one strategy: pictures and what it costs; `played` tells of simulated light sensors."""

    template: ClassVar[str] = "_strategy_day.html"

    label: str
    played: str
    day: StrategyDay
    azimuth: Plot
    elevation: Plot
