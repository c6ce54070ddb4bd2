"""How a life of the machine begins: what is stored, what the last life left behind, what to say about it."""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from app.alarms.alarm import Alarm
from app.base.build import VERSION
from app.base.instants import NOT_OF_THESE_TIMES
from app.base.message import N_, NOTHING, Message, join, plain, say, told_by, with_format
from app.site.clock.timekeeping import can_be
from app.site.state.validation import check_config
from app.store.config_repair import fallen_back
from app.store.store import StoreFailed, StoreUnreadable, Writer
from app.tracker.memory.memory import (
    AgesFrom,
    ClockSetting,
    RejectedSetting,
    SiteState,
    TrackerMemory,
    TrackerState,
)
from app.tracker.memory.recording import RecordingInfo, RecordingKind
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import Event, EventKind

FIRST_TRACKER = TrackerState(TrackerConfig("T1", N_("Tracker 1")), TrackerMemory())
CUT_OFF = N_("interrupted: the controller service ended unexpectedly")


@dataclass(frozen=True, slots=True)
class Beginning:
    """The stored state and the events with which a life of the machine begins."""

    site: SiteState
    trackers: tuple[TrackerState, ...]
    events: tuple[Event, ...]
    alarms: tuple[Alarm, ...] = ()


def begin(store: Writer, now: datetime, *, unclean_since: datetime | None) -> Beginning:
    """Read what is stored, making the first tracker in an empty store, and close what a crash left open."""
    site = _site(store, now)
    cut = store.close_open_recordings(now, CUT_OFF)
    event = Event(
        now + timedelta(seconds=site.clock.offset_s),
        EventKind.CONTROLLER_STARTED,
        None,
        _message(unclean_since, cut),
        data={
            "clean": unclean_since is None,
            "version": VERSION,
            "cut_off": [info.recording_id for info in cut],
        },
    )
    return Beginning(site, _trackers(store, event.at), (event,), tuple(store.standing_alarms()))


def _site(store: Writer, now: datetime) -> SiteState:
    """Return the site, stored without what of it does not fit, which is told."""
    rejected: tuple[RejectedSetting, ...] = ()
    try:
        stored = store.site()
    except StoreUnreadable:
        stored, rejected = store.mended_site()
    if stored is None:
        store.save_tracker(FIRST_TRACKER)
    site = stored or SiteState()
    if not can_be(site.clock, now):
        offset = plain(f"{site.clock.offset_s:+g} s")
        rejected += (RejectedSetting(N_("Clock"), offset, N_("none"), NOT_OF_THESE_TIMES),)
        site = replace(site, clock=ClockSetting())
    if site.ages_from is None:
        site = replace(site, ages_from=AgesFrom(store.newest_entry_at() or now))
    if site != stored or rejected:
        at = now + timedelta(seconds=site.clock.offset_s)
        store.save_site(site, (_told(site.name, rejected, at, None),) if rejected else ())
    return site


def _trackers(store: Writer, at: datetime) -> tuple[TrackerState, ...]:
    """Return the trackers; where stored settings do not fit, others are stored in their place, and told."""
    try:
        found = store.trackers()
    except StoreFailed:
        found = store.mended_trackers()
    judged = tuple(_judged(one, store) for one in found)
    for one in judged:
        if one.memory.rejected:
            told = _told(one.config.name, one.memory.rejected, at, one.config.tracker_id)
            store.save_tracker(one, (told,))
    return judged


def _judged(state: TrackerState, store: Writer) -> TrackerState:
    """Return the tracker; one whose settings do not go together runs with those accepted last and stands.

    Where those are not known, or do not go together either, it keeps what is stored, and stands all the same.
    """
    wrong = _wrong(state.config)
    if not wrong:
        return state
    accepted = store.accepted_settings(state.config.tracker_id)
    if accepted is not None and accepted != state.config and not _wrong(accepted):
        return fallen_back(state, accepted, why=wrong)
    why = RejectedSetting(N_("combination of settings"), N_("as below"), N_("the same"), wrong)
    if why in state.memory.rejected:
        return state
    rejected = (*state.memory.rejected, why)
    return replace(state, memory=replace(state.memory, rejected=rejected, tracking_on=False))


def _wrong(config: TrackerConfig) -> Message:
    """Return what is wrong with settings together, empty where nothing is."""
    try:
        check_config(config)
    except ValueError as error:
        return told_by(error)
    return NOTHING


def _told(name: str, rejected: tuple[RejectedSetting, ...], at: datetime, tracker_id: str | None) -> Event:
    """Return the event that says which stored settings of a tracker, or of the site, were rejected."""
    values = join(
        "; ",
        (
            say(
                "{what}: stored {stored}, used {used} ({why})",
                what=one.what,
                stored=one.stored,
                used=one.used,
                why=one.why,
            )
            for one in rejected
        ),
    )
    text = say("Stored settings of {name} were rejected at startup: {values}", name=name, values=values)
    return Event(at, EventKind.CONFIG_REJECTED, tracker_id, text, data={"code": "config_rejected"})


def _message(unclean_since: datetime | None, cut: list[RecordingInfo]) -> Message:
    if unclean_since is None:
        return N_("The controller service started.")
    shows = [
        say("{title} on {tracker_id}", title=info.title, tracker_id=info.tracker_id)
        for info in cut
        if info.kind is RecordingKind.SHOW
    ]
    restarted = say(
        "The controller service restarted. Its last run, started {unclean_since} UTC, ended "
        "unexpectedly (a crash or a power failure); drives with a watchdog stopped.",
        unclean_since=with_format(unclean_since, "%Y-%m-%d %H:%M:%S"),
    )
    return join(" ", (restarted, say("Cut off: {shows}.", shows=join("; ", shows)))) if shows else restarted
