"""What forbids another location: settings that are locked, and trackers that follow the sun."""

from collections.abc import Mapping

from app.base.message import say
from app.tracker.access.local_locks import locked_settings
from app.tracker.memory.memory import TrackerState
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.reason import Reason

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
