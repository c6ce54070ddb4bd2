"""A plan made ready for one tracker: what the controller asks at every tick of a show."""

from bisect import bisect_right
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.sun.position import SunPosition, sun_position
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import AxisTarget, aim, mode_direction, second_axis, sky
from app.tracker.programs.pace import Night, Pace, Repositioning, pace, travel_s, underway_deg
from app.tracker.programs.path import EDGE_DEG, Stretch, sampled, stretches
from app.tracker.programs.plan import ShowPlan
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import Orientation, TrackerConfig

DELAY_S = 0.07
"""Half a period of 0.1 s, for which a set-point waits on average to be renewed, and the way to the drive."""


@dataclass(frozen=True, slots=True)
class ShowAim:
    """One instant of a show.

    `target` is where the panel should face now, sky degrees, and `axis_target` the axis angles for it.
    `axis_setpoint` is ahead of it by what a drive that decelerates towards its setpoint stays behind.
    `repositioning`: the axes are on their way (unwinding, keyhole, night) and the panel is not on the sun.
    """

    sun_time: datetime
    sun: SunPosition
    sun_is_up: bool
    target: Orientation
    axis_target: AxisTarget
    axis_setpoint: AxisTarget
    repositioning: bool


@dataclass(frozen=True, slots=True)
class _Place:
    """Axis angles on the course, and the speeds at which they change there."""

    target: AxisTarget
    azimuth_dps: float = 0.0
    elevation_dps: float = 0.0


class ShowCourse:
    """The course of one show on one tracker: made once, asked with `at` at every tick.

    `start` is where the panel stands at the beginning, axis degrees. Raises `InstantRefused` for a plan that
    ends before it starts or lies outside the years 1901 to 2099.
    """

    def __init__(self, plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing = Pointing()) -> None:
        self.plan = plan
        self._tracker = tracker
        self._pointing = pointing
        self._sampled = sampled(plan, tracker.mount, pointing)
        self._begins_s = [samples.begin_s for samples in self._sampled]
        self._zero_s = plan.begin_at.timestamp()
        self.stretches, self.pace = self.run_in(plan.duration.total_seconds())
        self._held = self._resting_place()
        self.start = Orientation(self._held.azimuth_deg, self._held.elevation_deg)

    def run_in(self, duration_s: float) -> tuple[tuple[Stretch, ...], Pace]:
        """Return what the same interval of sun asks of the axes when it is run in a duration."""
        acceleration = self.plan.span.total_seconds() / duration_s
        unwinding_s = travel_s(self._tracker.azimuth, 360.0) * acceleration
        path = stretches(self._sampled, self._tracker, unwinding_s)
        return path, pace(path, self._tracker, self._zero_s, acceleration, duration_s)

    def planned(self, elapsed_s: float) -> AxisTarget:
        """Return where the axes will be at an instant of the show, seconds of the drive's time."""
        target = self._place(elapsed_s).target
        for span in self.pace.repositionings:
            if span.begin_s <= elapsed_s < span.end_s:
                azimuth_deg = underway_deg(self._tracker.azimuth, span, elapsed_s)
                return AxisTarget(azimuth_deg, target.elevation_deg, target.limited)
        return target

    def at(self, elapsed: timedelta) -> ShowAim:
        """Return the sun, the target and the set-point after so much of the show has run."""
        elapsed_s = min(max(elapsed, timedelta(0)), self.plan.duration).total_seconds()
        sun_time = self.plan.sun_time(timedelta(seconds=elapsed_s))
        sun = sun_position(self.plan.algorithm, self.plan.location, sun_time)
        stretch = self._stretch_at(elapsed_s)
        place = self._place(elapsed_s)
        return ShowAim(
            sun_time=sun_time,
            sun=sun,
            sun_is_up=stretch is not None,
            target=self._direction(sun, place.target, following=stretch is not None),
            axis_target=place.target,
            axis_setpoint=self._lead(elapsed_s, place),
            repositioning=self._repositioning(elapsed_s),
        )

    def _direction(self, sun: SunPosition, target: AxisTarget, *, following: bool) -> Orientation:
        if following:
            refraction = self.plan.refraction
            mount = self._tracker.mount
            return mode_direction(
                self.plan.mode, self.plan.orientation, sun, refraction=refraction, mount=mount
            )
        return sky(self._tracker, self._pointing, target.azimuth_deg, target.elevation_deg)

    def _resting_place(self) -> AxisTarget:
        """Return the first direction of the first stretch; without any sun, the direction held."""
        if self.stretches:
            return _sample(self.stretches[0], 0)
        axis = self._tracker.azimuth
        middle_deg = (axis.minimum_deg + axis.maximum_deg) / 2.0
        return aim(self._tracker, self._pointing, self.plan.orientation, middle_deg)

    def _stretch_at(self, elapsed_s: float) -> Stretch | None:
        """Return the stretch of sun at an instant of the show, None while the sun is down."""
        unix_s = self._unix_s(elapsed_s)
        index = bisect_right(self._begins_s, unix_s) - 1
        if index < 0 or unix_s > self._sampled[index].end_s:
            return None
        return self.stretches[index]

    def _unix_s(self, elapsed_s: float) -> float:
        return self._zero_s + elapsed_s * self.plan.acceleration

    def _place(self, elapsed_s: float) -> _Place:
        """Return the planned axis angles: on the sun, at night where it set and then where it will rise."""
        unix_s = self._unix_s(elapsed_s)
        index = bisect_right(self._begins_s, unix_s) - 1
        if index < 0:
            return _Place(self._held)
        stretch = self.stretches[index]
        if unix_s <= stretch.samples.end_s:
            return _interpolate(stretch, self._tracker, unix_s, self.plan.acceleration)
        if index < len(self.pace.nights) and elapsed_s >= self.pace.nights[index].departs_s:
            return _Place(_sample(self.stretches[index + 1], 0))
        return _Place(_sample(stretch, -1))

    def _lead(self, elapsed_s: float, place: _Place) -> AxisTarget:
        """Return the set-point: each axis as far ahead as its deceleration from the planned speed takes."""
        azimuth_s = elapsed_s + lead_s(self._tracker.azimuth, place.azimuth_dps)
        elevation_s = elapsed_s + lead_s(second_axis(self._tracker), place.elevation_dps)
        last_s = self.plan.duration.total_seconds()
        azimuth = self._place(min(azimuth_s, last_s)).target
        elevation = self._place(min(elevation_s, last_s)).target
        limited = azimuth.limited or elevation.limited
        return AxisTarget(azimuth.azimuth_deg, elevation.elevation_deg, limited)

    def _repositioning(self, elapsed_s: float) -> bool:
        spans: tuple[Repositioning, ...] = self.pace.repositionings
        nights: tuple[Night, ...] = self.pace.nights
        return any(span.begin_s <= elapsed_s < span.end_s for span in spans) or any(
            night.departs_s <= elapsed_s < night.end_s for night in nights
        )


