"""What a made-up weather station reports while weather or a broken sensor is played on it for training."""

from dataclasses import replace
from datetime import datetime

from app.base.message import say
from app.sun.position import SunPosition
from app.tracker.weather.simulated_weather import (
    PlayedWeather,
    Scenario,
    SimulatedStation,
    WeatherFault,
    weather_at,
)
from app.tracker.weather.weather import SIMULATED, Weather

STORM_MPS = 20.0
STORM_GUSTS_PCT = 40.0
SNOW_KG = 8.0
DARK_WM2, BRIGHT_WM2 = 20.0, 120.0
FLICKER_S = 5.0
FROZEN_LEAST_MPS = 2.0
SECOND_MAST_SHARE = 0.4
SECOND_MAST_LESS_MPS = 5.0
SECOND_MAST = say("{simulated} second mast", simulated=SIMULATED)
Report = tuple[Weather | None, tuple[str, ...]]


def report_at(station: SimulatedStation, at: datetime, sun: SunPosition | None) -> Report:
    """Return readings and the names of what is impossible; no readings at all: the station says nothing."""
    weather, fault = weather_at(station, at, sun), station.played and station.played.fault
    if fault is WeatherFault.STATION_SILENT:
        return None, ()
    if fault is WeatherFault.WIND_IMPOSSIBLE:
        return replace(weather, wind_mps=None), ("wind_mps",)
    return weather if station.played is None else _changed(weather, station, station.played, at), ()


def _changed(weather: Weather, station: SimulatedStation, played: PlayedWeather, at: datetime) -> Weather:
    """Return the readings of a station that answers, as what is played has changed them."""
    match played.fault:
        case WeatherFault.HIGH_WIND | WeatherFault.WINDS_DISAGREE:
            return replace(weather, wind_mps=_storm_mps(station, at))
        case WeatherFault.SNOW_LOAD:
            return replace(weather, snow_kg=SNOW_KG)
        case WeatherFault.SNOW_AND_WIND:
            return replace(weather, snow_kg=SNOW_KG, wind_mps=_storm_mps(station, at))
        case WeatherFault.LIGHT_FLICKERS:
            dark = (at - played.since).total_seconds() % (2.0 * FLICKER_S) < FLICKER_S
            return replace(weather, irradiance_wm2=DARK_WM2 if dark else BRIGHT_WM2)
        case WeatherFault.WIND_FROZEN:
            then_mps = weather_at(station, played.since, None).wind_mps or 0.0
            return replace(weather, wind_mps=max(FROZEN_LEAST_MPS, then_mps))
        case _:
            return weather


def second_mast(station: SimulatedStation, weather: Weather | None) -> Weather | None:
    """Return what a second wind sensor reports that disagrees with the first, None where there is none."""
    played = station.played
    if played is None or played.fault is not WeatherFault.WINDS_DISAGREE or weather is None:
        return None
    wind_mps = SECOND_MAST_SHARE * (weather.wind_mps or 0.0) - SECOND_MAST_LESS_MPS
    return Weather(wind_mps=max(0.1, wind_mps))


def _storm_mps(station: SimulatedStation, at: datetime) -> float | None:
    by_hand = replace(
        station,
        scenario=Scenario.MANUAL,
        wind_mps=STORM_MPS,
        gustiness_pct=STORM_GUSTS_PCT,
        irradiance_wm2=0.0,
    )
    return weather_at(by_hand, at, None).wind_mps
