"""Weather files of a year, hour by hour: TMY3, EPW and PVGIS CSV by pvlib's readers."""

import re
from dataclasses import dataclass, replace
from enum import StrEnum
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from pvlib.iotools import read_epw, read_pvgis_hourly, read_pvgis_tmy, read_tmy3

from app.base.file_text import TextRefused, text_of
from app.base.message import N_, Message, join, say
from app.studies.weather_columns import EPW_MARKS, TMY3_MARKS, WeatherRefused, column
from app.sun.position import Algorithm, Location, sun_path
from app.sun.trigonometry import PER_DEGREE, Array

HOURS = 8760
LARGEST_WM2 = 1600.0
LOWEST_SUN_DEG = 3.0
MOST_DIRECT_WM2 = 1367.0
LEAP_DAY = re.compile(r"^(?:\d{4},\s*0?2,\s*29,|0?2/29/\d{4},|\d{4}0229:).*\n", re.MULTILINE)
"""A line of 29 February, as EPW, TMY3, and PVGIS write it."""


UNKNOWN = N_("Heliopanel cannot read this weather file: use TMY3 or PVGIS as CSV, or EPW, as downloaded.")
BOUNDS = {
    "dni": (0.0, LARGEST_WM2),
    "dhi": (0.0, LARGEST_WM2),
    "ghi": (0.0, LARGEST_WM2),
    "temp_air": (-90.0, 70.0),
    "wind_speed": (0.0, 100.0),
}


class WeatherFormat(StrEnum):
    """How a weather file is written."""

    TMY3 = "TMY3"
    EPW = "EPW"
    PVGIS_TMY = "PVGIS TMY"
    PVGIS_HOURLY = "PVGIS hourly"


