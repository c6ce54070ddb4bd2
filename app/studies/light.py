"""The light and the air of a study's days, by pvlib's clear-sky models or from a weather file."""

from dataclasses import dataclass
from datetime import UTC, date, datetime, timedelta

import numpy as np
import pandas as pd
from pvlib import atmosphere, clearsky, irradiance

from app.base.message import say
from app.base.zones import zone_of
from app.energy.plane import Light
from app.studies.days import days_of
from app.studies.request import CLEAR_SKIES, LightModel, StudyRequest
from app.studies.weather import WeatherYear
from app.sun.position import RISE_ELEVATION_DEG, Algorithm, Location, SunPath, sun_path
from app.sun.trigonometry import Array

DAY_S = 86_400.0
HOURS = 24


@dataclass(frozen=True, slots=True)
class Days:
    """The instants of a study: all arrays are days times steps; `weights` says what each day stands for."""

    location: Location
    utc_offset_h: float
    source: str
    days: tuple[date, ...]
    weights: tuple[float, ...]
    step_min: int
    at_unix_s: Array
    light: Light
    air_degc: Array
    wind_mps: Array

    @property
    def up(self) -> np.ndarray:
        """Return where the sun is up."""
        return self.light.sun_elevation_deg >= RISE_ELEVATION_DEG


def clear_days(asked: StudyRequest) -> Days:
    """Return the days of a study under a clear sky."""
    days, weights = days_of(asked.span, asked.on)
    offset_h = standard_offset_h(asked.time_zone, asked.on.year)
    steps = HOURS * 60 // asked.step_min
    at_s = midnights_s(days, offset_h)[:, None] + 60.0 * asked.step_min * (np.arange(steps) + 0.5)
    light = clear_light(asked.light, asked.location, at_s)
    air, wind = (np.full_like(at_s, value) for value in (asked.module.air_degc, asked.module.wind_mps))
    source = say("clear sky by {clear_skies}", clear_skies=CLEAR_SKIES[asked.light])
    return Days(asked.location, offset_h, source, days, weights, asked.step_min, at_s, light, air, wind)


def weather_days(asked: StudyRequest, weather: WeatherYear) -> Days:
    """Return the days of a study as a weather file has them, hour by hour."""
    chosen, weights = days_of(asked.span, asked.on)
    offset_h = _whole_offset_h(asked, weather)
    shift = round(offset_h - weather.utc_offset_h)
    year, _ = days_of(type(asked.span).YEAR, asked.on)
    centres_h = np.arange(HOURS) + weather.centre_h
    at_s = midnights_s(year, weather.utc_offset_h)[:, None] + 3600.0 * centres_h
    rows = [year.index(day) for day in chosen]

    def local(hourly: Array) -> Array:
        return np.roll(hourly.ravel(), shift).reshape(len(year), HOURS)[rows]

    at_s = local(at_s)
    path = sun_path(Algorithm.PSA, weather.location, at_s.ravel())
    columns = (local(one) for one in (weather.direct_wm2, weather.diffuse_wm2, weather.global_wm2))
    light = _light(path, at_s, *columns)
    air, wind = local(weather.air_degc), local(weather.wind_mps)
    return Days(weather.location, offset_h, weather.source, chosen, weights, 60, at_s, light, air, wind)


def clear_light(model: LightModel, location: Location, at_unix_s: Array) -> Light:
    """Return the light of a clear sky by one of pvlib's models; Haurwitz's is split by Erbs."""
    path = sun_path(Algorithm.PSA, location, at_unix_s.ravel())
    times = pd.to_datetime(at_unix_s.ravel(), unit="s", utc=True)
    extra_wm2 = _extraterrestrial_wm2(times)
    zenith = pd.Series(90.0 - path.apparent_elevation_deg, index=times)
    if model is LightModel.INEICHEN:
        turbidity = clearsky.lookup_linke_turbidity(times, location.latitude_deg, location.longitude_deg)
        pressure = atmosphere.alt2pres(location.altitude_m)
        mass = atmosphere.get_absolute_airmass(atmosphere.get_relative_airmass(zenith), pressure)
        sky = clearsky.ineichen(zenith, mass, turbidity, location.altitude_m, extra_wm2)
    elif model is LightModel.SOLIS:
        sky = clearsky.simplified_solis(
            90.0 - zenith, pressure=atmosphere.alt2pres(location.altitude_m), dni_extra=extra_wm2
        )
    else:
        level = clearsky.haurwitz(zenith)["ghi"]
        sky = {**irradiance.erbs(level, zenith, times.day_of_year), "ghi": level}
    dark = path.apparent_elevation_deg <= 0.0
    columns = (np.where(dark, 0.0, np.nan_to_num(np.asarray(sky[name]))) for name in ("dni", "dhi", "ghi"))
    return _light(path, at_unix_s, *columns)


def standard_offset_h(time_zone: str, year: int) -> float:
    """Return by how many hours a zone is ahead of UTC without its summer time."""
    zone = zone_of(time_zone)
    halves = (datetime(year, month, 1, tzinfo=zone) for month in (1, 7))
    return min((at.utcoffset() or timedelta()) / timedelta(hours=1) for at in halves)


def _whole_offset_h(asked: StudyRequest, weather: WeatherYear) -> float:
    """Return the offset in which days are cut: the site's, by whole hours from the file's own."""
    wanted_h = standard_offset_h(asked.time_zone, asked.on.year)
    return weather.utc_offset_h + round(wanted_h - weather.utc_offset_h)


def midnights_s(days: tuple[date, ...], offset_h: float) -> Array:
    """Return when days begin at a clock that is ahead of UTC, seconds since 1970."""
    at = (datetime(day.year, day.month, day.day, tzinfo=UTC) for day in days)
    return np.array([one.timestamp() - 3600.0 * offset_h for one in at])


def _extraterrestrial_wm2(times: pd.DatetimeIndex) -> Array:
    days = np.asarray(times.day_of_year, dtype=np.float64)
    return np.asarray(irradiance.get_extra_radiation(days), dtype=np.float64)


def _light(path: SunPath, at_s: Array, direct: Array, diffuse: Array, level: Array) -> Light:
    """Return columns in the shape of the instants."""
    extra = _extraterrestrial_wm2(pd.to_datetime(at_s.ravel(), unit="s", utc=True))
    columns = (path.azimuth_deg, path.apparent_elevation_deg, direct, diffuse, level, extra)
    return Light(*(np.asarray(one, dtype=np.float64).reshape(at_s.shape) for one in columns))
