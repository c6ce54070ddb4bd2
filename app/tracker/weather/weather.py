"""What a weather station of the site measured, and how old that is."""

from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from datetime import datetime
from enum import StrEnum
from math import isfinite
from typing import assert_never

from app.base.message import N_, join, say, with_format, word
from app.tracker.values.reason import Reason

SIMULATED = "SIMULATED"
"""What the name of every made-up source begins with."""
RANGES = {
    "wind_mps": (N_("The wind speed"), 0.0, 120.0, "m/s"),
    "wind_direction_deg": (N_("The wind direction"), 0.0, 360.0, N_("degrees from north")),
    "irradiance_wm2": (N_("The irradiance"), 0.0, 2000.0, "W/m2"),
    "snow_kg": (N_("The snow-stow threshold"), 0.0, 100_000.0, "kg"),
    "snow_mm": (N_("The snow depth"), 0.0, 20_000.0, "mm"),
    "temperature_degc": (N_("The air temperature"), -90.0, 70.0, N_("degrees Celsius")),
    "humidity_pct": (N_("The relative humidity"), 0.0, 100.0, "percent"),
    "pressure_hpa": (N_("The air pressure"), 300.0, 1100.0, "hPa"),
    "rain_mm": (N_("The rain"), 0.0, 10_000.0, "mm"),
}


def is_possible(name: str, value: float) -> bool:
    """Return whether a station on Earth can have measured this value of a quantity."""
    _, low, high, _ = RANGES[name]
    return isfinite(value) and low <= value <= high


@dataclass(frozen=True, slots=True)
class Weather:
    """What one report of a station holds; None is what it does not measure.

    `wind_direction_deg` is where the wind comes from, clockwise from north; `snow_kg` the load on one panel,
    `snow_mm` the depth on the ground; `pressure_hpa` as the station reads it, not reduced to sea level;
    `rain_mm` what the station has counted. Raises `ValueError` with a sentence for every value that is no
    number or that no station on Earth can have measured.
    """

    wind_mps: float | None = None
    wind_direction_deg: float | None = None
    irradiance_wm2: float | None = None
    snow_kg: float | None = None
    snow_mm: float | None = None
    temperature_degc: float | None = None
    humidity_pct: float | None = None
    pressure_hpa: float | None = None
    rain_mm: float | None = None

    def __post_init__(self) -> None:
        wrong = tuple(self._wrong())
        if wrong:
            raise ValueError(join(" ", wrong))

    def _wrong(self) -> Iterator[str]:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        for name, value in values.items():
            title, low, high, unit = RANGES[name]
            if value is not None and not is_possible(name, value):
                yield say(
                    "{title} must be a number from {low} to {high} {unit}, not {value}.",
                    title=title,
                    low=with_format(low, "g"),
                    high=with_format(high, "g"),
                    unit=word(unit),
                    value=with_format(value, "g"),
                )


class Quantity(StrEnum):
    """What the protections judge."""

    WIND = "wind"
    SNOW = "snow"
    LIGHT = "light"


class Quality(StrEnum):
    """Whether a reading may be relied on, and if not, why."""

    GOOD = "good"
    MISSING = "missing"
    STALE = "stale"
    FROZEN = "frozen"
    IMPOSSIBLE = "impossible"
    BEFORE_RESTART = "before_restart"


@dataclass(frozen=True, slots=True)
class Reading:
    """One quantity: its newest value, how old that is by the steady time, who sent it, and its quality."""

    value: float | None = None
    quality: Quality = Quality.MISSING
    age_s: float | None = None
    source: str = ""

    @property
    def good(self) -> float | None:
        """Return the value if it may be relied on."""
        return self.value if self.quality is Quality.GOOD else None


NO_READING = Reading()


@dataclass(frozen=True, slots=True)
class Sensed:
    """What one tick of a tracker is told of the weather.

    `wind` is the gust, the fastest wind of the last 3 s; `wind_mean_mps` the mean of up to 10 minutes, None
    without a sample (the site may set other windows); `wind_from_deg` where a good reading says that it comes
    from, clockwise from north; `simulated` says that it is all made up. What was reported before the restart
    and not since has that quality; `unheard_s` is how long nothing has been heard at all.
    """

    wind: Reading = NO_READING
    snow: Reading = NO_READING
    light: Reading = NO_READING
    wind_mean_mps: float | None = None
    wind_from_deg: float | None = None
    simulated: bool = False
    unheard_s: float = 0.0

    def reading(self, quantity: Quantity) -> Reading:
        """Return one quantity."""
        match quantity:
            case Quantity.WIND:
                return self.wind
            case Quantity.SNOW:
                return self.snow
            case Quantity.LIGHT:
                return self.light
        assert_never(quantity)


NOTHING_SENSED = Sensed()


@dataclass(frozen=True, slots=True)
class WeatherNow:
    """The newest value of every quantity; age and source are those of the newest report.

    A stale one is older than the site allows: it is shown with its age and must not be used. `quantities`
    tells age, source and quality of each value; `gust_mps` is the fastest wind of the last 3 s, `mean_mps`
    the mean of up to 10 minutes, unless the site sets other windows. `simulated` says that it is all made up.
    `winds` are the wind sensors by their source, `disagreement` says that two of them are too far apart.
    `before_restart` says that nothing has been reported since the controller service started: it is the last
    that was known before.
    """

    readings: Weather
    measured_at: datetime
    age_s: float
    stale: bool
    source: str
    quantities: dict[str, Reading] = field(default_factory=dict)
    gust_mps: float | None = None
    mean_mps: float | None = None
    simulated: bool = False
    winds: dict[str, Reading] = field(default_factory=dict)
    disagreement: Reason | None = None
    before_restart: bool = False

    @property
    def usable(self) -> Weather | None:
        """Return the readings without those that are impossible, None if they are stale."""
        if self.stale:
            return None
        told = (name for name, one in self.quantities.items() if one.quality is Quality.IMPOSSIBLE)
        return replace(self.readings, **dict.fromkeys(told))
