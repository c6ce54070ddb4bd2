"""A step program: angles to hold from given times of the day on, as data.

Times are hours of the day: solar time (12 when the sun crosses the meridian, as C. Alexandru counts), or
clock time at a fixed distance from UTC, without summer time. Angles are degrees of the program's frame: a
direction of the sky by azimuth (clockwise from north) and elevation, the same direction by hour angle
(positive after noon, so that it grows with the time) and declination, or the mount's own two axis angles.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise
from math import isfinite

HOURS_A_DAY = 24.0
MOST_STEPS = 288
LONGEST_NAME = 80
LARGEST_OFFSET_H = 14.0


class TimeBase(StrEnum):
    """Which time of the day a program goes by."""

    SOLAR = "solar"
    CLOCK = "clock"


class StepFrame(StrEnum):
    """What the two angles of a step are."""

    HORIZON = "horizon"
    EQUATOR = "equator"
    AXES = "axes"


ANGLES = {
    StepFrame.HORIZON: ("azimuth", "elevation"),
    StepFrame.EQUATOR: ("hour angle", "declination"),
    StepFrame.AXES: ("first axis", "second axis"),
}
RANGES_DEG = {
    StepFrame.HORIZON: ((0.0, 360.0), (-10.0, 180.0)),
    StepFrame.EQUATOR: ((-180.0, 180.0), (-90.0, 90.0)),
    StepFrame.AXES: ((-360.0, 720.0), (-360.0, 360.0)),
}


@dataclass(frozen=True, slots=True)
class ProgramStep:
    """From `from_h` on, hold these angles; None: this angle goes on following the tracker's mode."""

    from_h: float
    first_deg: float | None = None
    second_deg: float | None = None


@dataclass(frozen=True, slots=True)
class StepProgram:
    """Steps of one day in order of time; before the first step the panel waits in the first step's place.

    `utc_offset_h` counts only for clock time: hours that the clock is ahead of UTC. Raises `ValueError` with
    every sentence that says what is wrong.
    """

    name: str
    steps: tuple[ProgramStep, ...]
    frame: StepFrame = StepFrame.HORIZON
    time_base: TimeBase = TimeBase.SOLAR
    utc_offset_h: float = 0.0

    def __post_init__(self) -> None:
        wrong = program_errors(self)
        if wrong:
            raise ValueError(" ".join(wrong))

    @property
    def complete(self) -> bool:
        """Return whether every step gives both angles."""
        return all(None not in (step.first_deg, step.second_deg) for step in self.steps)

    def index_at(self, hour: float) -> int:
        """Return which step is held at a time of the day, hours; before the first step it is the first."""
        return max(0, bisect_right([step.from_h for step in self.steps], hour) - 1)

    def next_h(self, hour: float) -> float | None:
        """Return when the next step comes, hours of the day; None after the last."""
        return next((step.from_h for step in self.steps[1:] if step.from_h > hour), None)


def program_of(
    name: str,
    switch_times_h: Sequence[float],
    angles_deg: Sequence[float],
    *,
    second_deg: float | None = None,
    frame: StepFrame = StepFrame.EQUATOR,
    time_base: TimeBase = TimeBase.SOLAR,
) -> StepProgram:
    """Return the program that holds the first angle from midnight on and each further one from its switch on.

    There is one angle more than there are switch times. `second_deg` is the other angle, held all day. Raises
    `ValueError` with sentences if the result is no program.
    """
    if len(angles_deg) != len(switch_times_h) + 1:
        raise ValueError(
            f"{len(switch_times_h)} switch times lie between {len(switch_times_h) + 1} angles, "
            f"not {len(angles_deg)}."
        )
    times_h = (0.0, *switch_times_h)
    steps = tuple(
        ProgramStep(time_h, angle_deg, second_deg)
        for time_h, angle_deg in zip(times_h, angles_deg, strict=True)
    )
    return StepProgram(name, steps, frame, time_base)


def program_errors(program: StepProgram) -> tuple[str, ...]:
    """Return a sentence for everything that is wrong with a program, none for a sound one."""
    found = [*_head_errors(program)]
    for number, step in enumerate(program.steps, start=1):
        found += [f"Step {number}: {sentence}" for sentence in step_errors(step, program.frame)]
    for number, (before, after) in enumerate(pairwise(program.steps), start=2):
        if after.from_h <= before.from_h:
            found.append(
                f"Step {number} begins at {after.from_h:g} h, not after step {number - 1} at "
                f"{before.from_h:g} h. Put the steps in the order of their times."
            )
    return tuple(found)


def _head_errors(program: StepProgram) -> list[str]:
    found = []
    if not 1 <= len(program.name.strip()) <= LONGEST_NAME or not program.name.isprintable():
        found.append(f"Give the program a name of 1 to {LONGEST_NAME} printable characters.")
    if not 1 <= len(program.steps) <= MOST_STEPS:
        found.append(f"A program has 1 to {MOST_STEPS} steps, not {len(program.steps)}.")
    if not abs(program.utc_offset_h) <= LARGEST_OFFSET_H:
        found.append(
            f"The clock is between -{LARGEST_OFFSET_H:g} and {LARGEST_OFFSET_H:g} hours ahead of UTC."
        )
    return found


def step_errors(step: ProgramStep, frame: StepFrame) -> tuple[str, ...]:
    """Return a sentence for everything that is wrong with one step taken by itself."""
    found = []
    if not 0.0 <= step.from_h < HOURS_A_DAY:
        found.append("its time lies between 0 and 24 hours, 24 not included.")
    angles = (step.first_deg, step.second_deg)
    if angles == (None, None):
        found.append(f"give its {ANGLES[frame][0]}, its {ANGLES[frame][1]}, or both.")
    for name, angle_deg, (low_deg, high_deg) in zip(ANGLES[frame], angles, RANGES_DEG[frame], strict=True):
        if angle_deg is not None and not (isfinite(angle_deg) and low_deg <= angle_deg <= high_deg):
            found.append(f"its {name} lies between {low_deg:g} and {high_deg:g} degrees, not {angle_deg:g}.")
    return tuple(found)


def clock_text(hour: float) -> str:
    """Return a time of the day in hours as a clock shows it, to the minute: 7.88 is 07:53."""
    minutes = round(hour * 60.0)
    return f"{minutes // 60:02d}:{minutes % 60:02d}"
