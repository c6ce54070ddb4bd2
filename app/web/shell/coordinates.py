"""Reads coordinates as maps, phones, receivers, and people write them; what may mean two places is refused.

A text is read in every way that its signs allow. One angle is the coordinate of its field. Otherwise, it must
have exactly one reading as a pair. No part of a text is left unread.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cache
from math import nan
from unicodedata import decimal

from app.base.message import Message, say, with_format, word
from app.tracker.values.minus import DASHES
from app.web.languages import pgettext
from app.web.shell.forms import Typed, Unreadable
from app.web.shell.map_links import is_link, linked

AXES = {"latitude": "NS", "longitude": "EW"}
LIMITS_DEG = {"latitude": 90.0, "longitude": 180.0}
LONGEST = 120
LONGEST_LINK = 2000

SIGNS = {
    "-": DASHES + "\u2014\u2015\u02d7\u207b\u2796\ufe58",
    "°": "\u00ba\u02da\u2070\u2218\u1d52度",
    "'": "\u2018\u2019\u201b\u2032\u2035\u00b4\u0060\u02b9\u02bc\u05f3分",
    '"': "\u201c\u201d\u201e\u201f\u2033\u2036\u02ba\u02dd\u05f4秒",
    ".": "\u066b",
    ";": "\t\n\r\u060c\u3001/|&",
    "φ": "\u03d5",
}
"""The signs that stand for one of ours."""
INVISIBLE = "\u200b\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2060\u2066\u2067\u2068\u2069\ufeff"
TABLE = {ord(other): sign for sign, others in SIGNS.items() for other in others} | dict.fromkeys(
    map(ord, INVISIBLE)
)
FULL_WIDTH, FULL_WIDTH_SHIFT = range(0xFF01, 0xFF5F), 0xFEE0

NUMBER = r"(?<![\d.,])\d{{1,{}}}(?:[.,]\d+)?(?![\d.,])"
DEGREES, PART = NUMBER.format(3), NUMBER.format(2)
LABELS = {
    "φ": "latitude|latitudine|latitud|lat|breitengrad|breite|enlem|纬°",
    "λ": "longitude|longitudine|longitud|long|lon|lng|längengrad|länge|boylam|经°",
}
WORDS = (
    *((rf"(?<![^\W\d_])(?:{names})(?![^\W\d_])\s*[.:=]?", sign) for sign, names in LABELS.items()),
    (r"([北南])纬|([东西])经", r"\1\2"),
    (r"(?<=\d)\s*deg(?:rees?)?(?![^\W\d_])", "°"),
    (r"(?<=\d)\s*min(?:utes?)?(?![^\W\d_])", "'"),
    (r"(?<=\d)\s*sec(?:onds?)?(?![^\W\d_])", '"'),
)
DMS_LETTERS = re.compile(rf"({DEGREES})\s*d\s*({PART})\s*(?:'|m(?:\s*({PART})\s*(s))?)", re.IGNORECASE)
ISO_6709 = re.compile(r"([+-]\d{2,6}(?:\.\d+)?)([+-]\d{3,7}(?:\.\d+)?)(?:[+-]\d+(?:\.\d+)?)?(?:CRSWGS_84)?")
NMEA = re.compile(r"(\d\d)(\d\d\.\d+),([NS]),(\d{3})(\d\d\.\d+),([EW])", re.IGNORECASE)
WHOLE_NUMBERS = re.compile(r"[+-]?\d+(?:,\s+|\s+,\s*)[+-]?\d+")
CODE = re.compile(
    r"[23456789CFGHJMPQRVWX]{2,8}\+[23456789CFGHJMPQRVWX]{0,3}(?:[\s;,].*)?"  # Plus Code
    r"|\d{1,2}\s*[C-X]\s*(?:[A-Z]{2}\s*[\d\s]*|[\s;]\s*\d{5,}.*)"  # MGRS, UTM
    r"|[A-R]{2}\d\d(?:[A-X]{2}\d{0,2})?"  # Maidenhead
    r"|;*[^\W\d_]+(?:[.。][^\W\d_]+){2}",  # what3words
    re.IGNORECASE,
)


class Refusal(StrEnum):
    """Why a text is not read."""

    FORM = "form"
    FRACTION = "fraction"
    SIXTY = "sixty"
    LETTER = "letter"
    SIGN = "sign"
    RANGE = "range"
    PAIR = "pair"
    CODE = "code"


class Refused(Exception):
    """A text is not read; `angle` is the one that is wrong where this is known."""

    def __init__(self, refusal: Refusal, angle: "Angle | None" = None) -> None:
        super().__init__(refusal)
        self.refusal = refusal
        self.angle = angle


@dataclass(frozen=True, slots=True)
class Angle:
    """One coordinate as it is written: degrees without a sign, its sign, and its letter in English.

    `axis` is what a letter or a label tells; `style` is the number of parts, and whether it has a degree
    sign.
    """

    degrees: float
    sign: str = ""
    side: str = ""
    axis: str = ""
    style: tuple[int, bool] = (1, False)

    def signed(self, chosen: str = "") -> float:
        """Return the degrees, south and west negative; `chosen` is the side of the button by the field."""
        side = self.side or chosen
        negative = side in ("S", "W")
        if side and ((self.sign and negative) or (self.sign == "-" and self.side)):
            raise Refused(Refusal.SIGN, replace(self, side=side))
        return -self.degrees if negative or self.sign == "-" else self.degrees


def angle(text: str, axis: str, chosen: str = "") -> float:
    """Return a signed latitude or longitude in degrees; `chosen` is the side of the button by the field."""
    try:
        found = _one(text)
        if found.axis not in ("", axis):
            raise Refused(Refusal.LETTER if found.side else Refusal.PAIR)
        return _within(found, axis, chosen)
    except Refused as refused:
        raise Unreadable(_sentence(refused, axis)) from None


def read(typed: Typed, axis: str, chosen: str = "") -> float:
    """Return the coordinate in a field of a form, NaN where the text is none."""
    return typed.read(axis, lambda text: angle(text, axis, chosen), nan)


def number(typed: Typed, name: str, label: str, least: float, most: float) -> float:
    """Return the coordinate in a field that asks for one, in any other a number within its range."""
    return read(typed, name) if name in AXES else typed.number(name, label, least, most)


def side(text: str, axis: str) -> str:
    """Return the side that the text of a coordinate names by its letter, nothing without one."""
    try:
        found = _one(text)
    except Refused:
        return ""
    return found.side if found.axis == axis else ""


def spread(texts: Mapping[str, str]) -> dict[str, str]:
    """Return the texts of both fields where one of them has a pair, nothing where none has or they differ."""
    pairs = {pair for axis in AXES if (pair := _pair_in(texts.get(axis, "")))}
    return dict(zip(AXES, pairs.pop(), strict=True)) if len(pairs) == 1 else {}


def degrees_text(value_deg: float) -> str:
    """Return an angle as a field shows it, to the centimeter."""
    return f"{value_deg:.7f}".rstrip("0").rstrip(".")


def _pair_in(text: str) -> tuple[str, ...]:
    """Return latitude and longitude of a text that has both, nothing for any other."""
    try:
        found = angles(text)
        if len(found) == 1:
            return ()
        return tuple(degrees_text(_within(one, axis)) for one, axis in zip(found, AXES, strict=True))
    except Refused:
        return ()


def _one(text: str) -> Angle:
    """Return the only coordinate of a text; a pair is first judged as a pair."""
    found, *others = angles(text)
    if others:
        for one, axis in zip((found, *others), AXES, strict=True):
            _within(one, axis)
        raise Refused(Refusal.PAIR)
    return found


def _within(found: Angle, axis: str, chosen: str = "") -> float:
    """Return the signed degrees of a latitude or longitude within its range."""
    value_deg = found.signed(chosen)
    if found.degrees > LIMITS_DEG[axis]:
        raise Refused(Refusal.RANGE, replace(found, axis=axis))
    return value_deg


def angles(text: str) -> tuple[Angle, ...]:
    """Return the one coordinate that a text is, or both, latitude first."""
    if len(text) > LONGEST_LINK:
        raise Refused(Refusal.FORM)
    if is_link(text.strip()):
        if found := linked(text.strip()):
            return tuple(Angle(abs(value), "-" * (value < 0)) for value in found)
        raise Refused(Refusal.CODE)
    plain = _plain(text)
    try:
        return _packed(plain) or _written(plain, _letters())
    except Refused as refused:
        if refused.refusal in (Refusal.FORM, Refusal.PAIR) and CODE.fullmatch(plain):
            raise Refused(Refusal.CODE) from None
        raise


def _letters() -> tuple[tuple[str, str], ...]:
    """Return the letters of the sides, English and the page's own; the page's own counts more."""
    own = {pgettext("compass", side).casefold(): side for side in "NSEW"}
    return tuple(({side.casefold(): side for side in "NSEW"} | own).items())


def _plain(text: str) -> str:
    """Return a text with one sign for each meaning, and without what is not visible."""
    if len(text) > LONGEST:
        raise Refused(Refusal.FORM)
    plain = "".join(map(_plain_letter, text.strip())).translate(TABLE)
    plain = re.sub(r"\s+", " ", plain.replace("''", '"')).rstrip(" .,;")
    return plain[1:-1].strip() if re.fullmatch(r"\([^()]*\)", plain) else plain


def _plain_letter(letter: str) -> str:
    if ord(letter) in FULL_WIDTH:
        letter = chr(ord(letter) - FULL_WIDTH_SHIFT)
    digit = decimal(letter, None)
    return letter if digit is None else str(digit)


def _packed(text: str) -> tuple[Angle, ...]:
    """Return both coordinates of ISO 6709 or NMEA 0183, where degrees and minutes are one number."""
    if match := NMEA.fullmatch(text):
        latitude, latitude_min, north, longitude, longitude_min, east = match.groups()
        return _pair(
            _angle((latitude, latitude_min, None), "", north.upper()),
            _angle((longitude, longitude_min, None), "", east.upper()),
        )
    if match := ISO_6709.fullmatch(text):
        latitude, longitude = (part.partition(".")[0] for part in match.groups())
        if len(latitude) % 2 == 1 and len(longitude) == len(latitude) + 1:
            return _pair(*(_digits(part, own) for part, own in zip(match.groups(), (2, 3), strict=True)))
    return ()


def _digits(text: str, wide: int) -> Angle:
    """Return an angle of ISO 6709: degrees of so many digits, minutes and seconds of two."""
    whole, _, decimals = text[1:].partition(".")
    parts: list[str | None] = [whole[:wide], *re.findall("..", whole[wide:])]
    parts[-1] = f"{parts[-1]}.{decimals or 0}"
    return _angle((*parts, None, None)[:3], text[0])


def _written(text: str, letters: tuple[tuple[str, str], ...]) -> tuple[Angle, ...]:
    """Return the coordinates of a text of numbers, signs, and letters."""
    if WHOLE_NUMBERS.fullmatch(text):
        raise Refused(Refusal.PAIR)
    for pattern, sign in WORDS:
        text = re.sub(pattern, sign, text, flags=re.IGNORECASE)
    text = DMS_LETTERS.sub(_marked, text)
    if re.search(r"\d\.\d", text):
        text = re.sub(r"(?<=\d),(?=\d)", ";", text)
    text = re.sub(r"\s*,\s+|\s+,|(?<!\d),|,(?!\d)", ";", text)
    parts = text.split(";")
    if len(parts) > 2 or re.search(r"\d,\d+,\d", text):
        raise Refused(Refusal.PAIR)
    if len(parts) == 2:
        first, second = (_read(part.strip(), letters) for part in parts)
        return _pair(first, second)
    try:
        return (_read(text, letters),)
    except Refused as refused:
        if refused.refusal not in (Refusal.FORM, Refusal.FRACTION):
            raise
        return _side_by_side(text, letters, refused)


def _marked(found: re.Match[str]) -> str:
    """Return `41d17m12s` with the usual marks; a capital S after the seconds may be South."""
    degrees, minutes, seconds, mark = found.groups()
    if mark == "S":
        raise Refused(Refusal.FORM)
    return f"{degrees}°{minutes}'" + (f'{seconds}"' if seconds else "")


@cache
def _pattern(letters: tuple[str, ...]) -> re.Pattern[str]:
    side = "|".join(map(re.escape, letters))
    return re.compile(
        rf"(?P<label>[φλ])?\s*(?P<before>{side})?\s*(?P<sign>[+-])?\s*(?P<degrees>{DEGREES})\s*"
        rf"(?P<mark>°|:|(?<=\d)-(?=\d))?\s*(?:(?P<minutes>{PART})\s*(?:[':]|(?<=\d)(?P<dash>-)(?=\d))?\s*"
        rf"(?:(?P<seconds>{PART})\s*\"?)?)?\s*(?P<after>{side})?",
        re.IGNORECASE,
    )


def _read(text: str, letters: tuple[tuple[str, str], ...]) -> Angle:
    """Return the one angle that a whole text is."""
    sides = dict(letters)
    match = _pattern(tuple(sides)).fullmatch(text)
    if match is None:
        raise Refused(Refusal.FORM)
    label, before, sign, degrees, mark, minutes, dash, seconds, after = match.groups()
    if before and after:
        raise Refused(Refusal.LETTER)
    letter = before or after or ""
    if "-" in (mark, dash) and not letter:
        raise Refused(Refusal.FORM)
    axis = {"φ": "latitude", "λ": "longitude", None: ""}[label]
    side = sides.get(letter.casefold(), "")
    found = _angle((degrees, minutes, seconds), sign or "", side, marked=mark == "°")
    if axis and found.axis not in ("", axis):
        raise Refused(Refusal.LETTER)
    return replace(found, axis=axis or found.axis)


def _angle(parts: tuple[str | None, ...], sign: str, side: str = "", *, marked: bool = False) -> Angle:
    """Return an angle of its parts; only the last may have decimals."""
    texts = [part.replace(",", ".") for part in parts if part is not None]
    if any("." in part for part in texts[:-1]):
        raise Refused(Refusal.FRACTION)
    degrees, minutes, seconds = (float(text) for text in (*texts, "0", "0")[:3])
    if minutes >= 60 or seconds >= 60:
        raise Refused(Refusal.SIXTY)
    axis = next((name for name, sides in AXES.items() if side and side in sides), "")
    return Angle(degrees + minutes / 60 + seconds / 3600, sign, side, axis, (len(texts), marked))


def _side_by_side(text: str, letters: tuple[tuple[str, str], ...], refused: Refused) -> tuple[Angle, ...]:
    """Return the pair that a text without a separator is, where it can be divided in one way only."""
    found: dict[tuple[str, str], tuple[Angle, Angle]] = {}
    for place in range(1, len(text)):
        left, right = text[:place].strip(), text[place:].strip()
        if {text[place - 1], text[place]} <= set("0123456789.,"):
            continue
        try:
            found[left, right] = _read(left, letters), _read(right, letters)
        except Refused as half:
            refused = refused if half.refusal is Refusal.FORM else half
    if not found:
        raise refused
    ((left, right), (first, second)), *others = found.items()
    alike = first.style == second.style or (first.axis and second.axis)
    is_apart = text[len(left) : -len(right)] == " "
    loose_sign = right[0] in "+-" and (not is_apart or right[1] == " ")
    if others or loose_sign or not alike:
        raise refused if refused.refusal is Refusal.FRACTION else Refused(Refusal.PAIR)
    return _pair(first, second)


def _pair(first: Angle, second: Angle) -> tuple[Angle, Angle]:
    """Return a pair with its latitude first: as letters or labels tell, otherwise as it is written."""
    match first.axis, second.axis:
        case ("latitude", "longitude") | ("", ""):
            return first, second
        case ("longitude", "latitude"):
            return second, first
    raise Refused(Refusal.PAIR)


def _sentence(refused: Refused, axis: str) -> Message:
    found = refused.angle or Angle(0.0)
    axis = found.axis or axis
    label = word(axis.capitalize())
    one, other = (pgettext("compass", side) for side in AXES[axis])
    match refused.refusal:
        case Refusal.FRACTION:
            return say("{label}: only the last number may have decimals, as in 41° 17.2'.", label=label)
        case Refusal.SIXTY:
            return say("{label}: minutes and seconds must be below 60.", label=label)
        case Refusal.LETTER:
            return say("{label}: the letter must be {one} or {other}.", label=label, one=one, other=other)
        case Refusal.SIGN:
            letter = pgettext("compass", found.side)
            return say(
                "{label}: leave out the plus or minus sign; {letter} already gives the direction.",
                label=label,
                letter=letter,
            )
        case Refusal.RANGE:
            return say(
                "{label} must be between 0 and {limit} degrees, {one} or {other}.",
                label=label,
                limit=with_format(LIMITS_DEG[axis], "g"),
                one=one,
                other=other,
            )
        case Refusal.PAIR:
            return say(
                "{label}: enter one coordinate per field, or both with a semicolon, latitude first, "
                "such as 41.2867; 36.33.",
                label=label,
            )
        case Refusal.CODE:
            return say(
                "{label}: this link or code has no latitude and longitude that can be read. Copy both in "
                "degrees from the map.",
                label=label,
            )
    return say(
        "{label}: type degrees such as 41.2867, or degrees, minutes, and seconds such as 41° 17' 12\".",
        label=label,
    )
