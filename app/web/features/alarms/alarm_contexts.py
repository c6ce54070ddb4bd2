"""What the templates about alarms and the journal are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.alarms.catalogue import Entry
from app.store.store import JournalEntry
from app.tracker.state.snapshot import EventKind
from app.tracker.values.alarm_words import AlarmCounts, AlarmNow
from app.web.shell.contexts import Frame, Link


@dataclass(frozen=True, slots=True)
class ShelfForm:
    """What was typed to shelve one alarm, and what is wrong with it."""

    alarm_id: str
    minutes: str
    reason: str
    error: str


@dataclass(frozen=True, slots=True)
class PastAlarm:
    """One alarm of the history; `ended` is false for one that still stands."""

    number: int
    alarm: AlarmNow
    ended: bool


@dataclass(frozen=True, slots=True)
class AlarmsPage:
    """Alarms that stand, that are put aside, or that were; `wrong` is a form to be typed again.

    `collapsed` stand behind the others during a flood; `calling` are the ids that one key acknowledges.
    """

    template: ClassVar[str] = "alarms.html"

    frame: Frame
    view: str
    views: tuple[Link, ...]
    filters: tuple[Link, ...]
    here: str
    listed: tuple[AlarmNow, ...]
    collapsed: tuple[AlarmNow, ...]
    past: tuple[PastAlarm, ...]
    older: str | None
    counts: AlarmCounts
    calling: tuple[str, ...]
    entries: dict[str, Entry]
    wrong: ShelfForm | None = None


@dataclass(frozen=True, slots=True)
class AlarmGuidePage:
    """Every alarm there is."""

    template: ClassVar[str] = "alarm_guide.html"

    frame: Frame
    entries: tuple[Entry, ...]


@dataclass(frozen=True, slots=True)
class JournalQuery:
    """What the journal is narrowed to, as it was typed."""

    tracker: str = ""
    kind: str = ""
    actor: str = ""
    text: str = ""
    start: str = ""
    end: str = ""


@dataclass(frozen=True, slots=True)
class JournalPage:
    """One page of the journal."""

    template: ClassVar[str] = "journal.html"

    frame: Frame
    entries: tuple[JournalEntry, ...]
    trackers: tuple[str, ...]
    kinds: tuple[EventKind, ...]
    query: JournalQuery
    error: str
    csv: str
    json: str
    older: str | None


@dataclass(frozen=True, slots=True)
class NotificationsPage:
    """Where alarms are sent, as it is stored or as it was typed; `error` says what is wrong with that."""

    template: ClassVar[str] = "notifications.html"

    frame: Frame
    webhook_url: str
    webhook_priorities: tuple[int, ...]
    mail_to: str
    mail_priorities: tuple[int, ...]
    error: str
