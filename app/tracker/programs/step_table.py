"""Step programs as CSV, and back: a sentence for every row and column that cannot be read.

First a line `# name`, then a line with the names of the columns, which say what times and angles are:
`solar_time`, or `clock_time` (UTC), or `clock_time_utc+02:00`; then `azimuth_deg,elevation_deg`, or
`hour_angle_deg,declination_deg`, or `first_axis_deg,second_axis_deg`. Times are 07:52:48, or hours such as
7.88; an angle that is left empty follows the tracker's mode. Semicolons or tabs and decimal commas, as
spreadsheets save them, are read as well; what is written here is always the same.
"""

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import StringIO

from app.base.message import N_, join, say, told_by
from app.base.names import tidy
from app.tracker.settings.stepped import (
    MOST_STEPS,
    ProgramStep,
    StepFrame,
    StepProgram,
    TimeBase,
    step_errors,
)
from app.tracker.values.file_table import FileTable, TableRefused, read_table

COLUMNS = {
    StepFrame.HORIZON: ("azimuth_deg", "elevation_deg"),
    StepFrame.EQUATOR: ("hour_angle_deg", "declination_deg"),
    StepFrame.AXES: ("first_axis_deg", "second_axis_deg"),
}
CLOCK_TIME = re.compile(r"clock_time(?:_utc([+-])(\d{2}):(\d{2}))?")
TIME = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2}(?:\.\d+)?))?")
LONGEST_TEXT = 100_000
UNNAMED = N_("Imported program")
MOST_SENTENCES = 10


class TableWrong(ValueError):
    """A table that is no program; `sentences` say where and why."""

    def __init__(self, *sentences: str) -> None:
        super().__init__(join(" ", sentences))
        self.sentences = sentences


@dataclass(slots=True)
class _Reading:
    """What was read so far, and what was wrong with it."""

    frame: StepFrame
    table: FileTable
    steps: list[ProgramStep] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)


def to_table(program: StepProgram) -> str:
    """Return a program as CSV with lines that end in a line feed."""
    out = StringIO()
    out.write(_comment(program.name))
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow((_time_column(program), *COLUMNS[program.frame]))
    for step in program.steps:
        rows.writerow((time_text(step.from_h), number_text(step.first_deg), number_text(step.second_deg)))
    return out.getvalue()


def from_table(text: str, *, name: str = "") -> StepProgram:
    """Return the program of a CSV text; `name` counts if the text gives none. Raises `TableWrong`."""
    if len(text) > LONGEST_TEXT:
        raise TableWrong(
            say(
                "The file is longer than {longest_text} characters; a program is a short table.",
                longest_text=LONGEST_TEXT,
            )
        )
    try:
        table = read_table(text)
    except TableRefused as error:
        raise TableWrong(told_by(error)) from error
    if not table.names:
        raise TableWrong(
            N_("The file is empty: it needs a line with the names of the columns, then the steps.")
        )
    frame, base, offset_h = _head(table.names)
    reading = _Reading(frame, table)
    for number, cells in table.rows[: MOST_STEPS + 1]:
        _read_row(reading, number, cells)
    if reading.wrong:
        raise TableWrong(*reading.wrong[:MOST_SENTENCES])
    try:
        title = table.comments[0] if table.comments and table.comments[0] else name or UNNAMED
        return StepProgram(tidy(title), tuple(reading.steps), frame, base, offset_h)
    except ValueError as error:
        raise TableWrong(told_by(error)) from error


def time_text(hour: float) -> str:
    """Return hours as 07:52:48 where that is exact to a microsecond, else as a number of hours."""
    seconds = round(hour * 3600.0)
    if abs(seconds / 3600.0 - hour) > 1e-9:
        return repr(hour)
    return f"{seconds // 3600:02d}:{seconds // 60 % 60:02d}:{seconds % 60:02d}"


def number_text(value: float | None) -> str:
    """Return a number without needless zeros, nothing for None."""
    if value is None:
        return ""
    return str(int(value)) if value == int(value) else repr(value)