def lead_s(axis: AxisConfig, velocity_dps: float) -> float:
    """Return how far ahead of the target the set-point lies, seconds.

    A drive that brakes so that it can stop at its set-point runs v/(2a) behind it, and it learns of a new
    set-point a little later.
    """
    return min(abs(velocity_dps), axis.speed_dps) / (2.0 * axis.acceleration_dps2) + DELAY_S


def _sample(stretch: Stretch, index: int) -> AxisTarget:
    azimuth_deg, elevation_deg = stretch.azimuth_deg.item(index), stretch.elevation_deg.item(index)
    return AxisTarget(azimuth_deg, elevation_deg, stretch.missed_deg.item(index) > EDGE_DEG)


def _interpolate(stretch: Stretch, tracker: TrackerConfig, unix_s: float, acceleration: float) -> _Place:
    samples = stretch.samples
    step_s = samples.step_s
    steps = (unix_s - samples.begin_s) / step_s
    i = min(int(steps), len(stretch.turns) - 2)
    part = steps - i
    azimuth_deg, elevation_deg = samples.azimuth_deg.item(i), samples.elevation_deg.item(i)
    azimuth_step_deg = samples.azimuth_deg.item(i + 1) - azimuth_deg
    elevation_step_deg = samples.elevation_deg.item(i + 1) - elevation_deg
    azimuth_deg += part * azimuth_step_deg + 360.0 * stretch.turns.item(i)
    elevation_deg += part * elevation_step_deg
    azimuth_reached_deg = tracker.azimuth.clamp(azimuth_deg)
    elevation_reached_deg = second_axis(tracker).clamp(elevation_deg)
    missed_deg = max(abs(azimuth_reached_deg - azimuth_deg), abs(elevation_reached_deg - elevation_deg))
    target = AxisTarget(azimuth_reached_deg, elevation_reached_deg, missed_deg > EDGE_DEG)
    dps = acceleration / step_s
    return _Place(target, azimuth_step_deg * dps, elevation_step_deg * dps)
