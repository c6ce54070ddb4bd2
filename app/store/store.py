"""What the machine and the panel ask of the store, whichever database is behind it."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Protocol

from app.tracker.memory import SiteState, TrackerState
from app.tracker.programs.show import ShowPlan
from app.tracker.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.snapshot import Event, EventKind


class StoreFailed(Exception):
    """The database could not do it; the text says what to do. Nothing was half written."""


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
    """

    before: int | None = None
    limit: int = 100
    tracker_id: str | None = None
    kinds: tuple[EventKind, ...] = ()
    since: datetime | None = None
    until: datetime | None = None
    after: int | None = None


class Reader(Protocol):
    """Reading only; safe from any thread of any process."""

    def site(self) -> SiteState | None:
        """Return the stored site, None before the first save."""

    def trackers(self) -> list[TrackerState]:
        """Return the stored trackers in the order they were added."""

    def journal(self, wanted: JournalFilter) -> list[JournalEntry]:
        """Return entries, newest first; with `after` oldest first."""

    def show(self, show_id: str) -> PlannedShow | None:
        """Return the plan of a show."""

    def recordings(
        self, *, kind: RecordingKind | None = None, tracker_id: str | None = None, limit: int = 200
    ) -> list[RecordingInfo]:
        """Return recordings, newest first."""

    def recording(self, recording_id: str) -> RecordingInfo | None:
        """Return the head of one recording."""

    def frames(self, recording_id: str, *, begin_s: float = 0.0, end_s: float | None = None) -> Frames:
        """Return the frames whose `elapsed_s` lies in the range; empty if there are none."""


class Writer(Reader, Protocol):
    """The machine's side: the only writer. Every call is one transaction, on disk when it returns."""

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
