"""Numbers as people write them, thousands apart or not: read, never guessed, and written.

Three digits after one comma or point are decimals to one reader and thousands to another. Fields that take
thousands ask which is meant; there, a number with three decimals is written with a zero more.
"""

import re
from decimal import Decimal
from unicodedata import decimal, normalize

from app.tracker.values.minus import with_minus

THOUSAND = 1000
DIGITS = 10
POINT = "\N{ARABIC DECIMAL SEPARATOR}"
SIGNS = str.maketrans(
    {
        "\N{NO-BREAK SPACE}": " ",
        "\N{FIGURE SPACE}": " ",
        "\N{THIN SPACE}": " ",
        "\N{NARROW NO-BREAK SPACE}": " ",
        "\N{IDEOGRAPHIC SPACE}": " ",
        "\N{RIGHT SINGLE QUOTATION MARK}": "'",
        "\N{ARABIC THOUSANDS SEPARATOR}": "'",
        "\N{FULLWIDTH FULL STOP}": ".",
        "\N{FULLWIDTH COMMA}": ",",
        "\N{MASCULINE ORDINAL INDICATOR}": "°",
        "\N{RING ABOVE}": "°",
    }
)
"""The signs that stand for one of ours."""
GROUPS = r"[1-9]\d{0,2}(?P<apart>[ '.,])\d{3}(?:(?P=apart)\d{3})*"
LAKHS = r"[1-9]\d?(?P<lakh>,)(?:\d\d,)+\d{3}"
NUMBER = re.compile(
    rf"(?P<sign>[+-]?) *(?P<whole>\d+|{GROUPS}|{LAKHS}|(?=[.,{POINT}]\d))"
    rf"(?:(?!(?P=apart)|(?P=lakh))[.,{POINT}](?P<part>\d*))?"
)
EITHER = re.compile(r"([+-]?) *([1-9]\d{0,2})[.,](\d{3})")
WITH_UNIT = re.compile(r"(.*\d[.,]?) *([^\d., ][^\d.,]*(?:m\^?2)?)")


def plain(text: str, unit: str = "") -> str:
    """Return a typed number in the signs that programs read, without the unit of its field."""
    found = "".join(_digit(letter) for letter in with_minus(text).translate(SIGNS)).strip()
    with_unit = WITH_UNIT.fullmatch(found)
    return with_unit[1] if with_unit and unit and _key(with_unit[2]) == _key(unit) else found


def value(number: str) -> float | None:
    """Return what a plain number means, decimals where they may be thousands; None where it is none."""
    match = NUMBER.fullmatch(number)
    if match is None:
        return None
    whole = re.sub(r"\D", "", match["whole"])
    return float(f"{match['sign']}{whole or '0'}.{match['part'] or '0'}")


def two_ways(number: str) -> tuple[str, str] | None:
    """Return how to type a number whose decimals may be thousands in both ways; None where it means one."""
    match = EITHER.fullmatch(number)
    if match is None:
        return None
    sign, whole, part = match.groups()
    return f"{sign}{whole}{part}", written(float(f"{sign}{whole}.{part}"), THOUSAND)


def has_unit(number: str) -> bool:
    """Return whether a number is followed by something else, such as a unit."""
    with_unit = WITH_UNIT.fullmatch(number)
    return with_unit is not None and value(with_unit[1]) is not None


def written(number: float, most: float = 0.0, digits: int | None = DIGITS) -> str:
    """Return a number as its field shows it, with all of its digits for None; `most` ends its range."""
    text = format(Decimal(str(number) if digits is None else f"{number:.{digits}g}"), "f")
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return text + "0" * bool(most >= THOUSAND and EITHER.fullmatch(text))


def _digit(letter: str) -> str:
    value = decimal(letter, None)
    return letter if value is None else str(value)


def _key(unit: str) -> str:
    return normalize("NFKC", unit).casefold().replace("^", "").strip()
