"""What every template is given: one frozen dataclass each."""

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from app.tracker.memory import StepName
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
