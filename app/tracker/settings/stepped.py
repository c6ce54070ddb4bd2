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

from app.base.message import N_, join, say, with_format
from app.base.names import tidy, unseen

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
    StepFrame.EQUATOR: (N_("hour angle"), "declination"),
    StepFrame.AXES: (N_("first axis"), N_("second axis")),
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
            raise ValueError(join(" ", wrong))

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
            say(
                "{switch_times_h} switch times lie between {switch_times_h2} angles, not {angles_deg}.",
                switch_times_h=len(switch_times_h),
                switch_times_h2=len(switch_times_h) + 1,
                angles_deg=len(angles_deg),
            )
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
        found += [
            say("Step {number}: {sentence}", number=number, sentence=sentence)
            for sentence in step_errors(step, program.frame)
        ]
    for number, (before, after) in enumerate(pairwise(program.steps), start=2):
        if after.from_h <= before.from_h:
            found.append(
                say(
                    "Step {number} begins at {from_h} h, not after step {number2} at {from_h2} h. Put "
                    "the steps in the order of their times.",
                    number=number,
                    from_h=with_format(after.from_h, "g"),
                    number2=number - 1,
                    from_h2=with_format(before.from_h, "g"),
                )
            )
    return tuple(found)


def _head_errors(program: StepProgram) -> list[str]:
    found: list[str] = []
    name = tidy(program.name)
    if fault := unseen(name):
        found.append(fault)
    elif not 1 <= len(name) <= LONGEST_NAME:
        found.append(
            say(
                "Give the program a name of 1 to {longest_name} printable characters.",
                longest_name=LONGEST_NAME,
            )
        )
    if not 1 <= len(program.steps) <= MOST_STEPS:
        found.append(
            say(
                "A program has 1 to {most_steps} steps, not {steps}.",
                most_steps=MOST_STEPS,
                steps=len(program.steps),
            )
        )
    if not abs(program.utc_offset_h) <= LARGEST_OFFSET_H:
        found.append(
            say(
                "The clock is between -{largest_offset_h} and {largest_offset_h2} hours ahead of UTC.",
                largest_offset_h=with_format(LARGEST_OFFSET_H, "g"),
                largest_offset_h2=with_format(LARGEST_OFFSET_H, "g"),
            )
        )
    return found


def step_errors(step: ProgramStep, frame: StepFrame) -> tuple[str, ...]:
    """Return a sentence for everything that is wrong with one step taken by itself."""
    found: list[str] = []
    if not 0.0 <= step.from_h < HOURS_A_DAY:
        found.append(N_("its time lies between 0 and 24 hours, 24 not included."))
    angles = (step.first_deg, step.second_deg)
    if angles == (None, None):
        found.append(
            say(
                "give its {angles}, its {angles2}, or both.",
                angles=ANGLES[frame][0],
                angles2=ANGLES[frame][1],
            )
        )
    for name, angle_deg, (low_deg, high_deg) in zip(ANGLES[frame], angles, RANGES_DEG[frame], strict=True):
        if angle_deg is not None and not (isfinite(angle_deg) and low_deg <= angle_deg <= high_deg):
            found.append(
                say(
                    "its {name} lies between {low_deg} and {high_deg} degrees, not {angle_deg}.",
                    name=name,
                    low_deg=with_format(low_deg, "g"),
                    high_deg=with_format(high_deg, "g"),
                    angle_deg=with_format(angle_deg, "g"),
                )
            )
    return tuple(found)


def clock_text(hour: float) -> str:
    """Return a time of the day in hours as a clock shows it, to the minute: 7.88 is 07:53."""
    minutes = round(hour * 60.0)
    return f"{minutes // 60:02d}:{minutes % 60:02d}"
