"""A made-up weather station: set by hand, or running through a scenario, the same twice for a seed."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum
from functools import lru_cache
from itertools import pairwise
from math import exp, isfinite, radians, sin, tau

import numpy as np

from app.base.message import N_, Message, say, with_format, word
from app.sun.position import SunPosition
from app.tracker.weather.weather import SIMULATED, Weather

SPANS = {
    "wind_mps": (N_("The simulated mean wind"), 0.0, 50.0, "m/s"),
    "gustiness_pct": (N_("The simulated gustiness"), 0.0, 100.0, "percent"),
    "wind_direction_deg": (N_("The simulated wind direction"), 0.0, 360.0, N_("degrees from north")),
    "irradiance_wm2": (N_("The simulated irradiance"), 0.0, 1500.0, "W/m2"),
    "snow_kg": (N_("The simulated snow load"), 0.0, 1000.0, "kg"),
    "temperature_degc": (N_("The simulated air temperature"), -60.0, 60.0, N_("degrees Celsius")),
}
MOST_SEED = 2**31 - 1
GUSTS_S = (5.3, 11.9, 29.0, 73.0)
CLOUDS_S = (97.0, 241.0, 613.0)
VEER_S = (180.0, 420.0)
VEERS_DEG = 10.0
LEAST_RIPPLE = 0.01
"""A sensor that works is never quite still: without this one that is set by hand would count as frozen."""


class Scenario(StrEnum):
    """What the made-up weather does by itself."""

    MANUAL = "manual"
    CALM = "calm"
    STORM = "storm"
    SNOWFALL = "snowfall"
    CLOUDS = "clouds"

    @classmethod
    def _missing_(cls, value: object) -> "Scenario | None":
        """Return what is stored under a former name."""
        return cls.MANUAL if value == "by_hand" else None


class WeatherFault(StrEnum):
    """What can be played on a made-up station for training."""

    HIGH_WIND = "high_wind"
    SNOW_LOAD = "snow_load"
    SNOW_AND_WIND = "snow_and_wind"
    LIGHT_FLICKERS = "light_flickers"
    WIND_IMPOSSIBLE = "wind_impossible"
    WIND_FROZEN = "wind_frozen"
    WINDS_DISAGREE = "winds_disagree"
    STATION_SILENT = "station_silent"


@dataclass(frozen=True, slots=True)
class PlayedWeather:
    """What is played on a made-up station, since an instant of the site's clock."""

    fault: WeatherFault
    since: datetime


@dataclass(frozen=True, slots=True)
class SimulatedStation:
    """A simulated station; wind, irradiance, snow and temperature count only if set, the direction always.

    `gustiness_pct` is how far the strongest gust exceeds the mean wind. `irradiance_wm2` None is that of a
    clear sky at the sun's elevation. A scenario begins at `begun_at`, by the site's clock; None: the site
    begins it when it takes the order. `played` is what is played on it for training. Raises `ValueError` with
    a sentence for what is out of range.
    """

    scenario: Scenario = Scenario.MANUAL
    seed: int = 1
    wind_mps: float = 3.0
    gustiness_pct: float = 30.0
    wind_direction_deg: float = 225.0
    irradiance_wm2: float | None = None
    snow_kg: float = 0.0
    temperature_degc: float = 20.0
    begun_at: datetime | None = None
    played: PlayedWeather | None = None

    def __post_init__(self) -> None:
        for name, (title, low, high, unit) in SPANS.items():
            value = getattr(self, name)
            if value is not None and not (isfinite(value) and low <= value <= high):
                raise ValueError(
                    say(
                        "{title} must lie between {low} and {high} {unit}.",
                        title=title,
                        low=with_format(low, "g"),
                        high=with_format(high, "g"),
                        unit=word(unit),
                    )
                )
        if not 0 <= self.seed <= MOST_SEED:
            raise ValueError(
                say(
                    "The seed of the simulated weather must lie between 0 and {most_seed}.",
                    most_seed=MOST_SEED,
                )
            )

    @property
    def name(self) -> Message:
        """Return what it is called where its readings are shown."""
        return say(
            "{simulated} station ({scenario})",
            simulated=SIMULATED,
            scenario=self.scenario,
        )


@dataclass(frozen=True, slots=True)
class _Moment:
    """The weather of a scenario so many minutes after its begin.

    `light` is the share of a clear sky's light, `broken` the share of it that passing clouds take at most.
    """

    minute: float
    wind_mps: float
    gustiness_pct: float = 30.0
    light: float = 1.0
    broken: float = 0.0
    snow_kg: float = 0.0
    temperature_degc: float = 20.0


