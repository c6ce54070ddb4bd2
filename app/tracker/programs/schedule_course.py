"""A show of a strategy that goes by the time: the panel stands between moves, as it does on a real day."""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, timedelta
from itertools import pairwise
from math import ceil

from app.sun.position import sun_position
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import AxisTarget, second_axis
from app.tracker.programs.pace import SETTLE_S, travel_s
from app.tracker.programs.path import sun_up
from app.tracker.programs.plan import ShowPlan
from app.tracker.programs.schedule import Aimed, Followed, Moment, scheduled
from app.tracker.programs.trajectory import ShowAim
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.strategy import Schedule

SAMPLE = timedelta(seconds=60)
STILL_DEG = 0.05
BISECTIONS = 10


@dataclass(frozen=True, slots=True)
class Place:
    """Where the panel stands from an instant of sun time on, seconds since the show's first instant."""

    from_s: float
    aimed: Aimed


class ScheduleCourse:
    """The course of a show with a schedule: made once, asked with `at` at every tick.

    While the sun is down the panel waits in its place of the next sunrise, or of the last sunset.
    """

    def __init__(
        self, plan: ShowPlan, schedule: Schedule, tracker: TrackerConfig, pointing: Pointing = Pointing()
    ) -> None:
        self.plan = plan
        self._tracker = tracker
        self._followed = Followed(
            replace(tracker, algorithm=plan.algorithm, refraction=plan.refraction),
            pointing,
            plan.mode,
            plan.orientation,
        )
        self._schedule = schedule
        self.places = tuple(self._found())
        self._from_s = [place.from_s for place in self.places]
        first = self.places[0].aimed.target
        self.start = Orientation(first.azimuth_deg, first.elevation_deg)

    def planned(self, elapsed_s: float) -> AxisTarget:
        """Return the axis angles planned for an instant of the show, seconds of the drive's time."""
        return self._place(elapsed_s * self.plan.acceleration).target

    def at(self, elapsed: timedelta) -> ShowAim:
        """Return the sun and the place of the panel after so much of the show has run."""
        within = min(max(elapsed, timedelta(0)), self.plan.duration)
        sun_time = self.plan.sun_time(within)
        sun = sun_position(self.plan.algorithm, self.plan.location, sun_time)
        place = self._place((sun_time - self.plan.begin_at).total_seconds())
        return ShowAim(
            sun_time=sun_time,
            sun=sun,
            sun_is_up=sun.is_up,
            target=place.direction,
            axis_target=place.target,
            axis_setpoint=place.target,
            repositioning=False,
        )

    def shortest_s(self) -> float:
        """Return the least duration in which every move is done before the next begins, seconds."""
        whole_s = self.plan.span.total_seconds()
        needed_s = 0.0
        moves = pairwise(self.places)
        for (before, after), end_s in zip(moves, self._from_s[2:], strict=False):
            away_s = self._travel_s(before.aimed.target, after.aimed.target) + SETTLE_S
            needed_s = max(needed_s, away_s * whole_s / max(end_s - after.from_s, 1.0))
        return float(ceil(needed_s))

    def _place(self, sun_s: float) -> Aimed:
        return self.places[max(0, bisect_right(self._from_s, sun_s) - 1)].aimed

    def _travel_s(self, left: AxisTarget, right: AxisTarget) -> float:
        first_s = travel_s(self._tracker.azimuth, abs(right.azimuth_deg - left.azimuth_deg))
        second = second_axis(self._tracker)
        return max(first_s, travel_s(second, abs(right.elevation_deg - left.elevation_deg)))

    def _found(self) -> Iterator[Place]:
        """Yield the places in order of time, each found to a tenth of a second of sun time."""
        axis = self._tracker.azimuth
        near_deg = (axis.minimum_deg + axis.maximum_deg) / 2.0
        last: Aimed | None = None
        free_s = 0.0
        for begin, end in sun_up(self.plan):
            begin_s = (begin - self.plan.begin_at).total_seconds()
            end_s = (end - self.plan.begin_at).total_seconds()
            sample_s = begin_s
            while sample_s <= end_s:
                found = self._scheduled(sample_s, near_deg)
                if last is None or _differs(last, found):
                    from_s = free_s if sample_s == begin_s else self._changed_s(sample_s, last, near_deg)
                    yield Place(from_s, found)
                    last, near_deg = found, found.target.azimuth_deg
                sample_s += SAMPLE.total_seconds()
            free_s = end_s
        if last is None:
            yield Place(0.0, self._scheduled(0.0, near_deg))

    def _changed_s(self, after_s: float, last: Aimed | None, near_deg: float) -> float:
        """Return when within the minute before `after_s` the panel has to leave its last place."""
        low_s, high_s = after_s - SAMPLE.total_seconds(), after_s
        for _ in range(BISECTIONS):
            middle_s = (low_s + high_s) / 2.0
            same = last is not None and not _differs(last, self._scheduled(middle_s, near_deg))
            low_s, high_s = (middle_s, high_s) if same else (low_s, middle_s)
        return high_s

    def _scheduled(self, sun_s: float, near_deg: float) -> Aimed:
        at = self.plan.begin_at.astimezone(UTC) + timedelta(seconds=sun_s)
        sun = sun_position(self.plan.algorithm, self.plan.location, at)
        moment = Moment(at, sun, self.plan.location)
        return scheduled(self._schedule, self._followed, moment, near_deg)


def _differs(left: Aimed, right: Aimed) -> bool:
    first_deg = abs(left.target.azimuth_deg - right.target.azimuth_deg)
    return max(first_deg, abs(left.target.elevation_deg - right.target.elevation_deg)) > STILL_DEG
