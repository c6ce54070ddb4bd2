"""Tables of numbers as spreadsheets save them in any language: one reader of heads, cells, and numbers.

The separator is a semicolon, a tab, or a comma: that of a line `sep=;`, as Excel writes it, or of the row of
names. Where it is no comma, decimals have a point or a comma, the same in the whole table; three digits
behind the only one may be thousands where the column reaches a thousand, and are refused. Nothing is guessed.
"""

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass

from app.base.message import Message, say
from app.tracker.values.minus import with_minus

SEPARATORS = ";\t,"
EXCELS_LINE = re.compile(r'\s*"?sep=([;,\t])"?[;,\t ]*', re.IGNORECASE)
COMMENT = re.compile(r'\s*(?:#(?P<plain>.*)|"#(?P<quoted>(?:[^"]|"")*)"[;,\t ]*)')
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
DECIMAL = re.compile(r"[+-]?\d*([.,])\d+(?:e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
TWO_WAYS = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}", re.ASCII)
THOUSAND = 1000.0
TURKISH_I = str.maketrans("\N{LATIN CAPITAL LETTER I WITH DOT ABOVE}\N{LATIN SMALL LETTER DOTLESS I}", "ii")


class TableRefused(ValueError):
    """A table that cannot be read without a guess; the sentence names the row."""


@dataclass(frozen=True, slots=True)
class FileTable:
    """The rows of a file that are not empty, with the numbers of their lines, and how it writes decimals.

    `names` are those of the columns in small letters; `comments` are the texts of lines that begin with `#`.
    """

    comments: tuple[str, ...]
    names: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    decimal: str = "."
    settled: bool = True

    def number(self, text: str, row: int = 0, most: float = 0.0) -> float:
        """Return the number of a cell; `most` is the greatest one of a column that reaches a thousand.

        Raises `TableRefused` for one that may be thousands, `ValueError` for what is none.
        """
        plain = with_minus(text.strip())
        if not self.settled and most >= THOUSAND and TWO_WAYS.fullmatch(plain):
            whole, decimals = re.sub("[.,]", "", plain), re.sub("[.,]", ".", plain)
            raise TableRefused(
                say(
                    "Row {number}: {text} can be read in two ways. Write {thousands} or {decimals}0.",
                    number=row,
                    text=text.strip(),
                    thousands=whole,
                    decimals=decimals,
                )
            )
        plain = plain.replace(self.decimal, ".")
        if NUMBER.fullmatch(plain) is None:
            raise ValueError(text)
        return float(plain)


def read_table(text: str) -> FileTable:
    """Return the table of a text; one without any row has no names. Raises `TableRefused`."""
    comments: list[str] = []
    rows: list[tuple[int, tuple[str, ...]]] = []
    separator = ""
    for number, line in enumerate(_lines(text), start=1):
        excels = EXCELS_LINE.fullmatch(line)
        comment = COMMENT.fullmatch(line)
        if comment:
            quoted = (comment["quoted"] or "").replace('""', '"').removeprefix(" ")
            comments.append((comment["plain"] or "").rstrip(SEPARATORS + " ").strip() or quoted)
        elif excels and not rows:
            separator = excels[1]
        elif line.strip(" ,;\t"):
            separator = separator or _separator(number, line)
            rows.append((number, _cells(number, line, separator, len(rows[0][1]) if rows else 0)))
    if not rows:
        return FileTable(tuple(comments), (), ())
    names = tuple(name.translate(TURKISH_I).lower() for name in rows[0][1])
    decimal, settled = (".", True) if separator == "," else _decimal(rows[1:])
    return FileTable(tuple(comments), names, tuple(rows[1:]), decimal, settled)


def _lines(text: str) -> list[str]:
    return re.sub("\r\n?", "\n", text.removeprefix("\ufeff")).split("\n")


def _separator(number: int, names: str) -> str:
    used = [one for one in SEPARATORS if one in names.strip(" ")]
    if len(used) > 1:
        raise TableRefused(
            say(
                "Row {number}: separate the columns with semicolons, tabs, or commas, always the same.",
                number=number,
            )
        )
    return used[0] if used else ","


def _cells(number: int, line: str, separator: str, columns: int) -> tuple[str, ...]:
    """Return the cells of a line; empty ones behind the last column do not count."""
    try:
        cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True))
    except csv.Error:
        raise TableRefused(
            say("Row {number}: write quotation marks only around whole cells, in pairs.", number=number)
        ) from None
    while len(cells) > columns and not cells[-1].strip():
        cells.pop()
    return tuple(cell.strip() for cell in cells)


def _decimal(rows: list[tuple[int, tuple[str, ...]]]) -> tuple[str, bool]:
    """Return the sign of the decimals, and whether any number shows that it is not one of thousands."""
    found, settled = "", False
    for number, sign, cell in _decimals(rows):
        if found and sign != found:
            raise TableRefused(_mixed(number, cell))
        found, settled = sign, settled or TWO_WAYS.fullmatch(with_minus(cell)) is None
    return found or ".", settled


def _decimals(rows: list[tuple[int, tuple[str, ...]]]) -> Iterator[tuple[int, str, str]]:
    for number, cells in rows:
        for cell in cells:
            if decimal := DECIMAL.fullmatch(with_minus(cell)):
                yield number, decimal[1], cell


def _mixed(number: int, cell: str) -> Message:
    return say(
        "Row {number}: {cell} differs from the rows before. Use a decimal point, or a decimal comma, in all.",
        number=number,
        cell=cell,
    )
