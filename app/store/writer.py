"""Writing: the machine's side. Every call is one transaction that is on disk when the call returns."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime

from sqlalchemy import ColumnElement, Connection, Engine, Table, delete, select
from sqlalchemy.exc import SQLAlchemyError

from app.audit.entry import Entry
from app.base.message import say, told_by
from app.store import alarming, auditing, recording, signed_records, tables
from app.store.chunks import ChunkDamaged
from app.store.connections import require_revision
from app.store.documents import CONFIG, EVENT_DATA, PLAN, SITE, TRACKER, or_none, plain
from app.store.event_message import with_message
from app.store.failures import explained, is_lasting
from app.store.putting import adding, put
from app.store.reader import DatabaseReader, head
from app.store.software import note_version, version_of
from app.store.store import KeptAlarm, Photo, PlannedShow, Recorded, RecordHead, StoreFailed
from app.tracker.memory.memory import SiteState, TrackerState
from app.tracker.memory.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.state.snapshot import Event

SITE_NUMBER = 1
SHOWS_KEPT = 1000


class DatabaseWriter(DatabaseReader):
    """The only writer of a database. After a disk failure it refuses to write until it is opened again."""

    def __init__(self, reading: Engine, writing: Engine) -> None:
        super().__init__(reading)
        self._writing = writing
        self._broken: StoreFailed | None = None
        self._open: Connection | None = None
        self._auditing: auditing.Change | None = None
        try:
            with self._write() as connection:
                require_revision(connection)
        except StoreFailed:
            self.close()
            raise

    @contextmanager
    def audited(self, entry: Entry, *, only_changes: bool = False) -> Iterator[None]:
        """Have what is written inside happen in one transaction, together with the audit entry of it.

        The entry gets the changed values; with `only_changes` it is left out where none changed.
        """
        with self.together():
            change = self._auditing = auditing.Change(entry, only_changes)
            try:
                yield
                finished = change.finished()
            finally:
                self._auditing = None
            if finished is not None:
                with self._write() as connection:
                    auditing.append(connection, finished)

    @contextmanager
    def together(self) -> Iterator[None]:
        """Have everything that is written inside happen in one transaction: all of it, or nothing."""
        outer = self._open
        with self._write() as connection:
            self._open = connection
            try:
                yield
            finally:
                self._open = outer

    @contextmanager
    def _write(self) -> Iterator[Connection]:
        if self._open is not None:
            yield self._open
            return
        if self._broken is not None:
            raise StoreFailed(str(self._broken))
        try:
            with self._writing.begin() as connection:
                yield connection
        except SQLAlchemyError as error:
            failure = explained(error)
            if is_lasting(error):
                self._broken = failure
            raise failure from error

    def software(self) -> str | None:
        """Return the version that wrote this database last, None where none was noted yet."""
        with self._read() as connection:
            return version_of(connection)

    def save_software(self, version: str) -> None:
        """Note which version writes from now on."""
        with self._write() as connection:
            note_version(connection, version)

    def save_site(self, site: SiteState, events: Sequence[Event] = ()) -> None:
        """Store the site and the events that belong to the change, together."""
        with self._write() as connection:
            document = SITE.write(site)
            self._note(connection, tables.site, tables.site.c.number == SITE_NUMBER, document)
            put(connection, tables.site, {"number": SITE_NUMBER}, {"document": document})
            _append(connection, events)

    def save_tracker(self, tracker: TrackerState, events: Sequence[Event] = ()) -> None:
        """Store a tracker and the events that belong to the change, together.

        While its settings are the stored ones or were saved since, they are the last that were accepted.
        """
        key = {"tracker_id": tracker.config.tracker_id}
        mine = tables.trackers.c.tracker_id == key["tracker_id"]
        with self._write() as connection:
            document = TRACKER.write(tracker)
            self._note(connection, tables.trackers, mine, document)
            accepted = {} if tracker.memory.rejected else {"accepted": CONFIG.write(tracker.config)}
            put(connection, tables.trackers, key, {"document": document, **accepted})
            _append(connection, events)

    def remove_tracker(self, tracker_id: str, events: Sequence[Event] = ()) -> None:
        """Forget a tracker; its journal and recordings stay."""
        mine = tables.trackers.c.tracker_id == tracker_id
        with self._write() as connection:
            self._note(connection, tables.trackers, mine, None)
            connection.execute(delete(tables.trackers).where(mine))
            _append(connection, events)

    def save_show(self, planned: PlannedShow) -> None:
        """Keep a plan; the oldest beyond 1,000 are forgotten."""
        columns = tables.shows.c
        values = {"tracker_id": planned.tracker_id, "document": PLAN.write(planned.plan)}
        oldest_kept = select(columns.number).order_by(columns.number.desc()).offset(SHOWS_KEPT - 1).limit(1)
        with self._write() as connection:
            put(connection, tables.shows, {"show_id": planned.plan.show_id}, values)
            connection.execute(delete(tables.shows).where(columns.number < oldest_kept.scalar_subquery()))

    def append_events(self, events: Sequence[Event]) -> None:
        """Append to the journal."""
        with self._write() as connection:
            _append(connection, events)

    def save_alarms(self, alarms: Sequence[KeptAlarm], events: Sequence[Event] = ()) -> None:
        """Store alarms and the events that belong to the change, together."""
        with self._write() as connection:
            for one in alarms:
                alarming.put(connection, one)
            _append(connection, events)

    def prune_history(self, before: datetime, note: Callable[[int], Event]) -> int:
        """Remove ended alarms and journal entries from before an instant; return how many entries."""
        with self._write() as connection:
            removed = alarming.prune(connection, before)
            if removed:
                _append(connection, (note(removed),))
        return removed

    def sign_record(
        self, head: RecordHead, document: str, photos: Sequence[int], events: Sequence[Event]
    ) -> int:
        """Keep a signed record for good, with photos that waited for it; return the number it gets."""
        with self._write() as connection:
            number = signed_records.sign(connection, head, document, photos)
            _append(connection, events)
        return number

    def add_photo(self, photo: Photo) -> None:
        """Store a photo that waits for the next record of its tracker."""
        with self._write() as connection:
            signed_records.add_photo(connection, photo)

    def remove_photo(self, number: int) -> None:
        """Remove a photo that waits; one of a signed record stays."""
        with self._write() as connection:
            signed_records.remove_photo(connection, number)

    def keep_recorded(self, recorded: Recorded) -> None:
        """Keep what recordings gained, together; samples of one that does not run are left out."""
        with self._write() as connection:
            recording.keep(connection, recorded)

    def begin_recording(self, info: RecordingInfo) -> None:
        """Open a recording."""
        with self._write() as connection:
            recording.insert_head(connection, info)

    def append_frames(self, recording_id: str, frames: Frames) -> None:
        """Add frames to an open recording."""
        if not len(frames):
            return
        with self._write() as connection:
            if not recording.is_open(connection, recording_id):
                raise StoreFailed(
                    say(
                        "The recording {recording_id} is not open; no samples were added to it.",
                        recording_id=repr(recording_id),
                    )
                )
            recording.append(connection, {recording_id: frames})

    def finish_recording(self, recording_id: str, ended_at: datetime, outcome: str) -> None:
        """Close a recording."""
        with self._write() as connection:
            if not recording.close(connection, recording_id, ended_at, outcome):
                raise StoreFailed(
                    say(
                        "The recording {recording_id} is not open; it cannot be closed.",
                        recording_id=repr(recording_id),
                    )
                )

    def save_recording(self, info: RecordingInfo, chunks: Sequence[bytes]) -> None:
        """Store a whole finished recording, all or nothing; chunks in the store's own encoding."""
        try:
            blocks = [recording.block(chunk) for chunk in chunks]
        except ChunkDamaged as error:
            raise StoreFailed(
                say(
                    "The recording {recording_id} was not stored: {error}",
                    recording_id=repr(info.recording_id),
                    error=told_by(error),
                )
            ) from error
        with self._write() as connection:
            recording.insert_head(connection, info, sum(one["frame_count"] for one in blocks))
            recording.insert_chunks(connection, info.recording_id, blocks)

    def delete_recording(self, recording_id: str) -> None:
        """Delete a recording and its frames."""
        with self._write() as connection:
            connection.execute(
                delete(tables.recordings).where(tables.recordings.c.recording_id == recording_id)
            )

    def close_open_recordings(self, ended_at: datetime, outcome: str) -> list[RecordingInfo]:
        """Close what a crash left open (ended at its last frame, at `ended_at` without one) and return it."""
        columns = tables.recordings.c
        with self._write() as connection:
            left = connection.execute(recording.heads().where(columns.ended_at.is_(None))).all()
            for row in left:
                recording.pack(connection, row.recording_id, everything=True)
                info = or_none(head, row)
                at = None if info is None else recording.last_frame_at(connection, info)
                recording.close(connection, row.recording_id, at or ended_at, outcome)
            ids = [row.recording_id for row in left]
            closed = connection.execute(recording.heads().where(columns.recording_id.in_(ids))).all()
        return [info for info in (or_none(head, row) for row in closed) if info is not None]

    def prune(self, *, days_before: datetime, keep: int) -> int:
        """Delete day recordings that began before an instant and all but `keep` others; return how many."""
        columns = tables.recordings.c
        is_day, is_finished = columns.kind == RecordingKind.DAY, columns.ended_at.is_not(None)
        others = select(columns.recording_id).where(~is_day, is_finished)
        surplus = others.order_by(columns.began_at.desc(), columns.recording_id.desc()).offset(keep)
        old = select(columns.recording_id).where(is_day, is_finished, columns.began_at < days_before)
        with self._write() as connection:
            ids = [*connection.execute(old).scalars(), *connection.execute(surplus).scalars()]
            for recording_id in ids:
                connection.execute(delete(tables.recordings).where(columns.recording_id == recording_id))
        return len(ids)

    def _note(
        self, connection: Connection, table: Table, mine: ColumnElement[bool], becomes: str | None
    ) -> None:
        """Let the entry that is being made tell what a document was and what it becomes."""
        if self._auditing is not None:
            was = connection.execute(select(table.c.document).where(mine)).scalar_one_or_none()
            self._auditing.note(was, becomes)

    def close(self) -> None:
        """Let go of the connections; the last one folds the log into the file."""
        super().close()
        self._writing.dispose()


def _append(connection: Connection, events: Sequence[Event]) -> None:
    rows = [
        {
            "at": event.at,
            "kind": event.kind,
            "tracker_id": event.tracker_id,
            "actor": plain(event.actor),
            "message": plain(event.message),
            "data": EVENT_DATA.write(with_message(event)),
        }
        for event in events
    ]
    if rows:
        connection.execute(adding(tables.events), rows)
