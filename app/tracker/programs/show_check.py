"""Whether a tracker can run a show, and if not, why not and what would work."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import timedelta
from typing import Protocol

import numpy as np

from app.base.message import N_, Message, say, told_by, with_format
from app.sun.position import InstantRefused, sun_path, sun_position
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.capabilities import axis_title
from app.tracker.mounts.missing_axes import mode_absent
from app.tracker.mounts.mount import AxisTarget, second_axis, sky
from app.tracker.programs.pace import (
    REPOSITIONING_SHARE,
    Pace,
    Repositioning,
    feasible,
    usable_dps,
)
from app.tracker.programs.path import Stretch, sun_up
from app.tracker.programs.plan import ShowCheck, ShowPath, ShowPlan
from app.tracker.programs.trajectory import ShowCourse
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason

UPRIGHT_KINDS = (MountKind.AZIMUTH_ELEVATION, MountKind.VERTICAL_SINGLE_AXIS)
LONGEST_INTERVAL = timedelta(hours=48)
SHORTEST_DURATION = timedelta(seconds=10)
LONGEST_DURATION = timedelta(hours=24)
WHOLE_DAY = timedelta(hours=23)
"""So short is a civil day on which the clocks are set forward."""
PATH_POINTS = 721
EMPTY = np.empty(0)
NO_PATH = ShowPath(EMPTY, EMPTY, EMPTY, EMPTY, EMPTY, np.empty(0, dtype=np.bool_))


class PlannedCourse(Protocol):
    """A course that knows beforehand where the axes will be."""

    @property
    def plan(self) -> ShowPlan:
        """Return what is shown."""

    def planned(self, elapsed_s: float) -> AxisTarget:
        """Return the axis angles planned for an instant of the show."""


def check_show(plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing = Pointing()) -> ShowCheck:
    """Return what the plan needs of this tracker, every reason against it, and the shortest duration."""
    wrong = tuple(impossible_reasons(plan, tracker))
    if wrong:
        return unchecked(plan, wrong)
    duration = min(max(plan.duration, SHORTEST_DURATION), LONGEST_DURATION)
    course = ShowCourse(replace(plan, duration=duration), tracker, pointing)
    refused = tuple(sun_reasons(plan, lit=bool(course.stretches)))
    shortest = None if refused else _shortest(course, tracker)
    reasons = [*duration_reasons(plan), *refused, *_pace_reasons(course.pace, tracker, shortest)]
    return ShowCheck(
        reasons=tuple(reasons),
        notices=tuple(_notices(course, tracker)),
        shortest=shortest,
        sun_up=sun_up(plan),
        peak_azimuth_dps=course.pace.peak_azimuth_dps,
        peak_elevation_dps=course.pace.peak_elevation_dps,
        start=course.start,
        path=planned_path(course, tracker, pointing),
    )


def impossible_reasons(plan: ShowPlan, tracker: TrackerConfig) -> Iterator[Reason]:
    """Yield why there is nothing to check: an interval that makes no sense, a mode that the mount lacks."""
    yield from _interval_reasons(plan)
    impossible = mode_absent(tracker, plan.mode)
    if impossible is not None:
        yield impossible


def _interval_reasons(plan: ShowPlan) -> Iterator[Reason]:
    if plan.end_at <= plan.begin_at:
        yield Reason(
            "end_before_start",
            N_("The show ends before it starts."),
            N_("Choose an end time after the start time."),
        )
        return
    if plan.span > LONGEST_INTERVAL:
        yield Reason(
            "interval_too_long", N_("The show covers more than 48 hours."), N_("Choose an earlier end.")
        )
    try:
        for at in (plan.begin_at, plan.end_at):
            sun_position(plan.algorithm, plan.location, at)
    except InstantRefused as refused:
        yield Reason("year_out_of_range", told_by(refused), N_("Choose a date in the years 1901 to 2099."))


def duration_reasons(plan: ShowPlan) -> Iterator[Reason]:
    """Yield that a show would be too short or too long."""
    if plan.duration < SHORTEST_DURATION or plan.duration > LONGEST_DURATION:
        yield Reason(
            "duration_out_of_range",
            say(
                "A show takes between 10 seconds and 24 hours, not {duration}.", duration=spell(plan.duration)
            ),
            N_("Choose another simulation time."),
        )


def sun_reasons(plan: ShowPlan, *, lit: bool) -> Iterator[Reason]:
    """Yield that there is no sun to follow; `lit` says whether it is up at any time."""
    if not lit and plan.mode is not Mode.FIXED:
        if plan.span >= WHOLE_DAY:
            message = N_("It is polar night: on this day the sun does not rise here.")
            yield Reason("sun_never_up", message, N_("Choose a day with a sunrise."))
            return
        yield Reason(
            "sun_never_up",
            N_("The sun is below the horizon for the whole of the show."),
            N_("Choose a start and an end between which the sun is up."),
        )


def _pace_reasons(asked: Pace, tracker: TrackerConfig, shortest: timedelta | None) -> Iterator[Reason]:
    hint = (
        say("The shortest simulation time that works is {shortest}.", shortest=spell(shortest))
        if shortest
        else N_("No simulation time up to 24 hours works: choose another interval.")
    )
    for name, axis, peak_dps in (
        (Axis.AZIMUTH, tracker.azimuth, asked.peak_azimuth_dps),
        (Axis.ELEVATION, second_axis(tracker), asked.peak_elevation_dps),
    ):
        if peak_dps > usable_dps(axis, asked.duration_s):
            title = axis_title(tracker.mount, name)
            yield Reason(f"{name}_too_fast", _too_fast(title, axis, peak_dps, asked.duration_s), hint)
    if not asked.repositions_in_time:
        yield Reason(
            "repositioning_too_long", _too_long(asked, axis_title(tracker.mount, Axis.AZIMUTH)), hint
        )
    if not all(night.long_enough for night in asked.nights):
        message = N_("The night is too short for the axes to reach the position of the next sunrise in time.")
        yield Reason("night_too_short", message, hint)


def _too_fast(name: str, axis: AxisConfig, peak_dps: float, duration_s: float) -> Message:
    usable = usable_dps(axis, duration_s)
    return say(
        "The show is too fast: the {name} axis would have to turn at {peak_dps} degrees a "
        "second; it can follow at up to {usable} (rated {speed_dps}, less a reserve for "
        "acceleration).",
        name=name,
        peak_dps=with_format(peak_dps, ".2f"),
        usable=with_format(usable, ".2f"),
        speed_dps=with_format(axis.speed_dps, ".2f"),
    )


def _too_long(asked: Pace, title: str) -> Message:
    return say(
        "The {title} axis needs {repositioning_s} s to turn where it cannot follow the sun "
        "(end stop or zenith). This may take at most {repositioning_share} of the show, "
        "{repositioning_share2} s, and must finish before the end.",
        title=title,
        repositioning_s=with_format(asked.repositioning_s, ".0f"),
        repositioning_share=with_format(REPOSITIONING_SHARE, ".0%"),
        repositioning_share2=with_format(REPOSITIONING_SHARE * asked.duration_s, ".0f"),
    )


def _shortest(course: ShowCourse, tracker: TrackerConfig) -> timedelta | None:
    """Return the whole seconds at which the course becomes feasible, by bisection: a second less fails."""

    def works(duration_s: int) -> bool:
        return feasible(course.run_in(float(duration_s))[1], tracker)

    low, high = int(SHORTEST_DURATION.total_seconds()), int(LONGEST_DURATION.total_seconds())
    if not works(high):
        return None
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if works(middle) else (middle + 1, high)
    return timedelta(seconds=low)


def _notices(course: ShowCourse, tracker: TrackerConfig) -> Iterator[Reason]:
    for span in course.pace.repositionings:
        yield _repositioning_notice(course, span, tracker.mount)
    yield from _limit_notices(course.stretches, tracker)
    if course.plan.mode is Mode.FIXED:
        message = N_("The mode is Fixed: the panel does not move during the show.")
        yield Reason(
            "stands_still", message, N_("Choose another mode in step 4 to see the panel follow the sun.")
        )
    up = sum((end - begin for begin, end in sun_up(course.plan)), timedelta(0))
    down = course.plan.span - up
    if down >= timedelta(seconds=1):
        yield Reason(
            "sun_down",
            say(
                "The sun is below the horizon for {down} of the interval: there the panel holds, "
                "then moves to the position of the next sunrise in time.",
                down=spell(down),
            ),
        )


def _repositioning_notice(course: ShowCourse, span: Repositioning, mount: MountConfig) -> Reason:
    zone = course.plan.begin_at.tzinfo
    at = course.plan.sun_time(timedelta(seconds=span.begin_s)).astimezone(zone)
    seconds = span.end_s - span.begin_s
    lost = spell(timedelta(seconds=seconds * course.plan.acceleration))
    title = axis_title(mount, Axis.AZIMUTH)
    turn = say(
        "turns from {from_deg} to {to_deg} degrees",
        from_deg=with_format(span.from_deg, ".0f"),
        to_deg=with_format(span.to_deg, ".0f"),
    )
    if span.unwinding:
        code, why = (
            "unwinding",
            say(
                "the {title} axis reaches its end stop and {turn} in the opposite direction",
                title=title,
                turn=turn,
            ),
        )
    else:
        where = N_("zenith") if mount.kind in UPRIGHT_KINDS else N_("direction of the axis")
        code, why = (
            "keyhole",
            say(
                "the sun passes too near the {where} to follow and the {title} axis {turn}",
                where=where,
                title=title,
                turn=turn,
            ),
        )
    return Reason(
        code,
        say(
            "At {at} ({zone}) {why}: {seconds} s of the show, {lost} of sun time.",
            at=with_format(at, "%H:%M"),
            zone=zone,
            why=why,
            seconds=with_format(seconds, ".1f"),
            lost=lost,
        ),
    )


def _limit_notices(stretches: Sequence[Stretch], tracker: TrackerConfig) -> Iterator[Reason]:
    missed_deg = max((float(stretch.missed_deg.max()) for stretch in stretches), default=0.0)
    if missed_deg > tracker.deadband_deg:
        yield Reason(
            "limited",
            say(
                "The soft limits keep the panel up to {missed_deg} degrees away from its target; "
                "there the panel stays as near as the limits allow.",
                missed_deg=with_format(missed_deg, ".1f"),
            ),
        )


def planned_path(course: PlannedCourse, tracker: TrackerConfig, pointing: Pointing) -> ShowPath:
    """Return what is planned at equal steps of the show."""
    plan = course.plan
    elapsed_s = np.linspace(0.0, plan.duration.total_seconds(), PATH_POINTS)
    places = [_shown(tracker, pointing, course.planned(elapsed)) for elapsed in elapsed_s.tolist()]
    sun_time_unix_s = plan.begin_at.timestamp() + elapsed_s * plan.acceleration
    sun = sun_path(plan.algorithm, plan.location, sun_time_unix_s)
    return ShowPath(
        sun_time_unix_s=sun_time_unix_s,
        sun_azimuth_deg=sun.azimuth_deg,
        sun_elevation_deg=sun.apparent_elevation_deg if plan.refraction else sun.elevation_deg,
        panel_azimuth_deg=np.array([place.azimuth_deg for place in places]),
        panel_elevation_deg=np.array([place.elevation_deg for place in places]),
        sun_is_up=sun.is_up,
    )


def _shown(tracker: TrackerConfig, pointing: Pointing, place: AxisTarget) -> Orientation:
    """Return the axis angles of an azimuth-elevation mount, of others the direction that the panel faces."""
    if tracker.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return Orientation(place.azimuth_deg, place.elevation_deg)
    return sky(tracker, pointing, place.azimuth_deg, place.elevation_deg)


def unchecked(plan: ShowPlan, reasons: tuple[Reason, ...]) -> ShowCheck:
    """Return the check of a plan whose interval makes no sense: there is nothing to compute."""
    return ShowCheck(reasons, (), None, (), 0.0, 0.0, plan.orientation, NO_PATH)


def spell(length: timedelta) -> str:
    """Return a length of time in words: hours and minutes, minutes and seconds, or seconds."""
    seconds = round(length.total_seconds())
    minutes, hours = seconds // 60 % 60, seconds // 3600
    if hours:
        return say("{hours} h {minutes} min", hours=hours, minutes=minutes)
    return (
        say("{minutes} min {seconds} s", minutes=minutes, seconds=seconds % 60) if minutes else f"{seconds} s"
    )
