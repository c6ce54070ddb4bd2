"""A store that lives in memory."""

from datetime import datetime

from app.alarms.alarm import Alarm
from app.audit.chain import FIRST
from app.audit.entry import Entry, Sealed, seal
from app.store.store import (
    AlarmFilter,
    AuditFilter,
    JournalEntry,
    JournalFilter,
    KeptAlarm,
    Photo,
    PlannedShow,
    RecordHead,
    SignedRecord,
)
from app.tracker.memory.memory import (
    SiteState,
    TrackerState,
)
from app.tracker.memory.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.state.snapshot import (
    Event,
    EventKind,
)
from tests.fake_data import commissioned, frames, recording, site_state


class FakeReader:
    """A store in memory: one show, one simulated day, a short journal."""

    def __init__(self) -> None:
        heads = (
            recording("show-1", RecordingKind.SHOW, "Summer solstice in 3 minutes", 15.0, 180.0),
            recording("day-1", RecordingKind.SIMULATION, "A simulated day", 24.0, 86400.0),
        )
        self.heads = {head.recording_id: head for head in heads}
        self.sealed = [
            seal(
                Entry(
                    heads[0].began_at,
                    1000,
                    "fake-boot",
                    "trusted",
                    "ada",
                    "session",
                    "127.0.0.1",
                    "stop",
                    "T1",
                    "{}",
                ),
                1,
                FIRST,
            )
        ]
        self.shows: dict[str, PlannedShow] = {}
        self.signed: list[SignedRecord] = []
        self.photos: list[Photo] = []
        self.entries = [
            JournalEntry(
                number, Event(head.began_at, EventKind.SHOW_STARTED, "T1", f"{head.title} began.", "operator")
            )
            for number, head in enumerate(heads, start=1)
        ]

    def site(self) -> SiteState | None:
        """Return the stored site."""
        return site_state()

    def trackers(self) -> list[TrackerState]:
        """Return the stored trackers."""
        return [
            commissioned("T1", "North field", tracking=False),
            commissioned("T2", "South field", tracking=True),
        ]

    def journal(self, wanted: JournalFilter) -> list[JournalEntry]:
        """Return entries, newest first."""
        found = [entry for entry in reversed(self.entries) if _matches(entry, wanted)]
        return found[: wanted.limit]

    def audit(self, wanted: AuditFilter) -> list[Sealed]:
        """Return audit entries, newest first; with `after` oldest first."""
        found = [one for one in self.sealed if wanted.after is None or one.seq > wanted.after]
        ordered = found if wanted.after is not None else [*reversed(found)]
        kept = [one for one in ordered if wanted.before is None or one.seq < wanted.before]
        return kept[: wanted.limit]

    def standing_alarms(self) -> list[Alarm]:
        """Return that no alarm stands."""
        return []

    def alarm_history(self, wanted: AlarmFilter) -> list[KeptAlarm]:
        """Return that there never was an alarm."""
        return []

    def signed_records(
        self, tracker_id: str | None = None, *, limit: int = 200, before: int | None = None
    ) -> list[RecordHead]:
        """Return the heads of signed records, newest first."""
        heads = [one.head for one in reversed(self.signed) if tracker_id in (None, one.head.tracker_id)]
        return [one for one in heads if before is None or one.number < before][:limit]

    def signed_record(self, number: int) -> SignedRecord | None:
        """Return one signed record."""
        return next((one for one in self.signed if one.head.number == number), None)

    def waiting_photos(self, tracker_id: str) -> list[Photo]:
        """Return the photos that wait."""
        return [one for one in self.photos if one.tracker_id == tracker_id and one.record_number is None]

    def photos_of(self, record_number: int) -> list[Photo]:
        """Return the photos of a record."""
        return [one for one in self.photos if one.record_number == record_number]

    def photo(self, number: int) -> Photo | None:
        """Return one photo."""
        return next((one for one in self.photos if one.number == number), None)

    def show(self, show_id: str) -> PlannedShow | None:
        """Return the plan of a show."""
        return self.shows.get(show_id)

    def recordings(
        self,
        *,
        kind: RecordingKind | None = None,
        tracker_id: str | None = None,
        limit: int = 200,
        before: tuple[datetime, str] | None = None,
    ) -> list[RecordingInfo]:
        """Return recordings that match."""
        found = [
            head for head in self.heads.values()
            if kind in (None, head.kind) and tracker_id in (None, head.tracker_id)
            and (before is None or (head.began_at, head.recording_id) < before)
        ]  # fmt: skip
        return found[:limit]

    def recording(self, recording_id: str) -> RecordingInfo | None:
        """Return one head."""
        return self.heads.get(recording_id)

    def frames(self, recording_id: str, *, begin_s: float = 0.0, end_s: float | None = None) -> Frames:
        """Return the frames in a range."""
        values = frames(self.heads[recording_id]).values
        elapsed = values[:, 0]
        return Frames(
            values[(elapsed >= begin_s) & (elapsed <= (end_s if end_s is not None else elapsed.max()))]
        )


def _matches(entry: JournalEntry, wanted: JournalFilter) -> bool:
    return (
        (wanted.before is None or entry.number < wanted.before)
        and wanted.tracker_id in (None, entry.event.tracker_id)
        and (not wanted.kinds or entry.event.kind in wanted.kinds)
        and wanted.actor in (None, entry.event.actor)
        and (wanted.text or "").lower() in entry.event.message.lower()
        and (wanted.start is None or entry.event.at >= wanted.start)
        and (wanted.end is None or entry.event.at <= wanted.end)
    )
