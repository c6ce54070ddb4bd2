"""What every template is given: one frozen dataclass each."""

from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

from app.alarms.urgency import IN_DANGER
from app.base.message import Message
from app.base.permission import Permission
from app.sun.algorithms import PUBLISHED
from app.tracker.commands.control import ControlState
from app.tracker.memory.memory import Pointing, Sighting, StepName, TrackerMemory
from app.tracker.memory.recording import RecordingInfo
from app.tracker.motion.limit_change import LimitReview
from app.tracker.mounts.mount import AxisTarget
from app.tracker.settings.config import MountConfig, Orientation, TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCapabilities
from app.tracker.values.operator_message import StateWord
from app.tracker.values.reason import Reason
from app.web.charts.drawings import Scene, SunDiagram
from app.web.shell.control_role import Standing, standing
from app.web.shell.glances import Count, Glance, Urgent
from app.web.shell.who import Who

ALGORITHMS = tuple((algorithm.value, one.expected) for algorithm, one in PUBLISHED.items())
"""What can be chosen as sun algorithm, each with the error to expect."""


class Context(Protocol):
    """A declared context: it names its template."""

    template: ClassVar[str]
    __dataclass_fields__: ClassVar[dict[str, Any]]


@dataclass(frozen=True, slots=True)
class Link:
    """A place to go to, as a key or in the rail, with its symbol there; `current` marks where one is."""

    label: str
    href: str
    current: bool = False
    symbol: str = ""


@dataclass(frozen=True, slots=True)
class Forward:
    """The way forward: a link, the submit key of a form that `needs` a permission, or why neither works."""

    label: str
    href: str | None = None
    form: str | None = None
    needs: Permission = Permission.READ
    reasons: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class StepMark:
    """One step in the step bar; without `href` it cannot be opened yet."""

    number: int
    name: StepName
    label: str
    status: str
    status_text: str
    href: str | None
    current: bool
    reasons: tuple[Reason, ...]


@dataclass(frozen=True, slots=True)
class Frame:
    """What all pages share: who and where we are, the machine now, rail and steps, and the page's actions."""

    title: str
    where: str
    path: str
    theme: str
    zone: str
    site: SiteSnapshot | None
    tracker: Snapshot | None
    tracker_id: str | None
    tabs: tuple[Link, ...]
    steps: tuple[StepMark, ...]
    back: Link | None
    forward: Forward | None
    who: Who = field(default_factory=Who)
    is_bare: bool = False
    theme_choice: str = "day"
    mark: str = ""

    @property
    def name(self) -> str:
        """Return the name in the header: the tracker's, else the site's."""
        if self.tracker is not None:
            return f"{self.tracker.tracker_id} {self.tracker.name}"
        return self.site.site_name if self.site else "Heliopanel"

    @property
    def step(self) -> StepName | None:
        """Return the step of the wizard that this page is."""
        return next((mark.name for mark in self.steps if mark.current), None)

    @property
    def standing(self) -> Standing:
        """Return how who looks stands to control of the tracker."""
        return standing(self.tracker.control if self.tracker else ControlState(0), self.who)

    @property
    def stop_url(self) -> str:
        """Return where STOP goes: this tracker, or all of them."""
        return f"/trackers/{self.tracker_id}/stop" if self.tracker_id else "/stop"


@dataclass(frozen=True, slots=True)
class Outcome:
    """The answer to a key: what was done, or every reason why not."""

    template: ClassVar[str] = "_outcome.html"

    done: str | None
    detail: str
    reasons: tuple[Reason, ...]


@dataclass(frozen=True, slots=True)
class ProblemPage:
    """A page that could not be shown, or a plain form that was refused."""

    template: ClassVar[str] = "problem.html"

    frame: Frame
    title: str
    detail: str
    reasons: tuple[Reason, ...]


@dataclass(frozen=True, slots=True)
class Field:
    """One input: the text that was typed or stored, and what is wrong with it."""

    name: str
    text: str
    error: Message | None = None


Form = dict[str, Field]


