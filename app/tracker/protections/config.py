"""What an engineer sets for the protections of one tracker."""

from dataclasses import dataclass
from math import isfinite

from app.tracker.protections.words import Facing, Reaction, StowName


def _check(name: str, value: float, low: float, high: float, unit: str) -> None:
    if not (isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} must lie between {low:g} and {high:g} {unit}.")


@dataclass(frozen=True, slots=True)
class WindProtection:
    """When the wind stows the panel, and when tracking goes on.

    A gust is the fastest wind of the last 3 s, the mean is over 10 minutes. Xia et al. stow at 17 m/s and go
    on after 10 minutes below it. `required` says that there is a sensor even if none was ever seen; what
    stands in for a bad one happens once it has been bad for `bad_after_s`.
    """

    enabled: bool = True
    gust_mps: float = 17.0
    mean_mps: float = 17.0
    hysteresis_mps: float = 0.0
    resume_after_s: float = 600.0
    required: bool = False
    bad: Reaction = Reaction.STOW
    bad_after_s: float = 60.0
    facing: Facing = Facing.ANYTHING

    def __post_init__(self) -> None:
        _check("The gust threshold", self.gust_mps, 1.0, 60.0, "m/s")
        _check("The mean wind threshold", self.mean_mps, 1.0, 60.0, "m/s")
        _check("The wind release hysteresis", self.hysteresis_mps, 0.0, 20.0, "m/s")
        _check("The wind release delay", self.resume_after_s, 10.0, 86_400.0, "s")
        _check("The wind sensor-fault delay", self.bad_after_s, 0.0, 3600.0, "s")
        if self.hysteresis_mps >= min(self.gust_mps, self.mean_mps):
            raise ValueError("The wind release hysteresis must be smaller than both wind thresholds.")


@dataclass(frozen=True, slots=True)
class SnowProtection:
    """When the panel is tipped to shed its snow: 4 kg for a minute, as Xia et al. have it."""

    enabled: bool = True
    load_kg: float = 4.0
    hold_s: float = 60.0
    hysteresis_kg: float = 0.0
    required: bool = False
    bad: Reaction = Reaction.WARN
    bad_after_s: float = 60.0

    def __post_init__(self) -> None:
        _check("The snow-stow threshold", self.load_kg, 0.1, 10_000.0, "kg")
        _check("The snow trigger delay", self.hold_s, 1.0, 86_400.0, "s")
        _check("The snow release hysteresis", self.hysteresis_kg, 0.0, 1000.0, "kg")
        _check("The snow sensor-fault delay", self.bad_after_s, 0.0, 3600.0, "s")
        if self.hysteresis_kg >= self.load_kg:
            raise ValueError("The snow release hysteresis must be smaller than the snow-stow threshold.")


@dataclass(frozen=True, slots=True)
class LightProtection:
    """When tracking is not worth moving for: too little light for 10 minutes, as Xia et al. have it."""

    enabled: bool = True
    threshold_wm2: float = 50.0
    hold_s: float = 600.0
    hysteresis_wm2: float = 10.0
    required: bool = False
    bad: Reaction = Reaction.WARN
    bad_after_s: float = 60.0

    def __post_init__(self) -> None:
        _check("The low-light threshold", self.threshold_wm2, 0.1, 1000.0, "W/m2")
        _check("The low-light trigger delay", self.hold_s, 1.0, 86_400.0, "s")
        _check("The low-light release hysteresis", self.hysteresis_wm2, 0.0, 500.0, "W/m2")
        _check("The irradiance sensor-fault delay", self.bad_after_s, 0.0, 3600.0, "s")
        if self.bad is Reaction.STOW:
            raise ValueError("A faulty irradiance sensor cannot cause a stow: choose ignore, warn, or hold.")


@dataclass(frozen=True, slots=True)
class StowPlace:
    """Where the panel is stowed, the direction of its normal: 90 degrees is a level panel, 0 an upright one.

    Without an azimuth the panel keeps the one it has.
    """

    elevation_deg: float
    azimuth_deg: float | None = None

    def __post_init__(self) -> None:
        _check("The elevation of a stow position", self.elevation_deg, 0.0, 90.0, "degrees")
        if self.azimuth_deg is not None:
            _check("The azimuth of a stow position", self.azimuth_deg, 0.0, 360.0, "degrees")


@dataclass(frozen=True, slots=True)
class Stows:
    """The stow positions by name; level against wind and upright against snow, as Xia et al. have it."""

    wind: StowPlace = StowPlace(90.0)
    snow: StowPlace = StowPlace(0.0)
    hail: StowPlace = StowPlace(15.0)
    cleaning: StowPlace = StowPlace(30.0)
    maintenance: StowPlace = StowPlace(90.0)

    def place(self, name: StowName) -> StowPlace:
        """Return one position by its name; the park position is not among them."""
        return {
            StowName.WIND: self.wind,
            StowName.SNOW: self.snow,
            StowName.HAIL: self.hail,
            StowName.CLEANING: self.cleaning,
            StowName.MAINTENANCE: self.maintenance,
        }[name]


@dataclass(frozen=True, slots=True)
class ProtectionConfig:
    """The protections of one tracker, and the warning before a motion nobody at the machine asked for."""

    wind: WindProtection = WindProtection()
    snow: SnowProtection = SnowProtection()
    light: LightProtection = LightProtection()
    stows: Stows = Stows()
    warning_s: float = 5.0

    def __post_init__(self) -> None:
        _check("The warning time", self.warning_s, 0.0, 60.0, "s")


PROTECTED = ProtectionConfig()
