"""What forbids another location, clock, or setting: a lock, or a tracker that moves or is led by it."""

from collections.abc import Iterable, Iterator, Mapping
from datetime import timedelta
from enum import Enum, auto
from typing import NamedTuple

from app.base.message import Message, say
from app.tracker.access.activity_interlocks import busy
from app.tracker.access.local_locks import locked_settings
from app.tracker.memory.memory import TrackerState
from app.tracker.state.snapshot import ActivityName, Snapshot
from app.tracker.values.reason import Reason

MOST_APART = timedelta(minutes=1)
"""Two clocks that are not further apart agree: the sun moves by a quarter of a degree in this time."""


AT_REST = frozenset({ActivityName.HOLDING, ActivityName.FAULTED})
"""What a tracker does that neither moves nor means to."""


class Doing(NamedTuple):
    """What a tracker does, whether tracking is on, and whether it goes on with that by itself."""

    activity: ActivityName
    tracking_on: bool
    continues: bool


def doing(trackers: Iterable[Snapshot]) -> dict[str, Doing]:
    """Return what trackers do, by their ids."""
    return {one.tracker_id: Doing(one.activity, one.tracking_on, one.continues) for one in trackers}


class _Led(Enum):
    """How a tracker is led by location and clock."""

    TRACKS = auto()
    SHOWS = auto()
    CONTINUES = auto()
    IS_ON = auto()


def against_another_location(
    trackers: Mapping[str, TrackerState], now: Mapping[str, Doing]
) -> tuple[Reason, ...]:
    """Return why the location of a site with these trackers, which do this now, cannot be changed.

    The location is locked with any tracker, because all of them aim by it.
    """
    locks = (locked_settings(one.config, one.memory) for one in trackers.values())
    return tuple(lock for lock in locks if lock is not None) or led_by_the_location(now)


def led_by_the_location(now: Mapping[str, Doing]) -> tuple[Reason, ...]:
    """Return which trackers follow the sun of the present location, or may do so with nobody asked."""
    return tuple(
        Reason("follows_the_sun", _by_location(tracker_id, led), hint) for tracker_id, led, hint in _led(now)
    )


def against_another_clock(by: timedelta, now: Mapping[str, Doing]) -> tuple[Reason, ...]:
    """Return which trackers forbid that the site's clock moves by so much, none up to a minute."""
    if abs(by) <= MOST_APART:
        return ()
    return tuple(
        Reason("follows_the_clock", _by_clock(tracker_id, led), hint) for tracker_id, led, hint in _led(now)
    )


def against_other_settings(tracker_id: str, now: Doing, *, is_moving: bool) -> Reason | None:
    """Return why a tracker, which does this now, takes no other settings: it moves or means to."""
    stop = say("Stop {tracker_id} first.", tracker_id=tracker_id)
    if now.activity not in AT_REST:
        return Reason("tracker_busy", busy("tracker_busy", tracker_id, now.activity).message, stop)
    if is_moving:
        return Reason("tracker_busy", say("{name} is not at standstill.", name=tracker_id), stop)
    return None


def against_another_aim(tracker_id: str, now: Doing, *, is_moving: bool) -> Reason | None:
    """Return why a tracker takes nothing that moves its target: it moves, or tracking may go on there."""
    if reason := against_other_settings(tracker_id, now, is_moving=is_moving):
        return reason
    if not (now.tracking_on or now.continues):
        return None
    led = _Led.CONTINUES if now.continues else _Led.IS_ON
    stop = say("Stop {tracker_id} first.", tracker_id=tracker_id)
    return Reason("tracker_busy", _by_location(tracker_id, led), stop)


def _led(now: Mapping[str, Doing]) -> Iterator[tuple[str, _Led, Message]]:
    """Yield the trackers that are led, how, and what to do first."""
    for tracker_id, (activity, tracking_on, continues) in now.items():
        stop = say("Stop {tracker_id} first.", tracker_id=tracker_id)
        match activity:
            case ActivityName.TRACKING:
                end = say("End tracking of {tracker_id} first.", tracker_id=tracker_id)
                yield tracker_id, _Led.TRACKS, end
            case ActivityName.SHOWING:
                yield tracker_id, _Led.SHOWS, stop
            case ActivityName.STOWING | ActivityName.STOWED if continues:
                wait = say(
                    "Wait until {tracker_id} is tracking again, then end tracking.", tracker_id=tracker_id
                )
                yield tracker_id, _Led.CONTINUES, wait
            case _ if continues:
                yield tracker_id, _Led.CONTINUES, stop
            case _ if tracking_on:
                yield tracker_id, _Led.IS_ON, stop
            case _:
                pass


def _by_location(tracker_id: str, led: _Led) -> Message:
    match led:
        case _Led.TRACKS:
            return say("{tracker_id} is tracking the sun for the present location.", tracker_id=tracker_id)
        case _Led.SHOWS:
            return say("{tracker_id} is running a show.", tracker_id=tracker_id)
        case _Led.CONTINUES:
            return say("{tracker_id} may continue tracking automatically.", tracker_id=tracker_id)
        case _Led.IS_ON:
            return say("Tracking is still switched on for {tracker_id}.", tracker_id=tracker_id)


def _by_clock(tracker_id: str, led: _Led) -> Message:
    match led:
        case _Led.TRACKS:
            return say("{tracker_id} is tracking the sun by the present clock.", tracker_id=tracker_id)
        case _Led.SHOWS:
            return say("{tracker_id} is running a show by the present clock.", tracker_id=tracker_id)
        case _Led.CONTINUES:
            return say(
                "{tracker_id} may continue tracking automatically by the present clock.",
                tracker_id=tracker_id,
            )
        case _Led.IS_ON:
            return say("Tracking is still switched on for {tracker_id}.", tracker_id=tracker_id)
