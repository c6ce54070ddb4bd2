"""What a weather station of the site measured, and how old that is."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from datetime import datetime
from math import isfinite

RANGES = {
    "wind_mps": ("The wind speed", 0.0, 120.0, "m/s"),
    "wind_direction_deg": ("The wind direction", 0.0, 360.0, "degrees from north"),
    "light_wm2": ("The light", 0.0, 2000.0, "W/m2"),
    "snow_kg": ("The snow load", 0.0, 100_000.0, "kg"),
    "snow_mm": ("The snow depth", 0.0, 20_000.0, "mm"),
    "temperature_degc": ("The air temperature", -90.0, 70.0, "degrees Celsius"),
    "humidity_pct": ("The relative humidity", 0.0, 100.0, "percent"),
    "pressure_hpa": ("The air pressure", 300.0, 1100.0, "hPa"),
    "rain_mm": ("The rain", 0.0, 10_000.0, "mm"),
}


@dataclass(frozen=True, slots=True)
class Weather:
    """What one report of a station holds; None is what it does not measure.

    `wind_direction_deg` is where the wind comes from, clockwise from north; `snow_kg` the load on one panel,
    `snow_mm` the depth on the ground; `pressure_hpa` as the station reads it, not reduced to sea level;
    `rain_mm` what the station has counted. Raises `ValueError` with a sentence for every value that is no
    number or that no station on Earth can have measured, and if there is no value at all.
    """

    wind_mps: float | None = None
    wind_direction_deg: float | None = None
    light_wm2: float | None = None
    snow_kg: float | None = None
    snow_mm: float | None = None
    temperature_degc: float | None = None
    humidity_pct: float | None = None
    pressure_hpa: float | None = None
    rain_mm: float | None = None

    def __post_init__(self) -> None:
        wrong = tuple(self._wrong())
        if wrong:
            raise ValueError(" ".join(wrong))

    def _wrong(self) -> Iterator[str]:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        if all(value is None for value in values.values()):
            yield "Give at least one value of the weather."
        for name, value in values.items():
            title, low, high, unit = RANGES[name]
            if value is not None and not (isfinite(value) and low <= value <= high):
                yield f"{title} must be a number from {low:g} to {high:g} {unit}, not {value:g}."


@dataclass(frozen=True, slots=True)
class WeatherNow:
    """The newest report: what it holds, when it was measured, its age now, who sent it.

    A stale one is older than the site allows: it is shown with its age and must not be used.
    """

    readings: Weather
    measured_at: datetime
    age_s: float
    stale: bool
    source: str

    @property
    def usable(self) -> Weather | None:
        """Return the readings, None if they are stale."""
        return None if self.stale else self.readings
