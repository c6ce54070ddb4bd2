"""What the machine and the panel ask of the store, whichever database is behind it."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from datetime import datetime
from typing import Protocol

from app.alarms.alarm import Alarm
from app.audit.entry import Entry, Sealed
from app.base.errors import WRONG, Foreseen
from app.tracker.memory.memory import RejectedSetting, SiteState, TrackerState
from app.tracker.memory.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import Event, EventKind


class StoreFailed(Foreseen):
    """The database could not do it; the text says what to do. Nothing was half written."""


class StoreUnfit(StoreFailed):
    """It is the wrong database for this software: trying again does not help."""

    exit_code = WRONG


class StoreUnreadable(StoreFailed):
    """What is stored does not fit this software: trying again does not help."""


class StoreDamaged(StoreFailed):
    """The database is damaged; the text says where, and that a backup has to be restored."""


@dataclass(frozen=True, slots=True)
class JournalEntry:
    """An event with its place in the journal."""

    number: int
    event: Event


@dataclass(frozen=True, slots=True)
class PlannedShow:
    """A plan and the tracker it was made for."""

    tracker_id: str
    plan: ShowPlan


@dataclass(frozen=True, slots=True)
class JournalFilter:
    """Which entries: newest first, `before` is the cursor (a number), all others narrow.

    `after` is the cursor the other way: with it the oldest entries behind that number, oldest first.
    `actor` is who did it; `text` stands anywhere in the message, in capitals or small letters.
    """

    before: int | None = None
    limit: int = 100
    tracker_id: str | None = None
    kinds: tuple[EventKind, ...] = ()
    start: datetime | None = None
    end: datetime | None = None
    after: int | None = None
    actor: str | None = None
    text: str | None = None


@dataclass(frozen=True, slots=True)
class KeptAlarm:
    """One alarm from its raising to its end (None: it stands), with its place in the history (0: new)."""

    alarm: Alarm
    ended_at: datetime | None
    number: int = 0


@dataclass(frozen=True, slots=True)
class AlarmFilter:
    """Which alarms of the history: the newest first, `before` is the cursor (a number), all others narrow."""

    before: int | None = None
    limit: int = 100
    tracker_id: str | None = None
    priorities: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class AuditFilter:
    """Which entries: newest first, `before` is the cursor (a number), all others narrow.

    `after` is the cursor the other way: with it the oldest entries behind that number, oldest first.
    """

    before: int | None = None
    after: int | None = None
    limit: int = 100
    actor: str | None = None
    object: str | None = None
    start: datetime | None = None
    end: datetime | None = None


@dataclass(frozen=True, slots=True)
class RecordHead:
    """A signed record in a list: its number, whose, when, by whom, and the hash of its document."""

    number: int
    tracker_id: str
    kept_at: datetime
    kept_by: str
    digest: str


@dataclass(frozen=True, slots=True)
class SignedRecord:
    """A signed record: its head and its document, byte for byte what the hash covers."""

    head: RecordHead
    document: str


@dataclass(frozen=True, slots=True)
class Photo:
    """A photo for a record, as JPEG; without a `record_number` it waits for the next one of its tracker.

    `digest` is the SHA-256 of the content, width and height are pixels; number 0: not stored yet.
    """

    tracker_id: str
    added_at: datetime
    added_by: str
    caption: str
    digest: str
    width: int
    height: int
    content: bytes
    number: int = 0
    record_number: int | None = None


@dataclass(frozen=True, slots=True)
class Recorded:
    """What recordings gained: which began, samples by recording, and which ended, when and how."""

    begun: tuple[RecordingInfo, ...] = ()
    samples: Mapping[str, Frames] = field(default_factory=dict)
    ended: tuple[tuple[str, datetime, str], ...] = ()

    @property
    def is_empty(self) -> bool:
        """Return whether nothing is to be kept."""
        return not (self.begun or self.samples or self.ended)


class Reader(Protocol):
    """Reading only; safe from any thread of any process."""

    def site(self) -> SiteState | None:
        """Return the stored site, None before the first save."""

    def trackers(self) -> list[TrackerState]:
        """Return the stored trackers in the order they were added."""

    def journal(self, wanted: JournalFilter) -> list[JournalEntry]:
        """Return entries, newest first; with `after` oldest first."""

    def audit(self, wanted: AuditFilter) -> list[Sealed]:
        """Return audit entries, newest first; with `after` oldest first."""

    def standing_alarms(self) -> list[Alarm]:
        """Return the alarms that stood when they were last stored."""

    def alarm_history(self, wanted: AlarmFilter) -> list[KeptAlarm]:
        """Return alarms, those that stand and those that ended, newest first."""

    def signed_records(
        self, tracker_id: str | None = None, *, limit: int = 200, before: int | None = None
    ) -> list[RecordHead]:
        """Return the heads of signed commissioning records, newest first: those before a number."""

    def signed_record(self, number: int) -> SignedRecord | None:
        """Return one signed record."""

    def waiting_photos(self, tracker_id: str) -> list[Photo]:
        """Return the photos that wait for the next record of a tracker, in the order they were added."""

    def photos_of(self, record_number: int) -> list[Photo]:
        """Return the photos of a signed record, in the order they were added."""

    def photo(self, number: int) -> Photo | None:
        """Return one photo."""

    def show(self, show_id: str) -> PlannedShow | None:
        """Return the plan of a show."""

    def recordings(
        self,
        *,
        kind: RecordingKind | None = None,
        tracker_id: str | None = None,
        limit: int = 200,
        before: tuple[datetime, str] | None = None,
    ) -> list[RecordingInfo]:
        """Return recordings, newest first: those that began before an instant, or at it with a lower id."""

    def recording(self, recording_id: str) -> RecordingInfo | None:
        """Return the head of one recording."""

    def frames(self, recording_id: str, *, begin_s: float = 0.0, end_s: float | None = None) -> Frames:
        """Return the frames whose `elapsed_s` lies in the range; empty if there are none."""


class Writer(Reader, Protocol):
    """The machine's side: the only writer. Every call is one transaction, on disk when it returns."""

    def audited(self, entry: Entry, *, only_changes: bool = False) -> AbstractContextManager[None]:
        """Have what is written inside happen in one transaction, together with the audit entry of it.

        The entry gets the changed values; with `only_changes` it is left out where none changed.
        """

    def software(self) -> str | None:
        """Return the version that wrote this database last, None where none was noted yet."""

    def save_software(self, version: str) -> None:
        """Note which version writes from now on: an older one refuses the database then."""

    def accepted_settings(self, tracker_id: str) -> TrackerConfig | None:
        """Return the settings with which a tracker ran last; None: not known, or they do not fit any more."""

    def newest_entry_at(self) -> datetime | None:
        """Return when the newest entry of the journal was written, None of an empty one."""

    def mended_site(self) -> tuple[SiteState, tuple[RejectedSetting, ...]]:
        """Return the stored site with usual settings where stored ones do not fit, and those."""

    def mended_trackers(self) -> list[TrackerState]:
        """Return the stored trackers with other settings where stored ones do not fit; each tells which."""

    def save_site(self, site: SiteState, events: Sequence[Event] = ()) -> None:
        """Store the site and the events that belong to the change, together."""

    def save_tracker(self, tracker: TrackerState, events: Sequence[Event] = ()) -> None:
        """Store a tracker and the events that belong to the change, together."""

    def remove_tracker(self, tracker_id: str, events: Sequence[Event] = ()) -> None:
        """Forget a tracker; its journal and recordings stay."""

    def save_show(self, planned: PlannedShow) -> None:
        """Keep a plan; the oldest beyond 1,000 are forgotten."""

    def append_events(self, events: Sequence[Event]) -> None:
        """Append to the journal."""

    def save_alarms(self, alarms: Sequence[KeptAlarm], events: Sequence[Event] = ()) -> None:
        """Store alarms and the events that belong to the change, together."""

    def prune_history(self, before: datetime, note: Callable[[int], Event]) -> int:
        """Remove ended alarms and journal entries from before an instant; return how many entries.

        This is the only way by which entries leave the journal; `note` makes the event that says so.
        """

    def sign_record(
        self, head: RecordHead, document: str, photos: Sequence[int], events: Sequence[Event]
    ) -> int:
        """Keep a signed record for good, with photos that waited for it; return the number it gets."""

    def add_photo(self, photo: Photo) -> None:
        """Store a photo that waits for the next record of its tracker."""

    def remove_photo(self, number: int) -> None:
        """Remove a photo that waits; one of a signed record stays."""

    def together(self) -> AbstractContextManager[None]:
        """Have everything that is written inside happen in one transaction: all of it, or nothing."""

    def keep_recorded(self, recorded: Recorded) -> None:
        """Keep what recordings gained, together; samples of one that does not run are left out."""

    def begin_recording(self, info: RecordingInfo) -> None:
        """Open a recording."""

    def append_frames(self, recording_id: str, frames: Frames) -> None:
        """Add frames to an open recording."""

    def finish_recording(self, recording_id: str, ended_at: datetime, outcome: str) -> None:
        """Close a recording."""

    def save_recording(self, info: RecordingInfo, chunks: Sequence[bytes]) -> None:
        """Store a whole finished recording, all or nothing; chunks in the store's own encoding."""

    def delete_recording(self, recording_id: str) -> None:
        """Delete a recording and its frames."""

    def close_open_recordings(self, ended_at: datetime, outcome: str) -> list[RecordingInfo]:
        """Close what a crash left open (ended at its last frame) and return it."""

    def prune(self, *, days_before: datetime, keep: int) -> int:
        """Delete day recordings that began before an instant and all but `keep` others; return how many."""
