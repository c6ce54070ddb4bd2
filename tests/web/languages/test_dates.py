"""Dates in words are those of the CLDR, in every language that is translated."""

from datetime import date, timedelta

import pytest
from babel.dates import format_date, format_skeleton

from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.languages.dates import WRITTEN, day_and_month, spelled
from app.web.languages.known import LANGUAGES, TRANSLATED

NEW_YEAR = date(2026, 1, 1)


def in_both_lengths(code: str, on: date) -> tuple[str, str]:
    before = CATALOGUE.set(catalogue_of(code))
    try:
        return spelled(on), day_and_month(on)
    finally:
        CATALOGUE.reset(before)


@pytest.mark.parametrize("code", TRANSLATED)
def test_dates_are_written_as_the_cldr_has_them(code: str) -> None:
    for days in range(365):
        on = NEW_YEAR + timedelta(days=days)
        cldr = format_date(on, "long", locale=code), format_skeleton("MMMd", on, locale=code)
        assert in_both_lengths(code, on) == cldr


def test_english_ones_are_as_they_were() -> None:
    assert in_both_lengths("en", date(2026, 6, 2)) == ("02 June 2026", "02 Jun")
    assert WRITTEN.keys() == LANGUAGES.keys()
