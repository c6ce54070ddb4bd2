"""The horizon as people paste it: lines, tables of spreadsheets, and the horizon profile of PVGIS.

Azimuth counts clockwise from north. Only PVGIS's own head line says otherwise: its azimuths count from south,
positive to the west. What was changed in reading is told by notes; what can mean two things is refused.
"""

import re
from dataclasses import dataclass
from enum import StrEnum
from itertools import takewhile

from app.base.message import N_, Message, say, told_by
from app.sun.horizon import Horizon, joined
from app.tracker.values.file_table import EXCELS_LINE
from app.tracker.values.minus import with_minus
from app.web.shell.forms import Unreadable, number

PVGIS_HEAD = ["A", "H_hor"]
AZIMUTH = re.compile(r"az\w*", re.IGNORECASE)
ELEVATION = re.compile(r"(?:el|height|horizon|alt)\w*", re.IGNORECASE)
UNIT = re.compile(r"\([^()]*\)|\[[^\[\]]*\]|°")
EMPTY = " ;,\t"

Line = tuple[int, str]


class HorizonNote(StrEnum):
    """What was changed in reading a horizon."""

    PVGIS = "pvgis"
    NEGATIVE = "negative"
    CLOSED = "closed"


NOTES: dict[HorizonNote, Message] = {
    HorizonNote.PVGIS: N_(
        "PVGIS counts azimuth from south; its points were converted. Here it counts clockwise from north."
    ),
    HorizonNote.NEGATIVE: N_("Negative azimuths were read as counterclockwise from north: -90 is 270, west."),
    HorizonNote.CLOSED: N_("Points of the same direction and elevation, such as 0 and 360, were joined."),
}


@dataclass(frozen=True, slots=True)
class HorizonRead:
    """A horizon, and what was changed in reading it."""

    horizon: Horizon
    notes: tuple[HorizonNote, ...] = ()


def read(text: str) -> HorizonRead:
    """Return the horizon that lines of azimuth and elevation mean, in any order; raises `Unreadable`."""
    numbered = enumerate(re.split("\r\n?|\n", text.removeprefix("\ufeff")), start=1)
    lines = [(row, line) for row, line in numbered if line.strip(EMPTY)]
    excels = EXCELS_LINE.fullmatch(lines[0][1]) if lines else None
    separator = excels[1] if excels else _separator([line for _, line in lines])
    table = lines[1:] if excels else lines
    at = next((at for at, (_, line) in enumerate(table) if _is_pvgis(line, separator)), None)
    if at is not None:
        # Behind the table PVGIS explains its columns.
        table = list(takewhile(lambda one: not _is_head(one[1]), table[at + 1 :]))
        profile = [_point(row, _words(line, separator)[:2], 180.0) for row, line in table]
        points, notes = [(one + 180.0, up_deg) for one, up_deg in profile], [HorizonNote.PVGIS]
    else:
        has_head = bool(table) and _is_head(table[0][1])
        order = -1 if has_head and _is_turned(table[0], separator) else 1
        points = [_point(row, _words(line, separator)[::order]) for row, line in table[has_head:]]
        notes = [HorizonNote.NEGATIVE] if any(one < 0.0 for one, _ in points) else []
    if lines and not points:
        raise Unreadable(
            N_("There are no points below the first line. For a flat horizon, leave the field empty.")
        )
    return _joined(points, notes)


def _joined(points: list[tuple[float, float]], notes: list[HorizonNote]) -> HorizonRead:
    try:
        horizon = joined(points)
    except ValueError as error:
        raise Unreadable(told_by(error)) from error
    if len(horizon.points) < len(points):
        notes.append(HorizonNote.CLOSED)
    return HorizonRead(horizon, tuple(notes))


def _separator(lines: list[str]) -> str:
    """Return what separates the two values: nothing for blanks, which leaves commas to be decimal ones.

    A comma separates where the head has one, a blank is beside it, or a point is the decimal sign.
    """
    rows = "\n".join(line.strip() for line in lines if not _is_head(line))
    if ";" in rows:
        return ";"
    named = any(_is_head(line) and "," in UNIT.sub("", line) and ":" not in line for line in lines)
    apart = re.search(", | ,", rows) is not None
    alone = "." in rows and " " not in rows
    return "," if "," in rows and "\t" not in rows and (named or apart or alone) else ""


def _is_head(line: str) -> bool:
    return line.strip(' "')[:1].isalpha()


def _words(line: str, separator: str) -> list[str]:
    words = line.strip().split(separator) if separator else line.split()
    while words and not words[-1].strip():
        words.pop()
    return [word.strip(' "\t') for word in words]


def _is_pvgis(line: str, separator: str) -> bool:
    return _words(line, separator)[:2] == PVGIS_HEAD


def _is_turned(head: Line, separator: str) -> bool:
    """Return whether the head names elevation first; refuse one that names anything else."""
    row, line = head
    match _words(UNIT.sub("", line), separator):
        case [first, second] if AZIMUTH.fullmatch(first) and ELEVATION.fullmatch(second):
            return False
        case [first, second] if ELEVATION.fullmatch(first) and AZIMUTH.fullmatch(second):
            return True
    raise Unreadable(
        say(
            "Line {row}: name the columns azimuth and elevation, or leave this line out. Azimuth counts "
            "clockwise from north.",
            row=row,
        )
    )


def _point(row: int, words: list[str], most_deg: float = 360.0) -> tuple[float, float]:
    if len(words) != 2 or any(len(word.split()) > 1 for word in words):
        raise Unreadable(
            say("Line {row}: type azimuth and elevation with a space between, such as 135 8.", row=row)
        )
    azimuth, elevation = (word.rstrip("°") for word in words)
    least_deg = -180.0 if with_minus(azimuth).startswith("-") else 0.0
    azimuth_deg = number(azimuth, say("Line {row}, azimuth", row=row), least_deg, most_deg)
    return azimuth_deg, number(elevation, say("Line {row}, elevation", row=row), 0, 90)
