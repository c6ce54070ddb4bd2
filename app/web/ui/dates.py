"""Dates with the month in words, in the language of the request."""

from datetime import date

from babel.dates import format_date, format_skeleton

from app.web.languages import spoken

ENGLISH = "en"


def spelled(on: date) -> str:
    """Return a date such as `21 June 2026`."""
    code = spoken().code
    return f"{on:%d %B %Y}" if code == ENGLISH else format_date(on, "long", locale=code)


def day_and_month(on: date) -> str:
    """Return a date such as `21 Jun`."""
    code = spoken().code
    return f"{on:%d %b}" if code == ENGLISH else format_skeleton("MMMd", on, locale=code)
