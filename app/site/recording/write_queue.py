"""What the site writes down: settings before they are acknowledged, events and frames behind the loop.

What is posted gathers for a moment and is stored together; what is waited for is stored after it, at once.
"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from app.audit.entry import Entry
from app.base.clock import Clock
from app.base.message import N_, told_by
from app.site.recording.auditing import IN_HAND, log_head
from app.site.recording.gathering import BackgroundWriter, Gathering, Waiting
from app.store.store import KeptAlarm, PlannedShow, StoreFailed, Writer
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import SiteState, TrackerState
from app.tracker.state.snapshot import Event
from app.tracker.values.reason import Reason

T = TypeVar("T")

MOST_UNRECORDED = 1000
"""How many orders, most of them stops, are kept in memory until the disk takes them."""


class Ledger:
    """Keeps settings, events and plans; without a writer everything lives in memory only."""

    def __init__(
        self,
        writer: BackgroundWriter | None,
        clock: Clock,
        paced: Callable[[Sequence[Waiting]], Iterable[Waiting]] = iter,
    ) -> None:
        self._writer = writer
        self._gathering = None if writer is None else Gathering(writer, clock, self._fall_behind, paced)
        self.event_count = 0
        self._behind = False
        self._unrecorded: deque[Entry] = deque(maxlen=MOST_UNRECORDED)
        self._along: dict[str, Callable[[Writer], object]] = {}

    @property
    def behind(self) -> bool:
        """Return whether something that was to be stored was not, so that the disk holds an older state."""
        return self._behind

    @property
    def writer(self) -> BackgroundWriter | None:
        """Return the writer, None for a site that keeps nothing."""
        return self._writer

    def hand_over(self) -> None:
        """Hand what was posted to the writer, so that whatever it is given next comes after it."""
        if self._gathering is not None:
            self._gathering.hand_over()

    def close(self) -> None:
        """Hand over the last that was posted."""
        if self._gathering is not None:
            self._gathering.close()

    async def save_site(self, site: SiteState, events: Sequence[Event]) -> None:
        """Return once the site and the events that belong to the change are on disk."""
        await self.keep(lambda writer: writer.save_site(site, events), len(events))

    async def save_tracker(self, state: TrackerState, events: Sequence[Event]) -> None:
        """Return once the tracker and the events that belong to the change are on disk."""
        await self.keep(lambda writer: writer.save_tracker(state, events), len(events))

    async def remove_tracker(self, tracker_id: str, events: Sequence[Event]) -> None:
        """Return once the tracker is forgotten on disk."""
        await self.keep(lambda writer: writer.remove_tracker(tracker_id, events), len(events))

    async def save_show(self, planned: PlannedShow) -> None:
        """Return once the plan is on disk."""
        await self.keep(lambda writer: writer.save_show(planned), 0)

    async def append(self, events: Sequence[Event]) -> None:
        """Return once the events are on disk."""
        if events:
            await self.keep(lambda writer: writer.append_events(events), len(events))

    async def keep(self, work: Callable[[Writer], None], event_count: int) -> None:
        """Return once the work is on disk, or raise `CommandRejected` with what the store says."""
        self.event_count += event_count
        if self._writer is None:
            return
        self.hand_over()
        try:
            await self._writer.call(self._audited(work))
        except StoreFailed as error:
            raise CommandRejected(
                Reason(
                    "not_stored", told_by(error), N_("Nothing was changed; free disk space and try again.")
                )
            ) from error

    def post_tracker(self, state: TrackerState, events: Sequence[Event]) -> None:
        """Have the tracker and its events stored soon, in order, without waiting."""
        self._post(lambda writer: writer.save_tracker(state, events), len(events))

    def post_site(self, site: SiteState, events: Sequence[Event]) -> None:
        """Have the site and its events stored soon, in order, without waiting."""
        self._post(lambda writer: writer.save_site(site, events), len(events))

    def post_events(self, events: Sequence[Event]) -> None:
        """Have events stored soon, in order, without waiting."""
        if events:
            self._post(lambda writer: writer.append_events(events), len(events))

    def post_entry(self, entry: Entry) -> None:
        """Have an audit entry stored soon that belongs to no change."""
        if self._gathering is not None:
            self._gathering.add(_record(entry), entry)

    def post_head(self) -> None:
        """Have the audit's last number and hash logged soon."""
        if self._writer is not None:
            self.hand_over()
            self._writer.post(log_head)

    def post_alarms(self, alarms: Sequence[KeptAlarm], events: Sequence[Event]) -> None:
        """Have alarms and what became of them stored soon, without waiting.

        They come by themselves, even while an order is carried out: its audit entry is none of theirs.
        """
        self.event_count += len(events)
        if self._gathering is not None:
            self._gathering.add(lambda writer: writer.save_alarms(alarms, events), None)

    def post_along(self, name: str, work: Callable[[Writer], object]) -> None:
        """Have something stored with the next samples, at no cost of its own; the newest of a name counts."""
        if self._writer is not None:
            self._along[name] = work

    @property
    def has_along(self) -> bool:
        """Return whether something waits to be stored with the next samples."""
        return bool(self._along)

    def post_together(self, work: Callable[[Writer], object], finished: Callable[[bool], None]) -> None:
        """Have the work and what is to go along stored in one transaction; `finished` hears whether it was.

        `finished` is called on the writer's thread, or here if there is no room.
        """
        along, self._along = self._along, {}

        def together(writer: Writer) -> None:
            with writer.together():
                work(writer)
                for more in along.values():
                    more(writer)

        def store(writer: Writer) -> None:
            try:
                self._noted(writer, together, None)
            except Exception:
                give_back()
                raise
            finished(True)

        def give_back() -> None:
            for name, more in along.items():
                self._along.setdefault(name, more)
            finished(False)

        self.hand_over()
        if self._writer is not None and not self._writer.post(store):
            self._fall_behind(None)
            give_back()

    def catch_up(
        self, site: SiteState, trackers: Sequence[TrackerState], alarms: Sequence[KeptAlarm] = ()
    ) -> None:
        """Have the whole state stored anew; once it is on disk, nothing is behind any more."""

        def store(writer: Writer) -> None:
            unrecorded = tuple(self._unrecorded)
            with writer.together():
                writer.save_site(site)
                for state in trackers:
                    writer.save_tracker(state)
                writer.save_alarms(alarms)
                for entry in unrecorded:
                    _record(entry)(writer)
            for _ in unrecorded:
                self._unrecorded.popleft()
            self._behind = False

        if self._writer is not None:
            self.hand_over()
            self._writer.post(store)

    def _post(self, work: Callable[[Writer], object], event_count: int) -> None:
        """Have the work done behind the loop; whether it failed is noted on the writer's thread."""
        self.event_count += event_count
        if self._gathering is not None:
            entry = self._entry_in_hand()
            self._gathering.add(self._audited(work), entry)

    def _noted(self, writer: Writer, work: Callable[[Writer], object], entry: Entry | None) -> None:
        try:
            work(writer)
        except Exception:
            self._fall_behind(entry)
            raise

    def _fall_behind(self, entry: Entry | None) -> None:
        self._behind = True
        if entry is not None:
            self._unrecorded.append(entry)

    def _entry_in_hand(self) -> Entry | None:
        """Return the entry that the next thing stored takes along."""
        in_hand = IN_HAND.get()
        return None if in_hand is None or in_hand.over or in_hand.written else in_hand.entry

    def _audited(self, work: Callable[[Writer], T]) -> Callable[[Writer], T]:
        """Return the work with the audit entry of the order that this task carries out, if it does.

        The first thing that an order stores takes its entry along, others only if they change something.
        """
        in_hand = IN_HAND.get()
        if in_hand is None or in_hand.over:
            return work
        only_changes, in_hand.written = in_hand.written, True

        def recorded(writer: Writer) -> T:
            with writer.audited(in_hand.entry, only_changes=only_changes):
                return work(writer)

        return recorded


def _record(entry: Entry) -> Callable[[Writer], None]:
    """Return the work of writing an entry that belongs to no change."""

    def record(writer: Writer) -> None:
        with writer.audited(entry):
            pass

    return record
