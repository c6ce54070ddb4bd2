"""Weather files of a year, hour by hour: TMY3, EPW and PVGIS CSV by pvlib's readers."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from pvlib.iotools import read_epw, read_pvgis_hourly, read_pvgis_tmy, read_tmy3

from app.base.message import N_, say, told_by, with_format
from app.sun.position import Algorithm, Location, sun_path
from app.sun.trigonometry import PER_DEGREE, Array

HOURS = 8760
LARGEST_WM2 = 1600.0
LOWEST_SUN_DEG = 3.0
MOST_DIRECT_WM2 = 1367.0


class WeatherFormat(StrEnum):
    """How a weather file is written."""

    TMY3 = "TMY3"
    EPW = "EPW"
    PVGIS_TMY = "PVGIS TMY"
    PVGIS_HOURLY = "PVGIS hourly"


class WeatherRefused(ValueError):
    """The file cannot be used; the text says why and what to give instead."""


@dataclass(frozen=True, slots=True)
class WeatherYear:
    """A year of 8760 hours from 1 January, 0 h, at `utc_offset_h` ahead of UTC.

    Irradiance in W/m2, air in degrees Celsius, wind in m/s. A value holds for its hour, and `centre_h` after
    the hour's beginning the sun stands where it belongs to it.
    """

    format: WeatherFormat
    location: Location
    utc_offset_h: float
    centre_h: float
    direct_wm2: Array
    diffuse_wm2: Array
    global_wm2: Array
    air_degc: Array
    wind_mps: Array


def read_weather(path: Path, year: int | None = None) -> WeatherYear:
    """Return a weather file; of one with several years that year, or the first. Raises `WeatherRefused`."""
    kind = _format_of(path)
    _check_whole(path)
    try:
        return READERS[kind](path, year)
    except WeatherRefused:
        raise
    except (ValueError, KeyError, IndexError, TypeError, UnicodeDecodeError, pd.errors.ParserError) as error:
        raise WeatherRefused(
            say(
                "The file begins like {kind} but cannot be read in that format: {error}. Download it "
                "again and upload it unchanged.",
                kind=kind,
                error=told_by(error),
            )
        ) from error


def _format_of(path: Path) -> WeatherFormat:
    with path.open("rb") as file:
        start = file.read(4096).decode("latin-1")
    if start.startswith("LOCATION,"):
        return WeatherFormat.EPW
    if start.startswith("Latitude (decimal degrees)"):
        monthly = "time(UTC)" in start or "month,year" in start
        return WeatherFormat.PVGIS_TMY if monthly else WeatherFormat.PVGIS_HOURLY
    if "Date (MM/DD/YYYY)" in start:
        return WeatherFormat.TMY3
    raise WeatherRefused(
        N_("Heliopanel cannot read this weather file: use TMY3 or PVGIS as CSV, or EPW, as downloaded.")
    )


def _check_whole(path: Path) -> None:
    with path.open("rb") as file:
        lines = sum(1 for _ in file)
    if lines <= HOURS:
        raise WeatherRefused(
            say(
                "The file ends after {lines} lines, too few hours; a whole year has {hours}. "
                "Download it again.",
                lines=lines,
                hours=HOURS,
            )
        )


def _tmy3(path: Path, _: int | None) -> WeatherYear:
    data, head = read_tmy3(str(path))
    place = Location(head["latitude"], head["longitude"], head["altitude"])
    return _year(WeatherFormat.TMY3, place, head["TZ"], 0.5, data)


def _epw(path: Path, _: int | None) -> WeatherYear:
    data, head = read_epw(str(path))
    place = Location(head["latitude"], head["longitude"], head["altitude"])
    return _year(WeatherFormat.EPW, place, head["TZ"], 0.5, data)


def _pvgis_tmy(path: Path, _: int | None) -> WeatherYear:
    data, head = read_pvgis_tmy(str(path), pvgis_format="csv")
    centre_h = float(head["inputs"].get(N_("irradiance time offset"), 0.0))
    return _year(WeatherFormat.PVGIS_TMY, _pvgis_place(head), 0.0, centre_h, data)


def _pvgis_hourly(path: Path, year: int | None) -> WeatherYear:
    """Return one year of an hourly file of a level plane; the beam is turned from level to facing the sun."""
    data, head = read_pvgis_hourly(str(path), pvgis_format="csv")
    if not {"poa_direct", "poa_sky_diffuse"} <= set(data.columns):
        raise WeatherRefused(N_("Select the radiation components in PVGIS: this file has only their sum."))
    if not str(head["inputs"].get("Slope", "")).startswith("0"):
        raise WeatherRefused(
            N_("Select a horizontal plane (slope 0) in PVGIS: this file is for a tilted plane.")
        )
    years = sorted(set(data.index.year))
    year = years[0] if year is None else year
    if year not in years:
        raise WeatherRefused(
            say(
                "The file has the years {years} to {years2}, not {year}: choose one of them.",
                years=years[0],
                years2=years[-1],
                year=year,
            )
        )
    data = data[(data.index.year == year) & ~((data.index.month == 2) & (data.index.day == 29))]
    place, centre_h = _pvgis_place(head), data.index[0].minute / 60.0
    at_s = data.index.as_unit("ns").asi8 / 1e9
    elevation_deg = sun_path(Algorithm.PSA, place, at_s).apparent_elevation_deg
    steep = np.sin(np.maximum(elevation_deg, LOWEST_SUN_DEG) * PER_DEGREE)
    level_wm2, diffuse_wm2 = data["poa_direct"].to_numpy(), data["poa_sky_diffuse"].to_numpy()
    data = data.assign(
        dni=np.minimum(level_wm2 / steep, MOST_DIRECT_WM2), dhi=diffuse_wm2, ghi=level_wm2 + diffuse_wm2
    )
    return _year(WeatherFormat.PVGIS_HOURLY, place, 0.0, centre_h, data)


READERS = {
    WeatherFormat.TMY3: _tmy3,
    WeatherFormat.EPW: _epw,
    WeatherFormat.PVGIS_TMY: _pvgis_tmy,
    WeatherFormat.PVGIS_HOURLY: _pvgis_hourly,
}


def _pvgis_place(head: dict[str, Any]) -> Location:
    found = head["inputs"]
    return Location(found["latitude"], found["longitude"], found["elevation"])


def _year(
    kind: WeatherFormat, place: Location, utc_offset_h: float, centre_h: float, data: pd.DataFrame
) -> WeatherYear:
    if len(data) != HOURS:
        raise WeatherRefused(
            say("The file has {data} hours; a whole year has {hours}.", data=len(data), hours=HOURS)
        )
    direct, diffuse, level = (_column(data, name, 0.0, LARGEST_WM2) for name in ("dni", "dhi", "ghi"))
    air, wind = _column(data, "temp_air", -90.0, 70.0), _column(data, "wind_speed", 0.0, 100.0)
    return WeatherYear(kind, place, float(utc_offset_h), centre_h, direct, diffuse, level, air, wind)


def _column(data: pd.DataFrame, name: str, least: float, most: float) -> Array:
    """Return one column of numbers within bounds; irradiance a little below zero counts as none."""
    if name not in data.columns:
        raise WeatherRefused(
            say("The file has no column {name}; download it with all its columns.", name=name)
        )
    values = np.asarray(pd.to_numeric(data[name], errors="coerce"), dtype=np.float64)
    if name in ("dni", "dhi", "ghi"):
        values = np.where((values < 0.0) & (values > -10.0), 0.0, values)
    wrong = ~((values >= least) & (values <= most))
    if wrong.any():
        hour = int(wrong.argmax())
        raise WeatherRefused(
            say(
                "In hour {hour} of the file, {name} is {iloc}; the valid range is {least} to {most}. "
                "Download the file again, or use another source.",
                hour=hour + 1,
                name=name,
                iloc=data[name].iloc[hour],
                least=with_format(least, "g"),
                most=with_format(most, "g"),
            )
        )
    return values
