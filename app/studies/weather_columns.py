"""The columns of a year of weather: values within bounds, short gaps interpolated, longer ones refused."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from app.base.message import say, with_format
from app.sun.trigonometry import Array

LONGEST_GAP_H = 3
"""Over more hours, a straight line would invent the weather of a morning or an evening."""
IRRADIANCES = ("dni", "dhi", "ghi")
EPW_MARKS = {"dni": 9999.0, "dhi": 9999.0, "ghi": 9999.0, "temp_air": 99.9, "wind_speed": 999.0}
"""How an EPW file says that a value is missing (EnergyPlus, Auxiliary Programs, weather data dictionary)."""
TMY3_MARKS = dict.fromkeys(EPW_MARKS, -9900.0)
"""How a TMY3 file says it (NREL/TP-581-43156)."""


class WeatherRefused(ValueError):
    """The file cannot be used; the text says why and what to give instead."""


@dataclass(frozen=True, slots=True)
class Column:
    """A value for every hour, and in which hours the file has none, so that they are interpolated."""

    values: Array
    missing: NDArray[np.bool_]


def column(data: pd.DataFrame, name: str, least: float, most: float, marks: dict[str, float]) -> Column:
    """Return one column of numbers within bounds; irradiance a little below zero counts as none.

    An empty cell and the mark of the format are missing values. Raises `WeatherRefused`.
    """
    if name not in data.columns:
        raise WeatherRefused(
            say("The file has no column {name}; download it with all its columns.", name=name)
        )
    values = np.array(pd.to_numeric(data[name], errors="coerce"), dtype=np.float64)
    missing = data[name].isna().to_numpy() | np.isin(values, [marks.get(name, np.nan)])
    _check_gaps(missing, name)
    if name in IRRADIANCES:
        values = np.where((values < 0.0) & (values > -10.0), 0.0, values)
    wrong = ~((values >= least) & (values <= most)) & ~missing
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
    hours = np.arange(len(values), dtype=np.float64)
    values[missing] = np.interp(hours[missing], hours[~missing], values[~missing], period=len(values))
    return Column(values, missing)


def _check_gaps(missing: NDArray[np.bool_], name: str) -> None:
    """Refuse a gap that is too long; the year is a circle, so that one over its end is one gap."""
    longest = LONGEST_GAP_H + 1
    around = np.concatenate([missing, missing[:LONGEST_GAP_H]])
    runs = np.lib.stride_tricks.sliding_window_view(around, longest).all(axis=1)
    if not runs.any():
        return
    first = int(runs.argmax())
    known = np.flatnonzero(~np.roll(missing, -first))
    raise WeatherRefused(
        say(
            "From hour {first} of the file, {hours} hours have no {name}; up to {longest} are interpolated. "
            "Use another year or another source.",
            first=first + 1,
            hours=int(known[0]) if len(known) else len(missing),
            name=name,
            longest=LONGEST_GAP_H,
        )
    )
