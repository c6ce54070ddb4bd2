"""What a drive profile says of its registers in every language; the maker's names and numbers stay."""

import re
from collections.abc import Iterator

import pytest

from app.drives.profile import known_profiles, load_profile
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import TRANSLATED

MADE = re.compile(
    r"0x\w+|\b[A-Z]+\d+[\w-]*|\b\d{2,}\b|Kinco|Leadshine|Oriental Motor|Delta|SunSpec|heliopanel"
)
KEPT = "Oriental Motor FAQ 0331"
"""Names and numbers alone, which some languages write as English does."""


def sentences() -> Iterator[str]:
    """Return everything of several words that the profiles say."""
    for profile in map(load_profile, known_profiles()):
        told = [profile.title, profile.source, profile.watchdog.action if profile.watchdog else ""]
        told += [text for one in profile.registers.values() for text in (one.text, one.source)]
        yield from (text for text in told if " " in text and text != KEPT)


@pytest.mark.parametrize("code", TRANSLATED)
def test_profiles_speak_the_language_and_keep_names_and_numbers(code: str) -> None:
    said = {text: catalogue_of(code).word(text) for text in sentences()}
    assert len(said) > 100
    assert [text for text, other in said.items() if text == other] == []
    assert {
        text: other
        for text, other in said.items()
        if sorted(set(MADE.findall(text))) != sorted(set(MADE.findall(other)))
    } == {}
