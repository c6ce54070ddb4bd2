"""What every template is given: one frozen dataclass each."""

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from app.tracker.config import TrackerConfig
from app.tracker.memory import ClockSetting, HomeTrust, StepName, TrackerMemory
from app.tracker.mode import Mode
from app.tracker.motion import DriveCapabilities
from app.tracker.reason import Reason
from app.tracker.snapshot import SiteSnapshot, Snapshot


class Context(Protocol):
    """A declared context: it names its template."""

    template: ClassVar[str]
    __dataclass_fields__: ClassVar[dict[str, Any]]


@dataclass(frozen=True, slots=True)
class Link:
    """A place to go to, as a key or a tab; `current` marks where one is."""

    label: str
    href: str
    current: bool = False


@dataclass(frozen=True, slots=True)
class Forward:
    """The key at the lower right: a link, the submit key of a form, or why neither works yet."""

    label: str
    href: str | None = None
    form: str | None = None
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
    """What all pages share: who and where we are, the machine now, tabs or steps, and the footer's keys."""

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
    error: str | None = None


Form = dict[str, Field]


@dataclass(frozen=True, slots=True)
class OverviewPage:
    """All trackers of the site."""

    template: ClassVar[str] = "overview.html"

    frame: Frame
    trackers: tuple[Snapshot, ...]
    form: Form
    progress: dict[str, tuple[int, str]]


@dataclass(frozen=True, slots=True)
class ProgressPart:
    """The step bar and the key forward, renewed."""

    template: ClassVar[str] = "_progress.html"

    frame: Frame


@dataclass(frozen=True, slots=True)
class LocationPreview:
    """What a location means: its point on the map and today's sun, all texts in local time."""

    x: float
    y: float
    normal: str
    half: str
    zone: str
    date: str
    rise: str
    transit: str
    set: str
    noon_elevation: str
    polar: str


@dataclass(frozen=True, slots=True)
class LocationPage:
    """Step 1."""

    template: ClassVar[str] = "location.html"

    frame: Frame
    form: Form
    preview: LocationPreview | None
    zones: tuple[str, ...]
    by_place: str
    revision: int


@dataclass(frozen=True, slots=True)
class ClockPage:
    """Step 2."""

    template: ClassVar[str] = "clock.html"

    frame: Frame
    form: Form
    zones: tuple[str, ...]
    setting: ClockSetting


@dataclass(frozen=True, slots=True)
class HomingPage:
    """Step 3."""

    template: ClassVar[str] = "homing.html"

    frame: Frame
    capabilities: DriveCapabilities | None
    home: HomeTrust | None
    config: TrackerConfig


@dataclass(frozen=True, slots=True)
class ModeChoice:
    """One of the four modes and what it does."""

    mode: Mode
    label: str
    text: str


@dataclass(frozen=True, slots=True)
class ModePage:
    """Step 4."""

    template: ClassVar[str] = "mode.html"

    frame: Frame
    choices: tuple[ModeChoice, ...]
    chosen: Mode | None


@dataclass(frozen=True, slots=True)
class OrientationPage:
    """Step 4, the angles that are held."""

    template: ClassVar[str] = "orientation.html"

    frame: Frame
    form: Form
    held: tuple[str, ...]
    choice: ModeChoice
    limits: str


@dataclass(frozen=True, slots=True)
class RunPage:
    """Step 5."""

    template: ClassVar[str] = "run.html"

    frame: Frame
    choice: ModeChoice | None


@dataclass(frozen=True, slots=True)
class Curve:
    """A curve of the sun-path diagram: SVG path data, and whether it is a solstice or an equinox."""

    label: str
    path: str
    strong: bool


@dataclass(frozen=True, slots=True)
class HourLabel:
    """The number of an hour at its place in the diagram."""

    x: float
    y: float
    text: str


@dataclass(frozen=True, slots=True)
class SunDiagram:
    """The polar sun path, north up, on a circle of radius 100 about the origin."""

    months: tuple[Curve, ...]
    hours: tuple[Curve, ...]
    labels: tuple[HourLabel, ...]
    today: Curve
    reachable: str
    title: str


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
    drive: str
    diagram: SunDiagram | None
