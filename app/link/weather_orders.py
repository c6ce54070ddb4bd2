"""Orders about the site's weather: reports, stations, and how values are judged."""

from dataclasses import dataclass
from datetime import datetime
from typing import ClassVar, Literal

from app.base.message import N_
from app.base.permission import Permission
from app.link.settings_orders import UndoSiteSettings
from app.tracker.memory.memory import MetStation
from app.tracker.values.order_spec import STORED_S, Interface, OrderSpec, setting
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather import Weather
from app.tracker.weather.weather_windows import WeatherWindows


@dataclass(frozen=True, slots=True)
class ReportWeather:
    """What a weather station measured, at `measured_at` (None: now); trackers stow by it."""

    readings: Weather
    measured_at: datetime | None = None
    kind: Literal["report_weather"] = "report_weather"
    spec: ClassVar = OrderSpec(needs=Permission.REPORT, by=Interface.API, within_s=STORED_S, audited=False)

    def __post_init__(self) -> None:
        if self.readings == Weather():
            raise ValueError(N_("Give at least one value of the weather."))


@dataclass(frozen=True, slots=True)
class SetMetStation:
    """Read this weather station from now on, in the place of a simulated one; None: none."""

    station: MetStation | None
    kind: Literal["set_met_station"] = "set_met_station"
    spec: ClassVar = setting(undone_by=UndoSiteSettings)


@dataclass(frozen=True, slots=True)
class SimulateWeather:
    """Make the weather up from now on, in the place of a station; None: no longer.

    Refused unless every tracker of the site is simulated.
    """

    station: SimulatedStation | None
    kind: Literal["simulate_weather"] = "simulate_weather"
    spec: ClassVar = setting(undone_by=UndoSiteSettings)


@dataclass(frozen=True, slots=True)
class SetWeatherWindows:
    """Take gust and mean over these windows, and hold values for old from these ages on."""

    windows: WeatherWindows
    kind: Literal["set_weather_windows"] = "set_weather_windows"
    spec: ClassVar = setting(undone_by=UndoSiteSettings)


WeatherOrder = ReportWeather | SetMetStation | SimulateWeather | SetWeatherWindows
"""What concerns the site's weather."""
