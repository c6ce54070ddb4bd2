"""Whether a tracker can run a show whose panel stands still between the moves of a schedule."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta

from app.base.message import N_, say
from app.tracker.memory.memory import Pointing
from app.tracker.programs.path import sun_up
from app.tracker.programs.plan import ShowCheck, ShowPlan
from app.tracker.programs.schedule_course import ScheduleCourse
from app.tracker.programs.show_check import (
    LONGEST_DURATION,
    SHORTEST_DURATION,
    duration_reasons,
    impossible_reasons,
    planned_path,
    spell,
    sun_reasons,
    unchecked,
)
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.strategy import Schedule
from app.tracker.values.reason import Reason


def check_schedule(
    plan: ShowPlan, schedule: Schedule, tracker: TrackerConfig, pointing: Pointing
) -> ShowCheck:
    """Return what the plan needs of this tracker; between moves no speed is asked of the axes."""
    wrong = tuple(impossible_reasons(plan, tracker))
    if wrong:
        return unchecked(plan, wrong)
    duration = min(max(plan.duration, SHORTEST_DURATION), LONGEST_DURATION)
    course = ScheduleCourse(replace(plan, duration=duration), schedule, tracker, pointing)
    up = sun_up(plan)
    refused = tuple(sun_reasons(plan, lit=bool(up)))
    needed = max(SHORTEST_DURATION, timedelta(seconds=course.shortest_s()))
    shortest = None if refused or needed > LONGEST_DURATION else needed
    late = tuple(_late_reasons(needed, duration, shortest))
    return ShowCheck(
        reasons=(*duration_reasons(plan), *refused, *late),
        notices=tuple(_notices(course)),
        shortest=shortest,
        sun_up=up,
        peak_azimuth_dps=tracker.azimuth.speed_dps if len(course.places) > 1 else 0.0,
        peak_elevation_dps=tracker.elevation.speed_dps if len(course.places) > 1 else 0.0,
        start=course.start,
        path=planned_path(course, tracker, pointing),
    )


def _late_reasons(needed: timedelta, duration: timedelta, shortest: timedelta | None) -> Iterator[Reason]:
    if duration >= needed:
        return
    hint = (
        say("The shortest simulation time that works is {shortest}.", shortest=spell(shortest))
        if shortest
        else N_("No simulation time up to 24 hours works: choose another interval.")
    )
    yield Reason(
        "moves_too_long",
        N_("The show is too fast: a move would not be done before the next one begins."),
        hint,
    )


def _notices(course: ScheduleCourse) -> Iterator[Reason]:
    moves = len(course.places) - 1
    yield Reason(
        "stepped",
        say(
            "The panel is at standstill between {moves} moves, as the strategy of this tracker requires.",
            moves=moves,
        ),
    )
    if any(place.aimed.target.limited for place in course.places):
        yield Reason(
            "limited",
            N_("Some positions are beyond the soft limits; the panel stays as near as the limits allow."),
        )
