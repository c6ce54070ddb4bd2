"""What forbids another location or clock: settings that are locked, trackers that follow the sun."""

from collections.abc import Iterator, Mapping
from datetime import timedelta

from app.base.message import say
from app.tracker.access.local_locks import locked_settings
from app.tracker.memory.memory import TrackerState
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.reason import Reason

MOST_APART = timedelta(minutes=1)
"""Two clocks that are not further apart agree: the sun moves by a quarter of a degree in this time."""
FOLLOWS_THE_SUN = frozenset({ActivityName.TRACKING, ActivityName.SHOWING})


def against_another_location(
    trackers: Mapping[str, TrackerState], doing: Mapping[str, ActivityName]
) -> tuple[Reason, ...]:
    """Return why the location of a site with these trackers, which do this now, cannot be changed.

    The location is locked with any tracker, because all of them aim by it.
    """
    locks = (locked_settings(one.config, one.memory) for one in trackers.values())
    return tuple(lock for lock in locks if lock is not None) or following(doing)


def following(doing: Mapping[str, ActivityName]) -> tuple[Reason, ...]:
    """Return which trackers follow the sun of the present location."""
    return tuple(
        Reason(
            "follows_the_sun",
            say("{tracker_id} is tracking the sun for the present location.", tracker_id=tracker_id),
            say("Stop {tracker_id} first.", tracker_id=tracker_id),
        )
        for tracker_id, activity in doing.items()
        if activity in FOLLOWS_THE_SUN
    )


def against_another_clock(
    by: timedelta, doing: Mapping[str, tuple[ActivityName, bool]]
) -> tuple[Reason, ...]:
    """Return which trackers forbid that the site's clock moves by so much, none up to a minute.

    Of each is told what it does, and whether tracking is on: it may continue after a stow or a fault.
    """
    return () if abs(by) <= MOST_APART else tuple(_led_by_the_clock(doing))


def _led_by_the_clock(doing: Mapping[str, tuple[ActivityName, bool]]) -> Iterator[Reason]:
    for tracker_id, (activity, tracking_on) in doing.items():
        stop = say("Stop {tracker_id} first.", tracker_id=tracker_id)
        match activity:
            case ActivityName.TRACKING:
                text = say("{tracker_id} is tracking the sun by the present clock.", tracker_id=tracker_id)
                hint = say("End tracking of {tracker_id} first.", tracker_id=tracker_id)
                yield Reason("follows_the_clock", text, hint)
            case ActivityName.SHOWING:
                text = say("{tracker_id} is running a show by the present clock.", tracker_id=tracker_id)
                yield Reason("follows_the_clock", text, stop)
            case ActivityName.STOWING | ActivityName.STOWED | ActivityName.FAULTED if tracking_on:
                text = say(
                    "{tracker_id} may continue tracking automatically by the present clock.",
                    tracker_id=tracker_id,
                )
                wait = say(
                    "Wait until {tracker_id} is tracking again, then end tracking.", tracker_id=tracker_id
                )
                yield Reason("follows_the_clock", text, stop if activity is ActivityName.FAULTED else wait)
            case _:
                pass
