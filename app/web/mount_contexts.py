"""What the template of a tracker's mount is given."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.config import MountConfig
from app.tracker.mounts.capabilities import MountAbilities
from app.tracker.mounts.reach import Reach
from app.web.contexts import Form, Frame
from app.web.ui.drawings import Curve, Tick

Options = tuple[tuple[str, str], ...]
"""Values and texts of a list to choose from."""


@dataclass(frozen=True, slots=True)
class KindChoice:
    """A kind of mount to choose."""

    value: str
    title: str
    summary: str


@dataclass(frozen=True, slots=True)
class YearDiagram:
    """The year's sun, in reach and beyond it, over the part of the sky that the panel can face."""

    reachable: str
    within: tuple[Curve, ...]
    beyond: tuple[Curve, ...]
    title: str


@dataclass(frozen=True, slots=True)
class RowsDrawing:
    """Two rows from the end of their axes, turned back for a low sun; SVG path data and words."""

    panels: str
    facing: str
    ray: str
    ground: str
    words: str


@dataclass(frozen=True, slots=True)
class ActuatorPlot:
    """Stroke and transmission angle over the angle of an axis; SVG path data, grid and words."""

    title: str
    stroke: str
    transmission: str
    angles: tuple[Tick, ...]
    strokes: tuple[Tick, ...]
    transmissions: tuple[Tick, ...]
    words: str


@dataclass(frozen=True, slots=True)
class ActuatorFields:
    """One axis that a linear actuator may turn: the prefix of its fields and its plot, if there is one."""

    prefix: str
    title: str
    plot: ActuatorPlot | None


@dataclass(frozen=True, slots=True)
class MountPage:
    """How the panel hangs on its axes, and what of the year's sun it can face."""

    template: ClassVar[str] = "mount.html"

    frame: Frame
    form: Form
    kinds: tuple[KindChoice, ...]
    mount: MountConfig
    can: MountAbilities
    actuators: tuple[ActuatorFields, ...]
    mechanisms: Options
    rows: RowsDrawing | None
    year: YearDiagram | None
    reach: Reach | None
    done: str
