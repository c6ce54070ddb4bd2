"""In how long a show is usually run: the shortest of a few round lengths in which this tracker can do it."""

from dataclasses import dataclass, replace
from datetime import timedelta

from app.base.message import Message, say
from app.tracker.memory.memory import Pointing
from app.tracker.programs.plan import ShowCheck, ShowPlan
from app.tracker.programs.show import check_show
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.values.reason import Reason

MINUTES = (3, 5, 10, 15, 20, 30, 45, 60, 90, 120, 180, 240, 360, 480, 720, 1440)
NORTH_DEG, SOUTH_DEG = 0.0, 180.0


@dataclass(frozen=True, slots=True)
class UsualShow:
    """A plan in the length that it is usually run in, its check, and why it takes longer than most shows."""

    plan: ShowPlan
    check: ShowCheck
    longer: Reason | None = None


def in_usual_time(plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing = Pointing()) -> UsualShow:
    """Return the plan in the shortest usual length that works, in the first of them where none does."""
    first = _lasting(plan, timedelta(minutes=MINUTES[0]))
    check = check_show(first, tracker, pointing)
    if check.feasible or check.shortest is None:
        return UsualShow(first, check)
    why = _why_longer(check, tracker)
    for minutes in MINUTES[1:]:
        longer = _lasting(plan, timedelta(minutes=minutes))
        if longer.duration >= check.shortest and (found := check_show(longer, tracker, pointing)).feasible:
            return UsualShow(longer, found, why)
    exact = _lasting(plan, check.shortest)
    return UsualShow(exact, check_show(exact, tracker, pointing), why)


def _lasting(plan: ShowPlan, duration: timedelta) -> ShowPlan:
    return replace(plan, duration=duration)


def _why_longer(check: ShowCheck, tracker: TrackerConfig) -> Reason:
    """Return in one sentence why the first of the usual lengths does not do, for who only wants to look."""
    code, minutes = check.reasons[0].code, MINUTES[0]
    text = say("{minutes} minutes are too short here: the axes cannot turn that fast.", minutes=minutes)
    if code == "repositioning_too_long":
        text = _turning(check, tracker, minutes)
    elif code == "night_too_short":
        text = say(
            "{minutes} minutes are too short here: travel to the next sunrise takes longer than the night.",
            minutes=minutes,
        )
    elif code == "moves_too_long":
        text = say(
            "{minutes} minutes are too short here: a move must finish before the next one begins.",
            minutes=minutes,
        )
    return Reason(code, text)


def _turning(check: ShowCheck, tracker: TrackerConfig, minutes: int) -> Message:
    """Return where the first axis loses the sun, as one says it who stands before the tracker."""
    axis = tracker.azimuth
    if not any(notice.code == "unwinding" for notice in check.notices):
        return say(
            "{minutes} minutes are too short here: the panel must swing around where the sun is highest.",
            minutes=minutes,
        )
    if tracker.mount.kind is MountKind.AZIMUTH_ELEVATION and axis.maximum_deg - axis.minimum_deg == 360.0:
        if axis.minimum_deg % 360.0 == NORTH_DEG:
            return say(
                "{minutes} minutes are too short here: the panel must turn back at north.", minutes=minutes
            )
        if axis.minimum_deg % 360.0 == SOUTH_DEG:
            return say(
                "{minutes} minutes are too short here: the panel must turn back at south.", minutes=minutes
            )
    return say(
        "{minutes} minutes are too short here: the panel must turn back at its end stop.", minutes=minutes
    )
