"""What the template of a tracker's mount is given."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.motion.limit_change import LimitReview
from app.tracker.mounts.capabilities import MountAbilities
from app.tracker.mounts.reach import Reach
from app.tracker.settings.config import MountConfig
from app.web.charts.drawings import ActuatorPlot, RowsDrawing, YearDiagram
from app.web.shell.contexts import Form, Frame

Options = tuple[tuple[str, str], ...]
"""Values and texts of a list to choose from."""


@dataclass(frozen=True, slots=True)
class KindChoice:
    """A kind of mount to choose."""

    value: str
    title: str
    summary: str


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
    review: LimitReview | None = None
