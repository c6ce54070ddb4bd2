"""Instants and lengths of time as programs and people write them, leap seconds included."""

import re
from datetime import UTC, date, datetime, timedelta
from typing import Annotated

from pydantic import AfterValidator, AwareDatetime, BeforeValidator, Strict

from app.base.message import say, with_format

FIRST_YEAR, LAST_YEAR = 1970, 2099
"""The years in which the sun is known and a clock can be right; a day more or less stays in the calendar."""
NUMBER = re.compile(r"\s*[-+]?[\d._]+(?:[eE][-+]?\d+)?\s*")
HOW_TO_WRITE = "Write the instant in ISO 8601 with its offset, such as 2026-06-21T12:00:00+03:00."
NOT_OF_THESE_TIMES = say("Enter a year from {first} to {last}.", first=FIRST_YEAR, last=LAST_YEAR)
DAY = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}")
NOT_A_DAY = "Write a day of the calendar as year-month-day, such as 2026-06-21."
LEAP_SECOND = re.compile(r"([T ]\d{2}:\d{2}):60(?:[.,]\d+)?(?=$|[Zz+-])")


def without_leap_second(text: str) -> str:
    """Return an ISO 8601 text with a second 60 as second 59, which no calendar of a computer has.

    A leap second ends at the same instant everywhere, so that its minute is :59, or :29 and :44 in zones that
    are half or a quarter of an hour off.
    """
    return LEAP_SECOND.sub(r"\1:59", text)


def _clamped(given: object) -> object:
    """Return what is to be read as an instant; a number, taken for seconds since 1970, is refused."""
    if isinstance(given, int | float) or (isinstance(given, str) and NUMBER.fullmatch(given)):
        raise ValueError(HOW_TO_WRITE)
    return without_leap_second(given) if isinstance(given, str) else given


def read_instant(text: str) -> datetime:
    """Return the instant that an ISO 8601 text means; raise `ValueError` for all but one of these times.

    It has no time zone where the text has none.
    """
    try:
        found = datetime.fromisoformat(without_leap_second(text))
    except ValueError:
        raise ValueError(HOW_TO_WRITE) from None
    return of_these_times(found)


def is_of_these_times(instant: datetime) -> bool:
    """Return whether an instant lies, in UTC, in the years that this software deals with."""
    if instant.tzinfo is not None and instant.year + 1 >= FIRST_YEAR and instant.year - 1 <= LAST_YEAR:
        instant = instant.astimezone(UTC)
    return FIRST_YEAR <= instant.year <= LAST_YEAR


def of_these_times(instant: datetime) -> datetime:
    """Return an instant of the years that this software deals with, or raise `ValueError`."""
    if not is_of_these_times(instant):
        raise ValueError(NOT_OF_THESE_TIMES)
    return instant


Instant = Annotated[AwareDatetime, Strict(False), BeforeValidator(_clamped), AfterValidator(of_these_times)]
"""An instant with its offset in what comes in; 23:59:60 is taken as 23:59:59, and a number is refused.

It is text in JSON: where a model is strict, the text would be refused behind a validator of ours.
"""


def _written_day(given: object) -> object:
    """Return what is to be read as a date; a number, which would be seconds since 1970, is refused."""
    if isinstance(given, date):
        return given
    if not isinstance(given, str) or DAY.fullmatch(given) is None:
        raise ValueError(NOT_A_DAY)
    try:
        return date.fromisoformat(given)
    except ValueError as error:
        raise ValueError(NOT_A_DAY) from error


Day = Annotated[date, BeforeValidator(_written_day)]
"""A civil date in what comes in."""


def duration(value: timedelta | float) -> str:
    """Return a length of time such as `3 min`, `3 min 05 s` or `15 h 12 min`."""
    total_s = round(value.total_seconds() if isinstance(value, timedelta) else value)
    hours, rest = divmod(abs(total_s), 3600)
    minutes, seconds = divmod(rest, 60)
    if hours:
        return say("{hours} h {minutes} min", hours=hours, minutes=with_format(minutes, "02d"))
    if minutes and seconds:
        return say("{minutes} min {seconds} s", minutes=minutes, seconds=with_format(seconds, "02d"))
    return say("{minutes} min", minutes=minutes) if minutes else f"{seconds} s"