STORIES: dict[Scenario, tuple[_Moment, ...]] = {
    Scenario.CALM: (_Moment(0, 2.5, temperature_degc=22.0),),
    Scenario.STORM: (
        _Moment(0, 4.0),
        _Moment(2, 5.0, light=0.8),
        _Moment(6, 20.0, 40.0, light=0.3, temperature_degc=16.0),
        _Moment(14, 20.0, 40.0, light=0.25, temperature_degc=14.0),
        _Moment(18, 5.0, light=0.7, temperature_degc=15.0),
        _Moment(25, 3.0, temperature_degc=17.0),
    ),
    Scenario.SNOWFALL: (
        _Moment(0, 2.0, light=0.5, temperature_degc=0.5),
        _Moment(2, 2.0, light=0.2, temperature_degc=-1.0),
        _Moment(14, 3.0, light=0.15, snow_kg=8.0, temperature_degc=-3.0),
        _Moment(20, 2.0, light=0.4, snow_kg=8.0, temperature_degc=-3.0),
        _Moment(22, 2.0, light=0.8, temperature_degc=-2.0),
    ),
    Scenario.CLOUDS: (
        _Moment(0, 4.0),
        _Moment(5, 5.0, broken=0.75),
        _Moment(30, 5.0, broken=0.75),
        _Moment(33, 6.0, light=0.01),
        _Moment(53, 6.0, light=0.01),
        _Moment(56, 5.0, broken=0.5),
    ),
}
"""Between two moments everything changes evenly; after the last it stays as it is."""


def weather_at(station: SimulatedStation, at: datetime, sun: SunPosition | None) -> Weather:
    """Return what the station reads at an instant of the site; light is none while the sun is unknown.

    The same for the same station, instant and sun. Wind direction is degrees clockwise from north.
    """
    elapsed_s = elapsed(station, at).total_seconds()
    if station.scenario is Scenario.MANUAL:
        moment = _Moment(
            0, station.wind_mps, station.gustiness_pct, 1.0, 0.0, station.snow_kg, station.temperature_degc
        )
    else:
        moment = _between(STORIES[station.scenario], elapsed_s / 60.0)
    gust = max(LEAST_RIPPLE, moment.gustiness_pct / 100.0) * _noise(station.seed, elapsed_s, GUSTS_S)
    veer_deg = VEERS_DEG * _noise(station.seed + 1, elapsed_s, VEER_S)
    return Weather(
        wind_mps=moment.wind_mps * (1.0 + gust),
        wind_direction_deg=(station.wind_direction_deg + veer_deg) % 360.0,
        irradiance_wm2=_irradiance_wm2(station, moment, elapsed_s, sun),
        snow_kg=moment.snow_kg,
        temperature_degc=moment.temperature_degc,
    )


def elapsed(station: SimulatedStation, at: datetime) -> timedelta:
    """Return how long the scenario has run, nothing before its begin."""
    return max(timedelta(0), at - (station.begun_at or at))


def clear_irradiance_wm2(elevation_deg: float) -> float:
    """Return the light of a clear sky on level ground by Haurwitz, W/m2.

    1098 sin(h) exp(-0.059 / sin(h)) with the elevation h; B. Haurwitz, Insolation in relation to cloudiness
    and cloud density, Journal of Meteorology 2 (1945), 154-166; as Reno, Hansen and Stein write it, Global
    horizontal irradiance clear sky models, SAND2012-2389 (2012), doi:10.2172/1039404.
    """
    height = sin(radians(elevation_deg))
    return 1098.0 * height * exp(-0.059 / height) if height > 0.0 else 0.0


def _irradiance_wm2(
    station: SimulatedStation, moment: _Moment, elapsed_s: float, sun: SunPosition | None
) -> float | None:
    by_hand = station.scenario is Scenario.MANUAL and station.irradiance_wm2 is not None
    if sun is None and not by_hand:
        return None
    clear_wm2 = (
        station.irradiance_wm2
        if by_hand
        else clear_irradiance_wm2(sun.apparent_elevation_deg)
        if sun
        else None
    )
    cover = 0.5 + 0.5 * _noise(station.seed + 2, elapsed_s, CLOUDS_S)
    ripple = 1.0 + LEAST_RIPPLE * _noise(station.seed + 3, elapsed_s, GUSTS_S)
    return (clear_wm2 or 0.0) * moment.light * (1.0 - moment.broken * cover) * ripple


def _between(story: tuple[_Moment, ...], minute: float) -> _Moment:
    """Return a story's weather at a minute, by straight lines between its moments."""
    for before, after in pairwise(story):
        if minute < after.minute:
            share = (minute - before.minute) / (after.minute - before.minute)
            return _mixed(before, after, share)
    return story[-1]


def _mixed(before: _Moment, after: _Moment, share: float) -> _Moment:
    return _Moment(
        *(
            (1.0 - share) * getattr(before, name) + share * getattr(after, name)
            for name in _Moment.__dataclass_fields__
        )
    )


def _noise(seed: int, elapsed_s: float, periods_s: tuple[float, ...]) -> float:
    """Return a smooth number from -1 to 1: the mean of sines with these periods and the seed's phases."""
    pairs = zip(periods_s, _phases(seed, len(periods_s)), strict=True)
    return sum(sin(tau * (elapsed_s / period_s + phase)) for period_s, phase in pairs) / len(periods_s)


@lru_cache(maxsize=64)
def _phases(seed: int, count: int) -> tuple[float, ...]:
    """Return where each sine begins, as a share of its period."""
    return tuple(float(phase) for phase in np.random.default_rng(seed).random(count))
