"""What a token or a cabinet's page for some trackers sees: those and the site itself, never the others.

Machine and store are handed to every route through here, so that no route can forget it. What belongs to
another tracker is answered as if it did not exist. A stop is carried out everywhere.
"""

from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import replace
from datetime import datetime
from typing import TypeVar

from app.alarms.alarm import Alarm
from app.alarms.urgency import site_messages
from app.alarms.view import counts_of
from app.audit.entry import Sealed
from app.link.messages import Machine, MachineUnreachable, Order, SiteDetail, UnknownTracker, Update
from app.link.metrics import MachineMetrics
from app.store.store import (
    AlarmFilter,
    AuditFilter,
    JournalEntry,
    JournalFilter,
    KeptAlarm,
    Photo,
    PlannedShow,
    Reader,
    RecordHead,
    SignedRecord,
)
from app.tracker.memory.memory import SiteState, TrackerState
from app.tracker.memory.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.web.services.counting import Counting
from app.web.services.studies import Studies

T = TypeVar("T")


class NarrowedMachine:
    """A machine of which only some trackers are seen."""

    def __init__(self, machine: Machine, trackers: frozenset[str]) -> None:
        self._machine = machine
        self._trackers = trackers

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out an order; whoever stopped another tracker is told of that one too."""
        told = self._trackers if order.tracker_id is None else self._trackers | {order.tracker_id}
        return narrowed_site(await self._machine.execute(order), told)

    async def detail(self) -> SiteDetail:
        """Return what is stored of the site and of these trackers."""
        detail = await self._machine.detail()
        mine = {name: one for name, one in detail.trackers.items() if name in self._trackers}
        return replace(detail, trackers=mine)

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one of these trackers now, with what may be asked of it; another one there is not."""
        if tracker_id not in self._trackers:
            raise UnknownTracker(tracker_id)
        return await self._machine.tracker(tracker_id)

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        """Have snapshots of these trackers told with their actions."""
        await self._machine.watch(tracker_ids & self._trackers)

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot, with these trackers."""
        latest = self._machine.latest()
        return None if latest is None else narrowed_site(latest, self._trackers)

    async def updates(self) -> AsyncIterator[Update]:
        """Yield updates about the site and these trackers."""
        async for update in self._machine.updates():
            events = tuple(one for one in update.events if one.tracker_id in {None, *self._trackers})
            yield Update(narrowed_site(update.snapshot, self._trackers), events)

    async def metrics(self) -> MachineMetrics:
        """Return what the machine counts, of these trackers alone."""
        if not isinstance(self._machine, Counting):
            raise MachineUnreachable
        counted = await self._machine.metrics()
        mine = {name: one for name, one in counted.trackers.items() if name in self._trackers}
        return replace(counted, trackers=mine)


def narrowed_site(site: SiteSnapshot, trackers: frozenset[str]) -> SiteSnapshot:
    """Return a snapshot with these trackers, and the alarms and messages of these and of the site."""
    told = {None, *trackers}
    alarms = tuple(one for one in site.alarms if one.tracker_id in told)
    mine = tuple(one for one in site.trackers if one.tracker_id in trackers)
    return replace(
        site,
        trackers=mine,
        alarms=alarms,
        alarm_counts=counts_of(alarms, flood=site.alarm_counts.flood),
        messages=site_messages(mine, alarms),
    )


def sees_study(studies: Studies, study_id: str, trackers: frozenset[str] | None) -> bool:
    """Return whether a study may be seen: it is about no tracker, or about one of these."""
    about = None if trackers is None else studies.folder.request(study_id).tracker
    return trackers is None or about is None or about.tracker_id in trackers


class NarrowedReader:
    """A store of which only what belongs to some trackers is read; of lists each tracker's are joined."""

    def __init__(self, reader: Reader, trackers: frozenset[str]) -> None:
        self._reader = reader
        self._trackers = trackers

    def site(self) -> SiteState | None:
        """Return the stored site."""
        return self._reader.site()

    def trackers(self) -> list[TrackerState]:
        """Return these trackers as they are stored."""
        return [one for one in self._reader.trackers() if one.config.tracker_id in self._trackers]

    def journal(self, wanted: JournalFilter) -> list[JournalEntry]:
        """Return what happened to these trackers."""
        found = self._joined(
            wanted.tracker_id, lambda name: self._reader.journal(replace(wanted, tracker_id=name))
        )
        found.sort(key=lambda one: one.number, reverse=wanted.after is None)
        return found[: wanted.limit]

    def audit(self, wanted: AuditFilter) -> list[Sealed]:
        """Return nothing: the audit is the whole site's."""
        return []

    def standing_alarms(self) -> list[Alarm]:
        """Return the alarms of these trackers that stood."""
        return [one for one in self._reader.standing_alarms() if one.tracker_id in self._trackers]

    def alarm_history(self, wanted: AlarmFilter) -> list[KeptAlarm]:
        """Return the alarms of these trackers."""
        found = self._joined(
            wanted.tracker_id, lambda name: self._reader.alarm_history(replace(wanted, tracker_id=name))
        )
        found.sort(key=lambda one: one.number, reverse=True)
        return found[: wanted.limit]

    def signed_records(
        self, tracker_id: str | None = None, *, limit: int = 200, before: int | None = None
    ) -> list[RecordHead]:
        """Return the heads of these trackers' signed records."""
        found = self._joined(
            tracker_id, lambda name: self._reader.signed_records(name, limit=limit, before=before)
        )
        found.sort(key=lambda one: one.number, reverse=True)
        return found[:limit]

    def signed_record(self, number: int) -> SignedRecord | None:
        """Return one signed record of these trackers."""
        found = self._reader.signed_record(number)
        return found if found is not None and found.head.tracker_id in self._trackers else None

    def waiting_photos(self, tracker_id: str) -> list[Photo]:
        """Return the photos that wait for the next record of one of these trackers."""
        return self._reader.waiting_photos(tracker_id) if tracker_id in self._trackers else []

    def photos_of(self, record_number: int) -> list[Photo]:
        """Return the photos of a signed record of these trackers."""
        return [one for one in self._reader.photos_of(record_number) if one.tracker_id in self._trackers]

    def photo(self, number: int) -> Photo | None:
        """Return one photo of these trackers."""
        found = self._reader.photo(number)
        return found if found is not None and found.tracker_id in self._trackers else None

    def show(self, show_id: str) -> PlannedShow | None:
        """Return the plan of a show of these trackers."""
        found = self._reader.show(show_id)
        return found if found is not None and found.tracker_id in self._trackers else None

    def recordings(
        self,
        *,
        kind: RecordingKind | None = None,
        tracker_id: str | None = None,
        limit: int = 200,
        before: tuple[datetime, str] | None = None,
    ) -> list[RecordingInfo]:
        """Return these trackers' recordings, newest first."""
        found = self._joined(
            tracker_id,
            lambda name: self._reader.recordings(kind=kind, tracker_id=name, limit=limit, before=before),
        )
        found.sort(key=lambda one: (one.began_at, one.recording_id), reverse=True)
        return found[:limit]

    def recording(self, recording_id: str) -> RecordingInfo | None:
        """Return the head of one recording of these trackers."""
        found = self._reader.recording(recording_id)
        return found if found is not None and found.tracker_id in self._trackers else None

    def frames(self, recording_id: str, *, begin_s: float = 0.0, end_s: float | None = None) -> Frames:
        """Return the frames of a recording whose head was read here before."""
        return self._reader.frames(recording_id, begin_s=begin_s, end_s=end_s)

    def _joined(self, tracker_id: str | None, read: Callable[[str], Sequence[T]]) -> list[T]:
        wanted = self._trackers if tracker_id is None else self._trackers & {tracker_id}
        return [one for name in sorted(wanted) for one in read(name)]
