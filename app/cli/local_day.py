"""A day of the calendar as an option of a command."""

from datetime import date

from app.sun.accuracy import FIRST_YEAR, LAST_YEAR


def local_day(text: str) -> date:
    """Return the day that an option means, or raise `ValueError` with the sentence that says what to type."""
    try:
        found = date.fromisoformat(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a day of the calendar: type it as 2026-06-21.") from None
    if not FIRST_YEAR <= found.year <= LAST_YEAR:
        raise ValueError(f"Choose a day in the years {FIRST_YEAR} to {LAST_YEAR}, not {text}.")
    return found
