"""No text that a user can see has a word that `docs/develop/words.md` rules out."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.web.languages.extraction import texts

TABLE = Path(__file__).parents[3] / "docs" / "develop" / "words.md"
SEARCHED = "app/web/ui/search_words.py"
"""Words that users may type into the search, former ones among them."""
SIGNED = "app/web/record_words.py"
"""Words of records: what was signed stays as it was."""
GIVEN = re.compile(r"Local machine|\bXia\b|OSHA|\{[^}]*\}|%\([^)]*\)s|`[^`]*`|<[^>]*>")
"""What others named: a menu of Windows, a paper, a standard; gaps, code, and tags."""
MEANT_OTHERWISE = {
    ("machine", "docs/reference/glossary.md"),
    ("link loss", "app/tracker/drive_tests.py"),
    ("nobody", "app/access/principal.py"),
}
"""The glossary explains a word; the others are stored and signed under their names."""


def ruled_out() -> list[str]:
    """Return what the last column of the table says, the longest first."""
    rows = [line.split("|") for line in TABLE.read_text().splitlines() if line.startswith("| ")]
    words = {word.strip() for row in rows[2:] for word in row[3].split(",") if word.strip()}
    return sorted(words, key=len, reverse=True)


def found_in(text: str, words: list[str]) -> list[str]:
    """Return the words that a text must not have; what stands within a longer word does not count."""
    plain = GIVEN.sub(" ", text)
    pattern = r"(?<![\w-])(" + "|".join(map(re.escape, words)) + r")(?:s|es)?(?![\w-])"
    return re.findall(pattern, plain, re.IGNORECASE)


def spoken() -> Iterator[tuple[str, str]]:
    for text in texts():
        if text.path not in (SEARCHED, SIGNED):
            yield from ((text.path, one) for one in (text.one, text.many) if one)


def test_the_table_is_read() -> None:
    assert {"zeroed", "door", "whoever", "typhoon"} <= set(ruled_out())


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("The Machine has stopped.", ["Machine"]),
        ("The doors of MQTT", ["door"]),
        ("machine-readable, outdoors, inpeople", []),
        ("Press Next, Install certificate, Local machine.", []),
        ("Nobody is signed in; {whoever} was.", ["Nobody"]),
    ],
)
def test_a_word_that_is_ruled_out_is_found(text: str, found: list[str]) -> None:
    assert found_in(text, ruled_out()) == found


def test_no_text_has_a_word_that_is_ruled_out() -> None:
    words = ruled_out()
    wrong = [
        f"{path}: {word}: {text}"
        for path, text in spoken()
        for word in found_in(text, words)
        if (word.lower(), path) not in MEANT_OTHERWISE
    ]
    assert wrong == [], "\n".join(wrong)
