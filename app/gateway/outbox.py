"""What is still to be told: the journal behind a cursor on disk, and recordings that were not announced.

The journal is on disk before anybody hears of an event, so it is the outbox: nothing is kept twice, and
what happened while the broker, the network or this computer was down is sent later, in order.
"""

from dataclasses import asdict, dataclass, field
from pathlib import Path
from threading import RLock
from uuid import uuid4

import orjson

from app.store.store import JournalEntry, JournalFilter, Reader
from app.tracker.memory.recording import RecordingInfo

MOST_UNSENT = 100_000
RECORDINGS_KNOWN = 500


@dataclass(slots=True)
class _Cursor:
    """How far a series of numbers was acknowledged, and how each recording was last announced.

    `at` is when the event of that number happened: another one there means another journal. `alarms` are
    those that are retained at the broker.
    """

    series: str
    number: int
    at: str = ""
    recordings: dict[str, str] = field(default_factory=dict)
    alarms: list[str] = field(default_factory=list)


class Outbox:
    """Reads what was not acknowledged yet. Its calls block, so make them in a thread; they wait in turn."""

    def __init__(self, reader: Reader, path: Path) -> None:
        self._reader = reader
        self._path = path
        self._cursor: _Cursor | None = None
        self._one_at_a_time = RLock()
        self._is_saved = False
        self.dropped = 0

    def begin(self) -> None:
        """Fix on disk where the telling begins; call it before anything happens."""
        with self._one_at_a_time:
            cursor = self._known()
            if cursor.at and cursor.at != self._at(cursor.number):
                self._cursor = self._fresh()
            self._save()

    @property
    def series(self) -> str:
        """Return the name of the numbering, which changes when the journal was replaced by an older one."""
        return self._known().series

    def events(self, limit: int) -> list[JournalEntry]:
        """Return the oldest events that were not acknowledged; too old ones are dropped and counted."""
        with self._one_at_a_time:
            cursor, newest = self._known(), self._newest()
            excess = newest - cursor.number - MOST_UNSENT
            if excess > 0:
                cursor.number += excess
                self.dropped += excess
            return self._reader.journal(JournalFilter(after=cursor.number, limit=limit))

    def waiting(self) -> int:
        """Return how many events are not acknowledged, at most."""
        with self._one_at_a_time:
            return max(0, self._newest() - self._known().number)

    def acknowledge(self, entry: JournalEntry) -> None:
        """Note that every event up to this one has arrived."""
        with self._one_at_a_time:
            self.skip(entry)
            self._save()

    def skip(self, entry: JournalEntry) -> None:
        """Pass over every event up to this one; that is saved with the next thing that is, or by `keep`.

        What nobody wants to hear of costs no write: the file of a place in the journal is 30 KiB of disk.
        """
        with self._one_at_a_time:
            cursor = self._known()
            cursor.number, cursor.at = entry.number, entry.event.at.isoformat()
            self._is_saved = False

    def keep(self) -> None:
        """Save what was passed over, if that was not done since."""
        with self._one_at_a_time:
            if not self._is_saved:
                self._save()

    def newest(self) -> JournalEntry | None:
        """Return the newest event if it was not acknowledged."""
        with self._one_at_a_time:
            newest = self._reader.journal(JournalFilter(limit=1))
            return newest[0] if newest and newest[0].number > self._known().number else None

    def recordings(self) -> list[RecordingInfo]:
        """Return recordings whose state was not announced yet, oldest first."""
        with self._one_at_a_time:
            known = self._known().recordings
            found = self._reader.recordings()
            return [one for one in reversed(found) if known.get(one.recording_id) != recording_state(one)]

    def announced(self, recording: RecordingInfo) -> None:
        """Note that a recording's state has arrived."""
        with self._one_at_a_time:
            known = self._known().recordings
            known[recording.recording_id] = recording_state(recording)
            for oldest in list(known)[: max(0, len(known) - RECORDINGS_KNOWN)]:
                del known[oldest]
            self._save()

    def retained_alarms(self) -> list[str]:
        """Return the alarms that are retained at the broker."""
        with self._one_at_a_time:
            return list(self._known().alarms)

    def retain_alarms(self, alarm_ids: list[str]) -> None:
        """Note which alarms are, or may be, retained at the broker."""
        with self._one_at_a_time:
            self._known().alarms = alarm_ids
            self._save()

    def _known(self) -> _Cursor:
        if self._cursor is None:
            self._cursor = self._load() or self._fresh()
        return self._cursor

    def _load(self) -> _Cursor | None:
        try:
            return _Cursor(**orjson.loads(self._path.read_bytes()))
        except (OSError, ValueError, TypeError):
            return None

    def _fresh(self) -> _Cursor:
        """Begin with what happens from now on: old history is not poured out."""
        known = {one.recording_id: recording_state(one) for one in self._reader.recordings()}
        number = self._newest()
        return _Cursor(uuid4().hex, number, self._at(number), known)

    def _at(self, number: int) -> str:
        found = self._reader.journal(JournalFilter(after=number - 1, limit=1))
        return found[0].event.at.isoformat() if found and found[0].number == number else ""

    def _newest(self) -> int:
        newest = self._reader.journal(JournalFilter(limit=1))
        return newest[0].number if newest else 0

    def _save(self) -> None:
        """Replace the cursor's file; one that is lost in a power cut makes duplicates, never gaps."""
        fresh = self._path.with_suffix(".new")
        fresh.write_bytes(orjson.dumps(asdict(self._known())))
        fresh.replace(self._path)
        self._is_saved = True


def recording_state(recording: RecordingInfo) -> str:
    """Return what is announced of a recording: that it runs, or how it ended."""
    return "running" if recording.ended_at is None else "finished"
