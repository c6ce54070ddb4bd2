"""When a tracker moves, as an engineer sets it: a sum type, one kind a strategy."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Literal

from annotated_types import Ge, Le

from app.base.message import N_, say, with_format
from app.tracker.settings.declared import Setting, check
from app.tracker.settings.stepped import StepProgram

LONGEST_INTERVAL_MIN = 240
LEAST_DEADBAND_DEG, MOST_DEADBAND_DEG = 0.02, 10.0


class IntervalAim(StrEnum):
    """Where a tracker goes at the beginning of an interval."""

    MIDDLE = "middle"
    NOW = "now"


AIMS = (
    (IntervalAim.MIDDLE.value, N_("half an interval ahead")),
    (IntervalAim.NOW.value, N_("to the current sun position")),
)


@dataclass(frozen=True, slots=True)
class Continuous:
    """The set-point follows the sun at every tick."""

    kind: Literal["continuous"] = "continuous"


@dataclass(frozen=True, slots=True)
class Deadband:
    """Both axes run to the sun before the panel is off by more than `TrackerConfig.deadband_deg`."""

    kind: Literal["deadband"] = "deadband"


@dataclass(frozen=True, slots=True)
class EncoderDeadband:
    """Each axis by itself, in encoder counts: off by `counts` it runs until it is off by none.

    As L. Xia et al. have it: 10 counts at 3600 counts a turn are one degree.
    """

    counts: Annotated[
        int,
        Ge(1),
        Le(1_000_000),
        Setting(N_("Deadband in counts"), help=N_("For counts; 10 of 3600 are 1°.")),
    ] = 10
    counts_per_turn: Annotated[int, Ge(1), Le(10_000_000), Setting(N_("Counts per axis turn"))] = 3600
    kind: Literal["encoder-deadband"] = "encoder-deadband"

    def __post_init__(self) -> None:
        check(self)
        if not LEAST_DEADBAND_DEG <= self.band_deg <= MOST_DEADBAND_DEG:
            raise ValueError(
                say(
                    "The deadband in counts must be worth between {least_deadband_deg} and "
                    "{most_deadband_deg} degrees, not {band_deg} "
                    "(360 degrees times counts, divided by counts a turn).",
                    least_deadband_deg=with_format(LEAST_DEADBAND_DEG, "g"),
                    most_deadband_deg=with_format(MOST_DEADBAND_DEG, "g"),
                    band_deg=with_format(self.band_deg, "g"),
                )
            )

    @property
    def band_deg(self) -> float:
        """Return what the deadband is worth, degrees of an axis."""
        return 360.0 * self.counts / self.counts_per_turn


@dataclass(frozen=True, slots=True)
class Interval:
    """A move every so many minutes from midnight UTC on: to the sun in the interval's middle, or now."""

    minutes: Annotated[
        int, Ge(1), Le(LONGEST_INTERVAL_MIN), Setting(N_("Interval"), "min", help=N_("For Interval."))
    ] = 10
    aim: Annotated[
        IntervalAim,
        Setting(
            N_("Move target"),
            help=N_("For Interval: the expected position of the sun. Usual: the middle."),
            choices=AIMS,
        ),
    ] = IntervalAim.MIDDLE
    kind: Literal["interval"] = "interval"

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, slots=True)
class Stepped:
    """The angles of a program, each from its time of the day on."""

    program: StepProgram
    kind: Literal["stepped"] = "stepped"


Strategy = Continuous | Deadband | EncoderDeadband | Interval | Stepped
Schedule = Interval | Stepped
SCHEDULES = (Interval, Stepped)
"""Strategies that go by the time alone: where the panel faces does not depend on where it stands."""
DEADBAND = Deadband()


@dataclass(frozen=True, slots=True)
class SimulatedLight:
    """What a simulated drive plays to its photo-sensors: how far the panel is misaligned, and a cloud.

    `cloud` is the share of the direct light that it takes, from 0 to 1. A real drive has no use for it.
    """

    azimuth_deg: Annotated[
        float, Ge(-10), Le(10), Setting(N_("Azimuth misalignment"), "°", help=N_("For tests."))
    ] = 0.0
    elevation_deg: Annotated[
        float, Ge(-10), Le(10), Setting(N_("Elevation misalignment"), "°", help=N_("For tests."))
    ] = 0.0
    cloud: Annotated[
        float,
        Ge(0),
        Le(1),
        Setting(N_("Cloud attenuation"), help=N_("Share of the direct light, from 0 to 1.")),
    ] = 0.0

    def __post_init__(self) -> None:
        check(self)


CLEAR = SimulatedLight()


@dataclass(frozen=True, slots=True)
class HybridConfig:
    """How photo-sensor pairs correct the computed position; off unless `enabled`.

    While both sensors of a pair see at least `threshold_wm2`, the axis's correction changes by `gain_dps`
    degrees a second times (higher - lower) / (higher + lower), within +-`bound_deg`. In less light it falls
    to zero with the time constant `decay_s`, or stays as it is where that is 0.
    """

    enabled: Annotated[bool, Setting(N_("Correct the computed position"))] = False
    threshold_wm2: Annotated[
        float,
        Ge(1),
        Le(2000),
        Setting(N_("Irradiance threshold"), "W/m²", help=N_("No correction below this irradiance.")),
    ] = 150.0
    gain_dps: Annotated[
        float,
        Ge(0.001),
        Le(10),
        Setting(N_("Gain"), "°/s", help=N_("Rate at a difference equal to the sum.")),
    ] = 1.0
    bound_deg: Annotated[
        float, Ge(0.01), Le(10), Setting(N_("Correction limit"), "°", help=N_("Largest correction."))
    ] = 2.0
    decay_s: Annotated[
        float, Ge(0), Le(86_400), Setting(N_("Decay time constant"), "s", help=N_("0 holds the correction."))
    ] = 900.0
    simulated: Annotated[SimulatedLight, Setting(N_("Simulated drive errors"))] = CLEAR

    def __post_init__(self) -> None:
        check(self)


NO_HYBRID = HybridConfig()