def _time_column(program: StepProgram) -> str:
    if program.time_base is TimeBase.SOLAR:
        return "solar_time"
    if program.utc_offset_h == 0.0:
        return "clock_time"
    minutes = round(abs(program.utc_offset_h) * 60.0)
    sign = "-" if program.utc_offset_h < 0.0 else "+"
    return f"clock_time_utc{sign}{minutes // 60:02d}:{minutes % 60:02d}"


def _comment(name: str) -> str:
    """Return the line with the name, in quotation marks where a spreadsheet would cut it into cells."""
    line = f"# {name}"
    plain = name == name.strip() and not re.search('[",;\t]', name)
    return f"{line}\n" if plain else '"{}"\n'.format(line.replace('"', '""'))


def _head(cells: tuple[str, ...]) -> tuple[StepFrame, TimeBase, float]:
    """Return what the names of the columns say."""
    frames = {names: frame for frame, names in COLUMNS.items()}
    frame = frames.get((cells[1], cells[2])) if len(cells) == 3 else None
    clock = CLOCK_TIME.fullmatch(cells[0])
    if frame is None or (clock is None and cells[0] != "solar_time"):
        known = join("; ", (",".join(names) for names in COLUMNS.values()))
        raise TableWrong(
            say(
                "The first row must name three columns: solar_time or clock_time, then one of "
                "{known}. It says: {cells}.",
                known=known,
                cells=",".join(cells),
            )
        )
    if clock is None:
        return frame, TimeBase.SOLAR, 0.0
    offset_h = int(clock[2] or 0) + int(clock[3] or 0) / 60.0
    return frame, TimeBase.CLOCK, -offset_h if clock[1] == "-" else offset_h


def _read_row(reading: _Reading, number: int, cells: tuple[str, ...]) -> None:
    names = COLUMNS[reading.frame]
    if len(cells) != 3:
        reading.wrong.append(say("Row {number} has {cells} cells, not 3.", number=number, cells=len(cells)))
        return
    wrong: list[str] = []
    values = list(_numbers(reading.table, number, ("time", *names), cells, wrong))
    if values[0] is None and not wrong:
        wrong.append(say("Row {number}, time: give a time such as 07:52:48.", number=number))
    if not wrong and values[0] is not None:
        step = ProgramStep(values[0], values[1], values[2])
        wrong += [
            say("Row {number}: {sentence}", number=number, sentence=sentence)
            for sentence in step_errors(step, reading.frame)
        ]
        wrong += _out_of_order(reading, number, step)
        reading.steps.append(step)
    reading.wrong += wrong


def _time(table: FileTable, text: str) -> float:
    """Return a time of the day in hours from 07:52:48 or 7.88; raises `ValueError`."""
    found = TIME.fullmatch(text)
    if found is None:
        return table.number(text)
    hours, minutes, seconds = int(found[1]), int(found[2]), float(found[3] or 0.0)
    if minutes >= 60 or seconds >= 60.0:
        raise ValueError(text)
    return (hours * 3600.0 + minutes * 60.0 + seconds) / 3600.0


def _numbers(
    table: FileTable, number: int, names: tuple[str, ...], cells: tuple[str, ...], wrong: list[str]
) -> Iterator[float | None]:
    for place, (name, cell) in enumerate(zip(names, cells, strict=True)):
        try:
            yield None if not cell else _time(table, cell) if place == 0 else table.number(cell)
        except ValueError:
            wanted = N_("a time such as 07:52:48 or 7.88") if place == 0 else N_("a number")
            wrong.append(
                say(
                    "Row {number}, {name}: {cell} is not {wanted}.",
                    number=number,
                    name=name,
                    cell=repr(cell),
                    wanted=wanted,
                )
            )
            yield None


def _out_of_order(reading: _Reading, number: int, step: ProgramStep) -> list[str]:
    if not reading.steps or step.from_h > reading.steps[-1].from_h:
        return []
    before = time_text(reading.steps[-1].from_h)
    return [
        say(
            "Row {number}, time: {from_h} does not come after {before} in the row before.",
            number=number,
            from_h=time_text(step.from_h),
            before=before,
        )
    ]
