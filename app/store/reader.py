"""Reading: aggregates in domain types, the journal, recordings and their frames."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Engine, Row, Select, and_, or_, select

from app.alarms.alarm import Alarm
from app.audit.entry import Sealed
from app.base.message import say
from app.store import alarming, auditing, recording, signed_records, tables
from app.store.chunks import ChunkDamaged, decode_all
from app.store.config_repair import mended, mended_site
from app.store.connections import require_revision, transaction
from app.store.documents import CONFIG, EVENT_DATA, PLAN, RECORDING, SITE, TRACKER, or_none
from app.store.event_message import kept_message
from app.store.former import kind_of, stored_as
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
    StoreFailed,
)
from app.tracker.memory.memory import RejectedSetting, SiteState, TrackerState
from app.tracker.memory.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import Event
from app.tracker.values.actors import actor_of, names_of


class DatabaseReader:
    """Everything the store can tell; safe from any thread of any process."""

    def __init__(self, engine: Engine) -> None:
        self._reading = engine
        self._checked = False

    @contextmanager
    def _read(self) -> Iterator[Connection]:
        with transaction(self._reading) as connection:
            if not self._checked:
                require_revision(connection)
                self._checked = True
            yield connection

    def site(self) -> SiteState | None:
        """Return the stored site, None before the first save."""
        with self._read() as connection:
            document = connection.execute(select(tables.site.c.document)).scalar_one_or_none()
        return None if document is None else SITE.read(document)

    def mended_site(self) -> tuple[SiteState, tuple[RejectedSetting, ...]]:
        """Return the stored site; settings that do not fit give way to the usual ones, and are returned.

        Raises `StoreUnreadable` where that cannot be.
        """
        with self._read() as connection:
            document = connection.execute(select(tables.site.c.document)).scalar_one()
        return mended_site(document) or (SITE.read(document), ())

    def trackers(self) -> list[TrackerState]:
        """Return the stored trackers in the order they were added."""
        columns = tables.trackers.c
        with self._read() as connection:
            rows = connection.execute(
                select(columns.tracker_id, columns.document).order_by(columns.number)
            ).all()
        return [TRACKER.read(row.document, row.tracker_id) for row in rows]

    def mended_trackers(self) -> list[TrackerState]:
        """Return the stored trackers; settings that do not fit give way to those accepted last, or usual."""
        columns = tables.trackers.c
        with self._read() as connection:
            rows = connection.execute(
                select(columns.tracker_id, columns.document).order_by(columns.number)
            ).all()
        return [
            mended(row.document, row.tracker_id, self.accepted_settings(row.tracker_id))
            or TRACKER.read(row.document, row.tracker_id)
            for row in rows
        ]

    def accepted_settings(self, tracker_id: str) -> TrackerConfig | None:
        """Return the settings with which a tracker ran last; None: not known, or they do not fit any more."""
        columns = tables.trackers.c
        with self._read() as connection:
            mine = select(columns.accepted).where(columns.tracker_id == tracker_id)
            document = connection.execute(mine).scalar_one_or_none()
        with suppress(StoreFailed):
            return None if document is None else CONFIG.read(document, tracker_id)
        return None

    def journal(self, wanted: JournalFilter) -> list[JournalEntry]:
        """Return entries, newest first; with `after` oldest first."""
        with self._read() as connection:
            rows = connection.execute(_journal_query(wanted)).all()
        return [_entry(row) for row in rows]

    def newest_entry_at(self) -> datetime | None:
        """Return when the newest entry of the journal was written, None of an empty one."""
        columns = tables.events.c
        with self._read() as connection:
            return connection.execute(
                select(columns.at).order_by(columns.number.desc()).limit(1)
            ).scalar_one_or_none()

    def audit(self, wanted: AuditFilter) -> list[Sealed]:
        """Return audit entries, newest first; with `after` oldest first."""
        with self._read() as connection:
            rows = connection.execute(auditing.query(wanted)).mappings().all()
        return [auditing.sealed(row) for row in rows]

    def standing_alarms(self) -> list[Alarm]:
        """Return the alarms that stood when they were last stored, but for those that cannot be read."""
        with self._read() as connection:
            rows = connection.execute(alarming.standing()).all()
        return [one.alarm for one in (or_none(alarming.kept, row) for row in rows) if one is not None]

    def alarm_history(self, wanted: AlarmFilter) -> list[KeptAlarm]:
        """Return alarms, those that stand and those that ended, newest first."""
        with self._read() as connection:
            rows = connection.execute(alarming.history(wanted)).all()
        return [alarming.kept(row) for row in rows]

    def signed_records(
        self, tracker_id: str | None = None, *, limit: int = 200, before: int | None = None
    ) -> list[RecordHead]:
        """Return the heads of signed commissioning records, newest first: those before a number."""
        with self._read() as connection:
            return signed_records.heads(connection, tracker_id, limit, before)

    def signed_record(self, number: int) -> SignedRecord | None:
        """Return one signed record."""
        with self._read() as connection:
            return signed_records.record(connection, number)

    def waiting_photos(self, tracker_id: str) -> list[Photo]:
        """Return the photos that wait for the next record of a tracker, in the order they were added."""
        photos = tables.record_photos.c
        with self._read() as connection:
            return signed_records.photos(
                connection, photos.tracker_id == tracker_id, photos.record_number.is_(None)
            )

    def photos_of(self, record_number: int) -> list[Photo]:
        """Return the photos of a signed record, in the order they were added."""
        with self._read() as connection:
            return signed_records.photos(connection, tables.record_photos.c.record_number == record_number)

    def photo(self, number: int) -> Photo | None:
        """Return one photo."""
        with self._read() as connection:
            found = signed_records.photos(connection, tables.record_photos.c.number == number)
        return found[0] if found else None

    def show(self, show_id: str) -> PlannedShow | None:
        """Return the plan of a show."""
        columns = tables.shows.c
        with self._read() as connection:
            row = connection.execute(
                select(columns.tracker_id, columns.document).where(columns.show_id == show_id)
            ).one_or_none()
        return None if row is None else PlannedShow(row.tracker_id, PLAN.read(row.document, show_id))

    def recordings(
        self,
        *,
        kind: RecordingKind | None = None,
        tracker_id: str | None = None,
        limit: int = 200,
        before: tuple[datetime, str] | None = None,
    ) -> list[RecordingInfo]:
        """Return recordings, newest first: those that began before an instant, or at it with a lower id."""
        columns = tables.recordings.c
        query = recording.heads().order_by(columns.began_at.desc(), columns.recording_id.desc()).limit(limit)
        if kind is not None:
            query = query.where(columns.kind == kind)
        if tracker_id is not None:
            query = query.where(columns.tracker_id == tracker_id)
        if before is not None:
            began_at, recording_id = before
            same = and_(columns.began_at == began_at, columns.recording_id < recording_id)
            query = query.where(or_(columns.began_at < began_at, same))
        with self._read() as connection:
            rows = connection.execute(query).all()
        return [head(row) for row in rows]

    def recording(self, recording_id: str) -> RecordingInfo | None:
        """Return the head of one recording."""
        query = recording.heads().where(tables.recordings.c.recording_id == recording_id)
        with self._read() as connection:
            row = connection.execute(query).one_or_none()
        return None if row is None else head(row)

    def frames(self, recording_id: str, *, begin_s: float = 0.0, end_s: float | None = None) -> Frames:
        """Return the frames whose `elapsed_s` lies in the range, ends included; empty if there are none."""
        with self._read() as connection:
            stored = recording.stored_frames(connection, recording_id, begin_s, end_s)
        try:
            return _between(decode_all(stored), begin_s, end_s)
        except ChunkDamaged as error:
            raise StoreFailed(
                say(
                    "Samples of the recording {recording_id} are damaged and cannot be shown. Restore a "
                    "backup to recover them, or delete the recording.",
                    recording_id=repr(recording_id),
                )
            ) from error

    def close(self) -> None:
        """Let go of the connections."""
        self._reading.dispose()


def head(row: Row[*tuple[Any, ...]]) -> RecordingInfo:
    """Return the head of a recording from its row."""
    info = RECORDING.read(row.document, row.recording_id)
    return replace(info, ended_at=row.ended_at, outcome=row.outcome, sample_count=row.frame_count)


def _journal_query(wanted: JournalFilter) -> Select[Any]:
    columns = tables.events.c
    order = columns.number.desc() if wanted.after is None else columns.number.asc()
    query = select(tables.events).order_by(order).limit(wanted.limit)
    if wanted.after is not None:
        query = query.where(columns.number > wanted.after)
    if wanted.before is not None:
        query = query.where(columns.number < wanted.before)
    if wanted.tracker_id is not None:
        query = query.where(columns.tracker_id == wanted.tracker_id)
    if wanted.kinds:
        query = query.where(columns.kind.in_(stored_as(wanted.kinds)))
    if wanted.actor is not None:
        query = query.where(columns.actor.in_(names_of(wanted.actor)))
    if wanted.text is not None:
        query = query.where(columns.message.icontains(wanted.text, autoescape=True))
    return _within(query, wanted)


def _within(query: Select[Any], wanted: JournalFilter) -> Select[Any]:
    columns = tables.events.c
    if wanted.start is not None:
        query = query.where(columns.at >= wanted.start)
    if wanted.end is not None:
        query = query.where(columns.at <= wanted.end)
    return query


def _entry(row: Row[*tuple[Any, ...]]) -> JournalEntry:
    kind = kind_of(row.kind)
    if kind is None:
        raise StoreFailed(
            say(
                "Entry {number} of the journal is of the unknown kind {kind}. Install the version "
                "that wrote it.",
                number=row.number,
                kind=repr(row.kind),
            )
        )
    data = EVENT_DATA.read(row.data, str(row.number))
    event = Event(row.at, kind, row.tracker_id, kept_message(row.message, data), actor_of(row.actor), data)
    return JournalEntry(row.number, event)


def _between(frames: Frames, begin_s: float, end_s: float | None) -> Frames:
    elapsed_s = frames.column("elapsed_s")
    inside = elapsed_s >= begin_s
    if end_s is not None:
        inside &= elapsed_s <= end_s
    return frames if inside.all() else Frames(frames.values[inside])
