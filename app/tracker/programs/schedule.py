"""Strategies that go by the time alone: where the panel faces at an instant, wherever it stands before."""

from datetime import UTC, datetime, timedelta
from math import asin, atan2, cos, degrees, hypot, radians, sin
from typing import NamedTuple, assert_never

from app.base.angles import wrap360
from app.sun.events import hour_angle_deg
from app.sun.position import InstantRefused, Location, SunPosition, sun_position
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import AxisTarget, aim, mode_direction, second_axis, sky
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.stepped import HOURS_A_DAY, ProgramStep, StepFrame, StepProgram, TimeBase
from app.tracker.settings.strategy import Interval, IntervalAim, Schedule, Stepped
from app.tracker.values.mode import Mode

HOUR_DEG = 15.0
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


class Moment(NamedTuple):
    """An instant at a place, with the sun there and then."""

    at: datetime
    sun: SunPosition
    location: Location


class Followed(NamedTuple):
    """What a tracker follows, and how its panel is mounted."""

    config: TrackerConfig
    pointing: Pointing
    mode: Mode
    held: Orientation

    def direction(self, sun: SunPosition) -> Orientation:
        """Return where the panel faces if it follows the sun itself."""
        config = self.config
        return mode_direction(self.mode, self.held, sun, refraction=config.refraction, mount=config.mount)


class Aimed(NamedTuple):
    """A direction of the sky, and the axis angles at which the panel faces it, as nearly as it can."""

    direction: Orientation
    target: AxisTarget


def aimed(followed: Followed, direction: Orientation, near_deg: float) -> Aimed:
    """Return a direction with the axis angles for it; `near_deg` is where the azimuth axis stands."""
    return Aimed(direction, aim(followed.config, followed.pointing, direction, near_deg))


def scheduled(schedule: Schedule, followed: Followed, moment: Moment, near_deg: float) -> Aimed:
    """Return where the panel faces by a schedule."""
    match schedule:
        case Interval():
            return aimed(followed, followed.direction(_aimed_sun(schedule, followed, moment)), near_deg)
        case Stepped(program):
            hour = hour_of(program, moment)
            return stepped(program.steps[program.index_at(hour)], program.frame, followed, moment, near_deg)
    assert_never(schedule)


def scheduled_dawn(
    schedule: Schedule, followed: Followed, moment: Moment, dawn: SunPosition, near_deg: float
) -> Aimed:
    """Return where the panel waits for the next sunrise."""
    match schedule:
        case Interval():
            return aimed(followed, followed.direction(dawn), near_deg)
        case Stepped(program):
            rising = Moment(moment.at, dawn, moment.location)
            ahead_h = solar_hour(rising) - solar_hour(moment)
            step = program.steps[program.index_at((hour_of(program, moment) + ahead_h) % HOURS_A_DAY)]
            return stepped(step, program.frame, followed, rising, near_deg)
    assert_never(schedule)


def hour_of(program: StepProgram, moment: Moment) -> float:
    """Return the time of the day that a program goes by, hours in [0, 24)."""
    match program.time_base:
        case TimeBase.SOLAR:
            return solar_hour(moment)
        case TimeBase.CLOCK:
            utc_h = (moment.at - EPOCH) / timedelta(hours=1)
            return (utc_h + program.utc_offset_h) % HOURS_A_DAY
    assert_never(program.time_base)


def solar_hour(moment: Moment) -> float:
    """Return apparent solar time, hours in [0, 24): 12 when the sun crosses the meridian."""
    return (12.0 + hour_angle_deg(moment.location, moment.sun) / HOUR_DEG) % HOURS_A_DAY


def stepped(
    step: ProgramStep, frame: StepFrame, followed: Followed, moment: Moment, near_deg: float
) -> Aimed:
    """Return where a step has the panel face; an angle that it does not give follows the mode."""
    direction = followed.direction(moment.sun)
    match frame:
        case StepFrame.HORIZON:
            return aimed(followed, _filled(step, direction), near_deg)
        case StepFrame.EQUATOR:
            hour_angle, declination = equatorial(moment.location, direction)
            given = _filled(step, Orientation(hour_angle, declination))
            level = horizontal(moment.location, given.azimuth_deg, given.elevation_deg)
            return aimed(followed, level, near_deg)
        case StepFrame.AXES:
            return _on_axes(step, followed, direction, near_deg)
    assert_never(frame)


def equatorial(location: Location, direction: Orientation) -> tuple[float, float]:
    """Return hour angle (positive after noon, -180 to 180) and declination of a direction, degrees."""
    latitude, elevation = radians(location.latitude_deg), radians(direction.elevation_deg)
    azimuth = radians(direction.azimuth_deg)
    north, up = cos(elevation) * cos(azimuth), sin(elevation)
    west = -cos(elevation) * sin(azimuth)
    equator = up * cos(latitude) - north * sin(latitude)
    pole = up * sin(latitude) + north * cos(latitude)
    return degrees(atan2(west, equator)), degrees(asin(min(1.0, max(-1.0, pole))))


def horizontal(location: Location, hour_angle_deg: float, declination_deg: float) -> Orientation:
    """Return the direction of the sky with an hour angle and a declination: the inverse of `equatorial`."""
    latitude = radians(location.latitude_deg)
    hour_angle, declination = radians(hour_angle_deg), radians(declination_deg)
    west, equator = cos(declination) * sin(hour_angle), cos(declination) * cos(hour_angle)
    pole = sin(declination)
    north = pole * cos(latitude) - equator * sin(latitude)
    up = pole * sin(latitude) + equator * cos(latitude)
    azimuth_deg = wrap360(degrees(atan2(-west, north)))
    return Orientation(azimuth_deg, degrees(atan2(up, hypot(west, north))))


def _aimed_sun(schedule: Interval, followed: Followed, moment: Moment) -> SunPosition:
    """Return the sun at the instant for which the present interval's place is chosen."""
    length = timedelta(minutes=schedule.minutes)
    begun = EPOCH + (moment.at - EPOCH) // length * length
    aimed_at = begun + length / 2 if schedule.aim is IntervalAim.MIDDLE else begun
    try:
        return sun_position(followed.config.algorithm, moment.location, aimed_at)
    except InstantRefused:
        return moment.sun


def _filled(step: ProgramStep, followed: Orientation) -> Orientation:
    first_deg = followed.azimuth_deg if step.first_deg is None else step.first_deg
    second_deg = followed.elevation_deg if step.second_deg is None else step.second_deg
    return Orientation(first_deg, second_deg)


def _on_axes(step: ProgramStep, followed: Followed, direction: Orientation, near_deg: float) -> Aimed:
    config, pointing = followed.config, followed.pointing
    reached = aim(config, pointing, direction, near_deg)
    wanted = _filled(step, Orientation(reached.azimuth_deg, reached.elevation_deg))
    first_deg = config.azimuth.clamp(wanted.azimuth_deg)
    second_deg = second_axis(config).clamp(wanted.elevation_deg)
    limited = (first_deg, second_deg) != (wanted.azimuth_deg, wanted.elevation_deg)
    return Aimed(
        sky(config, pointing, first_deg, second_deg),
        AxisTarget(first_deg, second_deg, limited or (reached.limited and None in _given(step))),
    )


def _given(step: ProgramStep) -> tuple[float | None, float | None]:
    return step.first_deg, step.second_deg
