"""What the site writes down: settings before they are acknowledged, events and frames behind the loop."""

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

from app.store.store import PlannedShow, StoreFailed, Writer
from app.tracker.commands import CommandRejected
from app.tracker.memory import SiteState, TrackerState
from app.tracker.reason import Reason
from app.tracker.snapshot import Event

T = TypeVar("T")


class BackgroundWriter(Protocol):
    """A writer with a thread of its own."""

    async def call(self, work: Callable[[Writer], T]) -> T:
        """Do the work in its turn and return what it returned, or raise what it raised."""

    def post(self, work: Callable[[Writer], object]) -> bool:
        """Do the work in its turn, or return that there is no room; failures go to who watches the writer."""


class Ledger:
    """Keeps settings, events and plans; without a writer everything lives in memory only."""

    def __init__(self, writer: BackgroundWriter | None) -> None:
        self._writer = writer
        self.event_count = 0
        self._behind = False

    @property
    def behind(self) -> bool:
        """Return whether something that was to be stored was not, so that the disk holds an older state."""
        return self._behind

    @property
    def writer(self) -> BackgroundWriter | None:
        """Return the writer, None for a site that keeps nothing."""
        return self._writer

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
        try:
            await self._writer.call(work)
        except StoreFailed as error:
            raise CommandRejected(
                Reason("not_stored", str(error), "Nothing was changed; free the disk and try again.")
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

    def catch_up(self, site: SiteState, trackers: Sequence[TrackerState]) -> None:
        """Have the whole state stored anew; once it is on disk, nothing is behind any more."""

        def store(writer: Writer) -> None:
            writer.save_site(site)
            for state in trackers:
                writer.save_tracker(state)
            self._behind = False

        self._post(store, 0)

    def _post(self, work: Callable[[Writer], object], event_count: int) -> None:
        """Have the work done behind the loop; whether it failed is noted on the writer's thread."""
        self.event_count += event_count
        if self._writer is None:
            return

        def noted(writer: Writer) -> None:
            try:
                work(writer)
            except Exception:
                self._behind = True
                raise

        if not self._writer.post(noted):
            self._behind = True