@dataclass(frozen=True, slots=True)
class SettingRow:
    """One setting in a form: its field, label, unit, hint, how it is typed, and what it is chosen from."""

    name: str
    label: str
    unit: str
    hint: str
    kind: str = "decimal"
    choices: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class OverviewPage:
    """All trackers of the site, as cards, in rows or as tiles, the most urgent first and above all.

    `counts` tells how many are in each state; with a `state` only those are shown. `chosen_layout` is the
    layout that the address names.
    """

    template: ClassVar[str] = "overview.html"

    frame: Frame
    glances: tuple[Glance, ...]
    counts: tuple[Count, ...]
    urgent: Urgent | None
    state: str
    layout: str
    chosen_layout: str
    form: Form
    longest_name: int
    in_danger: tuple[StateWord, ...] = IN_DANGER


@dataclass(frozen=True, slots=True)
class ProgressPart:
    """The step bar and the key forward, renewed."""

    template: ClassVar[str] = "_progress.html"

    frame: Frame


@dataclass(frozen=True, slots=True)
class HomingPage:
    """Step 3; `doubts` are asked before a home position that may be mistaken, about the readings `asked`."""

    template: ClassVar[str] = "homing.html"

    frame: Frame
    capabilities: DriveCapabilities | None
    config: TrackerConfig
    doubts: tuple[str, ...] = ()
    asked: str = ""


@dataclass(frozen=True, slots=True)
class ModeChoice:
    """One of the four modes, what it does, and which angles it holds."""

    mode: Mode
    label: str
    text: str
    held: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ModePage:
    """Step 4; `saved` is the mode that was saved, `chosen` what the form has."""

    template: ClassVar[str] = "mode.html"

    frame: Frame
    choices: tuple[ModeChoice, ...]
    chosen: Mode
    saved: Mode | None
    orientation: Orientation


@dataclass(frozen=True, slots=True)
class OrientationPage:
    """Step 4, the angles that are held."""

    template: ClassVar[str] = "orientation.html"

    frame: Frame
    form: Form
    held: tuple[str, ...]
    choice: ModeChoice
    limits: str
    scene: Scene


@dataclass(frozen=True, slots=True)
class RunPage:
    """Step 5; `aim` is where the axes would go if tracking began now."""

    template: ClassVar[str] = "run.html"

    frame: Frame
    config: TrackerConfig
    aim: AxisTarget | None
    choice: ModeChoice | None
    scene: Scene


@dataclass(frozen=True, slots=True)
class TrackerPage:
    """One tracker live."""

    template: ClassVar[str] = "tracker.html"

    frame: Frame
    config: TrackerConfig
    memory: TrackerMemory
    choice: ModeChoice | None
    form: Form
    limits: str
    diagram: SunDiagram | None
    scene: Scene
    blocked: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RecordingsPage:
    """What was recorded."""

    template: ClassVar[str] = "recordings.html"

    frame: Frame
    recordings: tuple[RecordingInfo, ...]
    chosen: str


@dataclass(frozen=True, slots=True)
class PlayerPage:
    """One recording, or two laid over each other, to be played."""

    template: ClassVar[str] = "player.html"

    frame: Frame
    info: RecordingInfo
    other: RecordingInfo | None
    others: tuple[RecordingInfo, ...]
    diagram: SunDiagram
    scene: Scene
    speeds: tuple[int, ...]
    speed: int


@dataclass(frozen=True, slots=True)
class SimulatePage:
    """A whole day without a machine."""

    template: ClassVar[str] = "simulate.html"

    frame: Frame
    form: Form
    trackers: tuple[tuple[str, str], ...]
    modes: tuple[tuple[str, str], ...]
    weathers: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class SettingsPage:
    """What an engineer sets for one tracker."""

    template: ClassVar[str] = "settings.html"

    frame: Frame
    form: Form
    mount: MountConfig
    name: SettingRow
    tracking: tuple[SettingRow, ...]
    axes: dict[str, tuple[SettingRow, ...]]
    review: LimitReview | None = None


@dataclass(frozen=True, slots=True)
class ReviewQuestion:
    """What is asked below a button before it changes limits, speeds or aim."""

    template: ClassVar[str] = "_review.html"

    review: LimitReview


@dataclass(frozen=True, slots=True)
class SunCheckPage:
    """Sightings of the sun and what they tell."""

    template: ClassVar[str] = "sun_check.html"

    frame: Frame
    sightings: tuple[Sighting, ...]
    errors: tuple[tuple[float, float], ...]
    causes: tuple[str, ...]
    pointing: Pointing
