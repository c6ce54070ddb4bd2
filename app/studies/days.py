"""Which days of a year a study works out, and how much of the year each stands for."""

from datetime import date, timedelta

from app.studies.request import Span

REPRESENTATIVE = (17, 15, 16, 15, 15, 10, 17, 16, 16, 16, 15, 10)
"""The day of each month in C. Alexandru's Table 4 (doi:10.3390/math12071034)."""


def days_of(span: Span, on: date) -> tuple[tuple[date, ...], tuple[float, ...]]:
    """Return the days and the number of days that each stands for; a year has no 29 February."""
    match span:
        case Span.DAY:
            return (on,), (1.0,)
        case Span.TWELVE_DAYS:
            days = tuple(date(on.year, month, day) for month, day in enumerate(REPRESENTATIVE, start=1))
            return days, tuple(_month_days(on.year, month) for month in range(1, 13))
        case Span.YEAR:
            first = date(on.year, 1, 1)
            year = (first + timedelta(number) for number in range(366))
            days = tuple(day for day in year if day.year == on.year and (day.month, day.day) != (2, 29))
            return days, (1.0,) * len(days)


def _month_days(year: int, month: int) -> float:
    """Return the length of a month of a year of 365 days."""
    after = date(year + month // 12, month % 12 + 1, 1)
    return float((after - date(year, month, 1)).days) if month != 2 else 28.0
