"""Reads the golden tables that lie beside it."""

import csv
import re
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path


@dataclass(frozen=True, slots=True)
class GoldenRow:
    case: str
    at: datetime
    latitude_deg: float
    longitude_deg: float
    values: dict[str, float]

    @property
    def hour(self) -> float:
        return self.at.hour + self.at.minute / 60.0 + self.at.second / 3600.0


def golden(name: str) -> list[GoldenRow]:
    with (Path(__file__).parent / name).open(newline="") as file:
        return [_row(row) for row in csv.DictReader(file)]


def _row(row: dict[str, str]) -> GoldenRow:
    values = {key: float(text) for key, text in row.items() if key not in ("case", "utc")}
    at = datetime.fromisoformat(row["utc"] + "+00:00")
    return GoldenRow(row["case"], at, values["lat"], values["lon"], values)


def numbers(name: str) -> list[dict[str, float]]:
    """Return the rows of a table that holds nothing but numbers."""
    with (Path(__file__).parent / name).open(newline="") as file:
        return [{key: float(text) for key, text in row.items()} for row in csv.DictReader(file)]


def rows(name: str) -> list[dict[str, str]]:
    """Return the rows of a table; a character that nobody would see is written in it as `\\u00a0`."""
    with (Path(__file__).parent / name).open(newline="", encoding="utf-8") as file:
        return [{key: _seen(text) for key, text in row.items()} for row in csv.DictReader(file)]


def _seen(text: str) -> str:
    return re.sub(r"\\u([0-9a-f]{4})", lambda found: chr(int(found[1], 16)), text)


UNITS = {"s": "seconds", "min": "minutes", "h": "hours", "d": "days"}


@dataclass(frozen=True, slots=True)
class ClockRow:
    """How far the clock was ahead when something was noted, how far when it is asked, and how long later."""

    stored: timedelta
    asked: timedelta
    later: timedelta
    expected: str


def clocks(guard: str) -> list[ClockRow]:
    """Return the rows of the clocks under which one guard is asked."""
    return [
        ClockRow(_span(row["stored"]), _span(row["asked"]), _span(row["later"]), row["expected"])
        for row in rows("world/clocks.csv")
        if row["guard"] == guard
    ]


def _span(text: str) -> timedelta:
    number, unit = text.split()
    return timedelta(**{UNITS[unit]: float(number)})
