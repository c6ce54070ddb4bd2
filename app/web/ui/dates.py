"""Dates with the month in words, in the language of the request."""

from datetime import date

from babel.dates import format_date, format_skeleton

from app.web.languages import spoken
from app.web.languages.known import ENGLISH


def spelled(on: date) -> str:
    """Return a date such as `21 June 2026`."""
    language = spoken()
    return f"{on:%d %B %Y}" if language is ENGLISH else format_date(on, "long", locale=language.code)


def day_and_month(on: date) -> str:
    """Return a date such as `21 Jun`."""
    language = spoken()
    return f"{on:%d %b}" if language is ENGLISH else format_skeleton("MMMd", on, locale=language.code)
