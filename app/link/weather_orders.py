"""Orders about the site's weather: reports, stations, and how values are judged."""

from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from app.tracker.memory import MetStation
from app.tracker.simulated_weather import SimulatedStation
from app.tracker.weather import Weather
from app.tracker.weather_windows import WeatherWindows


@dataclass(frozen=True, slots=True)
class ReportWeather:
    """What a weather station measured, at `measured_at` (None: now); trackers stow by it."""

    readings: Weather
    measured_at: datetime | None = None
    kind: Literal["report_weather"] = "report_weather"


@dataclass(frozen=True, slots=True)
class SetMetStation:
    """Read this weather station from now on, in the place of a simulated one; None: none."""

    station: MetStation | None
    kind: Literal["set_met_station"] = "set_met_station"


@dataclass(frozen=True, slots=True)
class SimulateWeather:
    """Make the weather up from now on, in the place of a station; None: no longer.

    Refused unless every tracker of the site is simulated.
    """

    station: SimulatedStation | None
    kind: Literal["simulate_weather"] = "simulate_weather"


@dataclass(frozen=True, slots=True)
class SetWeatherWindows:
    """Take gust and mean over these windows, and hold values for old from these ages on."""

    windows: WeatherWindows
    kind: Literal["set_weather_windows"] = "set_weather_windows"


WeatherOrder = ReportWeather | SetMetStation | SimulateWeather | SetWeatherWindows
"""What concerns the site's weather."""
