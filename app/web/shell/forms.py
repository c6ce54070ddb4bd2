"""Reads what people type: numbers with comma or point, dates, and times of day."""

import re
from collections.abc import Callable, Iterable, Mapping
from datetime import date, datetime, time
from math import nan
from typing import TypeVar

from starlette.requests import Request

from app.base.message import Message, say, told_by, with_format, word
from app.base.names import clean
from app.base.zones import zone_of
from app.sun.accuracy import FIRST_YEAR, LAST_YEAR
from app.tracker.values import typed_numbers
from app.web.http.whole_forms import FormIncomplete
from app.web.shell.contexts import Field, Form

T = TypeVar("T")
LEAP_SECOND = 60
TIME = re.compile(r"\s*(\d{1,2})[:.h](\d{2})(?:[:.](\d{2}))?\s*")


class Unreadable(ValueError):
    """What was typed cannot be used; the text says what to type instead."""


class Typed:
    """The texts of one form, and what is wrong with each."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self.texts = dict(texts)
        self.errors: dict[str, Message] = {}

    def text(self, name: str) -> str:
        """Return a text as it was typed, or raise `FormIncomplete`: what the form lacks is not empty."""
        if name not in self.texts:
            raise FormIncomplete
        return self.texts[name].strip()

    def read(self, name: str, reader: Callable[[str], T], instead: T) -> T:
        """Return what a text means; where it means nothing keep the reason and return `instead`."""
        try:
            return reader(self.text(name))
        except Unreadable as error:
            self.errors[name] = told_by(error)
            return instead

    def number(self, name: str, label: str, least: float, most: float, unit: str = "") -> float:
        """Return a number within its range, NaN where the text is none."""
        return self.read(name, lambda text: number(text, label, least, most, unit), nan)

    def whole(self, name: str, label: str, least: int, most: int, unit: str = "") -> int:
        """Return a whole number within its range."""
        return self.read(name, lambda text: whole(text, label, least, most, unit), least)

    def day(self, name: str, label: str) -> date:
        """Return a date."""
        return self.read(name, lambda text: day(text, label), date.min)

    def clock_time(self, name: str, label: str) -> time:
        """Return a time of day."""
        return self.read(name, lambda text: clock_time(text, label), time.min)

    def form(self, names: Iterable[str]) -> Form:
        """Return the fields as they were typed, with their errors."""
        return {name: Field(name, self.texts.get(name, ""), self.errors.get(name)) for name in names}


async def sent(request: Request) -> Typed:
    """Return the texts of the form that a request brings."""
    return Typed({name: text for name, text in (await request.form()).items() if isinstance(text, str)})


def number(text: str, label: str, least: float, most: float, unit: str = "") -> float:
    """Return the number that a text with a comma or a point means; `unit` may stand behind it."""
    plain = typed_numbers.plain(text, unit)
    if most >= typed_numbers.THOUSAND:
        _refuse_two_ways(plain, label)
    value = typed_numbers.value(plain)
    if value is None and typed_numbers.has_unit(plain):
        raise Unreadable(say("{label}: type the number alone, without a unit.", label=word(label)))
    if value is None:
        raise Unreadable(
            say(
                "{label}: type a number, such as {least}.",
                label=word(label),
                least=with_format(least, ".10g"),
            )
        )
    if not least <= value <= most:
        raise Unreadable(
            say(
                "{label} must be between {least} and {most}.",
                label=word(label),
                least=with_format(least, ".10g"),
                most=with_format(most, ".10g"),
            )
        )
    return value


def whole(text: str, label: str, least: int, most: int, unit: str = "") -> int:
    """Return the whole number that a text means; decimals of zeros may always be thousands."""
    plain = typed_numbers.plain(text, unit)
    if plain.endswith("000"):
        _refuse_two_ways(plain, label)
    value = typed_numbers.value(plain)
    if value is not None and not value.is_integer():
        raise Unreadable(say("{label} must be a whole number.", label=word(label)))
    return int(number(plain, label, least, most))


def _refuse_two_ways(plain: str, label: str) -> None:
    """Raise `Unreadable` where the decimals of a number may be thousands."""
    if ways := typed_numbers.two_ways(plain):
        thousands, decimals = (with_format(float(way), f".{_decimals(way)}f") for way in ways)
        raise Unreadable(
            say(
                "{label}: {text} can be read in two ways. Type {thousands} or {decimals}.",
                label=word(label),
                text=plain,
                thousands=thousands,
                decimals=decimals,
            )
        )


def _decimals(text: str) -> int:
    return len(text.partition(".")[2])


def clean_name(text: str) -> str:
    """Return a typed name or title as it is stored."""
    try:
        return clean(text)
    except ValueError as error:
        raise Unreadable(told_by(error)) from error


def day(text: str, label: str) -> date:
    """Return the date that a text such as 2026-06-21 means."""
    try:
        found = date.fromisoformat(text)
    except ValueError:
        raise Unreadable(say("{label}: type a date such as 2026-06-21.", label=word(label))) from None
    if not FIRST_YEAR <= found.year <= LAST_YEAR:
        raise Unreadable(
            say(
                "{label}: choose a day in the years {first_year} to {last_year}.",
                label=word(label),
                first_year=FIRST_YEAR,
                last_year=LAST_YEAR,
            )
        )
    return found


def clock_time(text: str, label: str) -> time:
    """Return the time of day that a text such as 05:12 or 05:12:30 means."""
    match = TIME.fullmatch(text)
    if match is None:
        raise Unreadable(say("{label}: type a time such as 05:12 or 17:45:30.", label=word(label)))
    hour, minute, second = (int(part or 0) for part in match.groups())
    second = 59 if second == LEAP_SECOND else second
    if hour > 23 or minute > 59 or second > 59:
        raise Unreadable(say("{label} must be between 00:00 and 23:59:59.", label=word(label)))
    return time(hour, minute, second)


def in_zone(on: date, at: time, zone: str) -> datetime:
    """Return the instant at which the clocks of a zone show this date and time."""
    return datetime.combine(on, at, zone_of(zone))
