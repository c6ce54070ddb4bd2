"""How a life of the machine begins: what is stored, what the last life left behind, what to say about it."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.alarms.alarm import Alarm
from app.build import VERSION
from app.store.store import Writer
from app.tracker.config import TrackerConfig
from app.tracker.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.recording import RecordingInfo, RecordingKind
from app.tracker.snapshot import Event, EventKind

FIRST_TRACKER = TrackerState(TrackerConfig("T1", "Tracker 1"), TrackerMemory())
CUT_OFF = "cut off: the controller service ended without warning"


@dataclass(frozen=True, slots=True)
class Beginning:
    """The stored state and the events with which a life of the machine begins."""

    site: SiteState
    trackers: tuple[TrackerState, ...]
    events: tuple[Event, ...]
    alarms: tuple[Alarm, ...] = ()


def begin(store: Writer, now: datetime, *, unclean_since: datetime | None) -> Beginning:
    """Read what is stored, making the first tracker in an empty store, and close what a crash left open."""
    site = store.site()
    if site is None:
        site = SiteState()
        store.save_site(site)
        store.save_tracker(FIRST_TRACKER)
    cut = store.close_open_recordings(now, CUT_OFF)
    event = Event(
        now + timedelta(seconds=site.clock.offset_s),
        EventKind.MACHINE_STARTED,
        None,
        _message(unclean_since, cut),
        data={
            "clean": unclean_since is None,
            "version": VERSION,
            "cut_off": [info.recording_id for info in cut],
        },
    )
    return Beginning(site, tuple(store.trackers()), (event,), tuple(store.standing_alarms()))


def _message(unclean_since: datetime | None, cut: list[RecordingInfo]) -> str:
    if unclean_since is None:
        return "The controller service started."
    shows = [f"{info.title} on {info.tracker_id}" for info in cut if info.kind is RecordingKind.SHOW]
    lost = f" Cut off: {'; '.join(shows)}." if shows else ""
    return (
        f"The controller service started again. Its last run, begun {unclean_since:%Y-%m-%d %H:%M:%S} UTC, "
        f"ended without warning (a crash or a power cut); drives with a watchdog stopped.{lost}"
    )
