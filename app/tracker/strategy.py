"""When a tracker moves, as an engineer sets it: a sum type, one kind a strategy."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from app.tracker.programs.stepped import StepProgram

LONGEST_INTERVAL_MIN = 240


class IntervalAim(StrEnum):
    """Where a tracker goes at the beginning of an interval."""

    MIDDLE = "middle"
    NOW = "now"


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

    counts: int = 10
    counts_per_turn: int = 3600
    kind: Literal["encoder-deadband"] = "encoder-deadband"

    def __post_init__(self) -> None:
        if not 1 <= self.counts_per_turn <= 10_000_000:
            raise ValueError("An encoder has between 1 and 10,000,000 counts a turn.")
        if self.counts < 1 or not 0.02 <= self.band_deg <= 10.0:
            raise ValueError(
                "The deadband in counts must be worth between 0.02 and 10 degrees, not "
                f"{self.band_deg:g} (360 degrees times counts, divided by counts a turn)."
            )

    @property
    def band_deg(self) -> float:
        """Return what the deadband is worth, degrees of an axis."""
        return 360.0 * self.counts / self.counts_per_turn


@dataclass(frozen=True, slots=True)
class Interval:
    """A move every so many minutes from midnight UTC on: to the sun in the interval's middle, or now."""

    minutes: int = 10
    aim: IntervalAim = IntervalAim.MIDDLE
    kind: Literal["interval"] = "interval"

    def __post_init__(self) -> None:
        if not 1 <= self.minutes <= LONGEST_INTERVAL_MIN:
            raise ValueError(f"An interval lasts between 1 and {LONGEST_INTERVAL_MIN} minutes.")


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

    azimuth_deg: float = 0.0
    elevation_deg: float = 0.0
    cloud: float = 0.0

    def __post_init__(self) -> None:
        if not max(abs(self.azimuth_deg), abs(self.elevation_deg)) <= 10.0:
            raise ValueError("The simulated misalignment must lie between -10 and 10 degrees.")
        if not 0.0 <= self.cloud <= 1.0:
            raise ValueError("A cloud blocks a share between 0 and 1 of the direct irradiance.")


CLEAR = SimulatedLight()


@dataclass(frozen=True, slots=True)
class HybridConfig:
    """How photo-sensor pairs correct the computed position; off unless `enabled`.

    While both sensors of a pair see at least `threshold_wm2`, the axis's correction changes by `gain_dps`
    degrees a second times (higher - lower) / (higher + lower), within +-`bound_deg`. In less light it falls
    to zero with the time constant `decay_s`, or stays as it is where that is 0.
    """

    enabled: bool = False
    threshold_wm2: float = 150.0
    gain_dps: float = 1.0
    bound_deg: float = 2.0
    decay_s: float = 900.0
    simulated: SimulatedLight = CLEAR

    def __post_init__(self) -> None:
        if not 1.0 <= self.threshold_wm2 <= 2000.0:
            raise ValueError("The irradiance threshold must lie between 1 and 2000 W/m2.")
        if not 0.001 <= self.gain_dps <= 10.0:
            raise ValueError("The gain of the correction must lie between 0.001 and 10 degrees a second.")
        if not 0.01 <= self.bound_deg <= 10.0:
            raise ValueError("The correction limit must lie between 0.01 and 10 degrees.")
        if not 0.0 <= self.decay_s <= 86_400.0:
            raise ValueError("The decay time constant must lie between 0 and 86,400 seconds.")


NO_HYBRID = HybridConfig()
