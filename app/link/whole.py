"""The whole site, kept from what is told of it: everything first, then what changed."""

from dataclasses import dataclass, replace

from app.link.codec import Told
from app.tracker.state.snapshot import Event, SiteSnapshot, Snapshot


@dataclass(frozen=True, slots=True)
class Taken:
    """What became of the whole: events to be passed on, and the trackers that changed (None: all)."""

    snapshot: SiteSnapshot
    events: tuple[Event, ...]
    changed: tuple[Snapshot, ...] | None


class Whole:
    """One site at the far end of the link; `snapshot` is complete, None before that."""

    def __init__(self) -> None:
        self.snapshot: SiteSnapshot | None = None
        self._site: SiteSnapshot | None = None
        self._trackers: dict[str, Snapshot | None] = {}
        self._events: list[Event] = []
        self._begins = True

    def follows(self, told: Told) -> bool:
        """Return whether something told follows what is known; False: something in between was lost."""
        if told.after is None:
            return True
        site = self._site
        return site is not None and (site.boot_id, site.sequence) == (told.site.boot_id, told.after)

    def take(self, told: Told) -> Taken | None:
        """Take what was told and return what became of it, None while the whole is not complete.

        After a gap nothing but events is taken until everything is told anew.
        """
        self._events.extend(told.events)
        changed = self._merge(told) if self.follows(told) else ()
        if self.snapshot is None:
            return None
        events, self._events = tuple(self._events), []
        return Taken(self.snapshot, events, changed)

    def _merge(self, told: Told) -> tuple[Snapshot, ...] | None:
        """Take what differs and return the trackers that changed in a complete snapshot; None: all."""
        if told.after is None:
            self._trackers, self._begins = {}, True
        if told.tracker_ids is not None:
            self._trackers = {name: self._trackers.get(name) for name in told.tracker_ids}
        for tracker in told.site.trackers:
            self._trackers[tracker.tracker_id] = tracker
        site, before = told.site, self._site
        if told.same_alarms and before is not None:
            site = replace(site, alarms=before.alarms, alarm_counts=before.alarm_counts)
        self._site = site
        if self._begins and told.more:
            return ()
        self.snapshot = replace(site, trackers=tuple(filter(None, self._trackers.values())))
        began, self._begins = self._begins, False
        return None if began else told.site.trackers


def with_tracker(site: SiteSnapshot, tracker: Snapshot) -> SiteSnapshot:
    """Return a site with this in the place of the tracker of its id."""
    trackers = (tracker if one.tracker_id == tracker.tracker_id else one for one in site.trackers)
    return replace(site, trackers=tuple(trackers))
