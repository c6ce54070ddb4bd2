"""A clear year of light, made by pvlib alone."""

import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pvlib

from app.energy.plane import Light
from app.sun.position import Algorithm, Location, sun_path


@dataclass(frozen=True)
class ClearYear:
    """The same instants for pvlib's pipeline and for ours; ours has its own sun."""

    location: Location
    sun: pd.DataFrame
    sky: pd.DataFrame
    extraterrestrial: pd.Series
    ours: Light


def clear_year(location: Location, minutes: int = 10, year: int = 2026) -> ClearYear:
    times = pd.date_range(
        f"{year}-01-01", f"{year + 1}-01-01", freq=f"{minutes}min", inclusive="left", tz="UTC"
    )
    with warnings.catch_warnings():
        # pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
        warnings.filterwarnings("ignore", "DatetimeIndex.dayofyear is deprecated")
        return _clear_year(location, times)


def _clear_year(location: Location, times: pd.DatetimeIndex) -> ClearYear:
    place = pvlib.location.Location(location.latitude_deg, location.longitude_deg, "UTC", location.altitude_m)
    sun = place.get_solarposition(times)
    sky = place.get_clearsky(times, model="ineichen", linke_turbidity=3.0, solar_position=sun)
    extra = pvlib.irradiance.get_extra_radiation(times)
    path = sun_path(Algorithm.PSA, location, times.as_unit("ns").asi8 / 1e9)
    columns = (np.asarray(sky[name], dtype=np.float64) for name in ("dni", "dhi", "ghi"))
    ours = Light(path.azimuth_deg, path.apparent_elevation_deg, *columns, np.asarray(extra))
    return ClearYear(location, sun, sky, extra, ours)


def pvlib_wm2(year: ClearYear, tilt, azimuth, model: str) -> np.ndarray:
    """pvlib's own pipeline, on its own sun."""
    total = pvlib.irradiance.get_total_irradiance(
        tilt, azimuth, year.sun["apparent_zenith"], year.sun["azimuth"], year.sky["dni"], year.sky["ghi"],
        year.sky["dhi"], dni_extra=year.extraterrestrial,
        airmass=pvlib.atmosphere.get_relative_airmass(year.sun["apparent_zenith"]), albedo=0.2, model=model,
    )["poa_global"]  # fmt: skip
    return np.nan_to_num(np.asarray(total, dtype=np.float64))
