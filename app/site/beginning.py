"""How a life of the machine begins: what is stored, what the last life left behind, what to say about it."""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from app.alarms.alarm import Alarm
from app.build import VERSION
from app.site.checks import check_config
from app.store.store import StoreFailed, Writer
from app.tracker.config import TrackerConfig
from app.tracker.memory import RejectedSetting, SiteState, TrackerMemory, TrackerState
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
    return Beginning(site, _trackers(store, event.at), (event,), tuple(store.standing_alarms()))


def _trackers(store: Writer, at: datetime) -> tuple[TrackerState, ...]:
    """Return the trackers; where stored settings do not fit, others are stored in their place, and told."""
    try:
        found = store.trackers()
    except StoreFailed:
        found = store.mended_trackers()
    judged = tuple(map(_judged, found))
    for one in judged:
        if one.memory.rejected:
            store.save_tracker(one, (_rejected(one, at),))
    return judged


def _judged(state: TrackerState) -> TrackerState:
    """Return the tracker; one whose settings do not go together says so and stands still."""
    if state.memory.rejected:
        return state
    try:
        check_config(state.config)
    except ValueError as error:
        why = RejectedSetting("settings together", "as below", "the same", str(error))
        return replace(state, memory=replace(state.memory, rejected=(why,), tracking_on=False))
    return state


def _rejected(state: TrackerState, at: datetime) -> Event:
    values = "; ".join(
        f"{one.what} was {one.stored}, used is {one.used} ({one.why})" for one in state.memory.rejected
    )
    text = f"Stored settings of {state.config.name} were rejected at the start: {values}"
    return Event(
        at, EventKind.CONFIG_REJECTED, state.config.tracker_id, text, data={"code": "config_rejected"}
    )


def _message(unclean_since: datetime | None, cut: list[RecordingInfo]) -> str:
    if unclean_since is None:
        return "The controller service started."
    shows = [f"{info.title} on {info.tracker_id}" for info in cut if info.kind is RecordingKind.SHOW]
    lost = f" Cut off: {'; '.join(shows)}." if shows else ""
    return (
        f"The controller service started again. Its last run, begun {unclean_since:%Y-%m-%d %H:%M:%S} UTC, "
        f"ended without warning (a crash or a power cut); drives with a watchdog stopped.{lost}"
    )