@dataclass(frozen=True, slots=True)
class WeatherYear:
    """A year of 8760 hours from 1 January, 0 h, at `utc_offset_h` ahead of UTC.

    Irradiance in W/m2, air in degrees Celsius, wind in m/s. A value holds for its hour, and `centre_h` after
    the hour's beginning the sun stands where it belongs to it. 29 February is left out; `filled_hours` had
    missing values, which are interpolated.
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
    filled_hours: int = 0
    has_leap_day: bool = False

    @property
    def source(self) -> Message:
        """Return what the file is, and what was made of it before its values were used."""
        parts = [say("weather file, {format}", format=self.format)]
        if self.filled_hours:
            parts.append(say("interpolated hours: {hours}", hours=self.filled_hours))
        if self.has_leap_day:
            parts.append(N_("29 February left out"))
        return join(", ", parts)


def read_weather(path: Path, year: int | None = None) -> WeatherYear:
    """Return a weather file; of one with several years that year, or the first. Raises `WeatherRefused`."""
    text = _text(path)
    kind = _format_of(text)
    text, leap_hours = LEAP_DAY.subn("", text)
    _check_whole(text)
    try:
        seen = READERS[kind](text, year)
    except WeatherRefused:
        raise
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, OSError) as error:
        raise WeatherRefused(_reason(kind, text, error)) from error
    return replace(seen, has_leap_day=leap_hours > 0)


def _text(path: Path) -> str:
    try:
        return text_of(path.read_bytes(), letters_count=False)
    except TextRefused as error:
        raise WeatherRefused(UNKNOWN) from error
    except OSError as error:
        raise WeatherRefused(
            say(
                "The weather file {name} cannot be read ({reason}). Check its path.",
                name=path.name,
                reason=error.strerror,
            )
        ) from error


def _format_of(text: str) -> WeatherFormat:
    start = text[:4096]
    if start.startswith("LOCATION,"):
        return WeatherFormat.EPW
    if start.startswith("Latitude (decimal degrees)"):
        monthly = "time(UTC)" in start or "month,year" in start
        return WeatherFormat.PVGIS_TMY if monthly else WeatherFormat.PVGIS_HOURLY
    if "Date (MM/DD/YYYY)" in start:
        return WeatherFormat.TMY3
    raise WeatherRefused(UNKNOWN)


def _check_whole(text: str) -> None:
    lines = text.count("\n") + (not text.endswith("\n"))
    if lines <= HOURS:
        raise WeatherRefused(
            say(
                "The file ends after {lines} lines, too few hours; a whole year has {hours}. "
                "Download it again.",
                lines=lines,
                hours=HOURS,
            )
        )


def _reason(kind: WeatherFormat, text: str, error: Exception) -> Message:
    """Return why a file cannot be read: our own sentence, or the line that differs from the others."""
    if error.args and isinstance(error.args[0], Message):
        return error.args[0]
    lines = text.splitlines()
    usual = lines[HOURS // 2].count(",")
    for number, line in enumerate(lines[HOURS // 2 :], start=HOURS // 2 + 1):
        if not line.strip():
            break
        if line.count(",") != usual:
            return say(
                "Line {line} of the file has {cells} values, and the lines before it have {usual}. "
                "Download the file again and upload it unchanged.",
                line=number,
                cells=line.count(",") + 1,
                usual=usual + 1,
            )
    return say(
        "The file begins like {kind} but cannot be read in that format. Download it again and upload it "
        "unchanged.",
        kind=kind,
    )


def _tmy3(text: str, _: int | None) -> WeatherYear:
    data, head = read_tmy3(StringIO(text))
    place = Location(head["latitude"], head["longitude"], head["altitude"])
    return _year(WeatherFormat.TMY3, place, head["TZ"], 0.5, data)


def _epw(text: str, _: int | None) -> WeatherYear:
    data, head = read_epw(StringIO(text))
    place = Location(head["latitude"], head["longitude"], head["altitude"])
    return _year(WeatherFormat.EPW, place, head["TZ"], 0.5, data)


def _pvgis_tmy(text: str, _: int | None) -> WeatherYear:
    data, head = read_pvgis_tmy(BytesIO(text.encode()), pvgis_format="csv")
    centre_h = float(head["inputs"].get(N_("irradiance time offset"), 0.0))
    return _year(WeatherFormat.PVGIS_TMY, _pvgis_place(head), 0.0, centre_h, data)


def _pvgis_hourly(text: str, year: int | None) -> WeatherYear:
    """Return one year of an hourly file of a level plane; the beam is turned from level to facing the sun."""
    data, head = read_pvgis_hourly(StringIO(text), pvgis_format="csv")
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
    data = data[data.index.year == year]
    place, centre_h = _pvgis_place(head), data.index[0].minute / 60.0
    at_s = data.index.as_unit("ns").asi8 / 1e9
    elevation_deg = sun_path(Algorithm.PSA, place, at_s).apparent_elevation_deg
    steep = np.sin(np.maximum(elevation_deg, LOWEST_SUN_DEG) * PER_DEGREE)
    level_wm2, diffuse_wm2 = data["poa_direct"].to_numpy(), data["poa_sky_diffuse"].to_numpy()
    data = data.assign(
        dni=np.minimum(level_wm2 / steep, MOST_DIRECT_WM2), dhi=diffuse_wm2, ghi=level_wm2 + diffuse_wm2
    )
    return _year(WeatherFormat.PVGIS_HOURLY, place, 0.0, centre_h, data)


MARKS = {WeatherFormat.EPW: EPW_MARKS, WeatherFormat.TMY3: TMY3_MARKS}
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
    marks = MARKS.get(kind, {})
    columns = [column(data, name, least, most, marks) for name, (least, most) in BOUNDS.items()]
    direct, diffuse, level, air, wind = (one.values for one in columns)
    filled = int(np.any([one.missing for one in columns], axis=0).sum())
    offset_h = float(utc_offset_h)
    return WeatherYear(kind, place, offset_h, centre_h, direct, diffuse, level, air, wind, filled)
