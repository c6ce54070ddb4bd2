"""No text that a user can see, and no document, has a word that `docs/develop/words.md` rules out."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.web.translation.catalogues import template

ROOT = Path(__file__).parents[3]
TABLE = ROOT / "docs" / "develop" / "words.md"
SEARCHED = "app/web/features/guide/search_words.py"
"""Words that users may type into the search, former ones among them."""
SIGNED = "record"
"""Words of records: what was signed stays as it was."""
GIVEN = re.compile(r"Local machine|\bXia\b|OSHA|\{[^}]*\}|%\([^)]*\)s|`[^`]*`|<[^>]*>")
"""What others named: a menu of Windows, a paper, a standard; gaps, code, and tags."""
WORDS = "app/web/translation/words.py"
MEANT_OTHERWISE = {
    ("link loss", WORDS),
    ("nobody", WORDS),
    ("prove", "docs/explain/papers.md"),
    ("people", "docs/start/home-assistant.md"),
}
"""What is stored or signed under its name, a menu of another program, and what figures show."""


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
    for text in template():
        path, _ = text.locations[0] if text.locations else ("", 0)
        if text.id and path != SEARCHED and text.context != SIGNED:
            forms = text.id if isinstance(text.id, tuple) else (text.id,)
            yield from ((path, form) for form in forms)


def documents() -> list[Path]:
    """Return every document that is written for readers, but the table itself."""
    roots = [*ROOT.glob("*.md"), *(ROOT / "deploy").glob("*.md"), *(ROOT / "docs").rglob("*.md")]
    return sorted(path for path in roots if path != TABLE)


def written(document: str) -> Iterator[tuple[int, str]]:
    """Yield the numbered lines of a document outside of its blocks of code."""
    inside = False
    for number, line in enumerate(document.splitlines(), 1):
        if line.lstrip().startswith("```"):
            inside = not inside
        elif not inside:
            yield number, line


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


def test_a_block_of_code_is_not_a_sentence() -> None:
    text = "A tracker.\n```\nmachine\n```\nThe machine."
    assert [number for number, line in written(text) if found_in(line, ruled_out())] == [5]


def test_no_document_has_a_word_that_is_ruled_out() -> None:
    words = ruled_out()
    assert len(documents()) > 80
    wrong = [
        f"{name}:{number}: {word}: {line}"
        for path in documents()
        for name in (str(path.relative_to(ROOT)),)
        for number, line in written(path.read_text())
        for word in found_in(line, words)
        if (word.lower(), name) not in MEANT_OTHERWISE
    ]
    assert wrong == [], "\n".join(wrong)
