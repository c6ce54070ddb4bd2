"""Texts: current catalogues, words that are ruled out, marks that Babel passes over, English in gaps.

It tells, too, how much of each language is translated: what is not is shown in English until a release.
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from babel.messages.catalog import Catalog

from app.web.languages.catalogue import GAP
from app.web.languages.known import TRANSLATED
from app.web.languages.script_texts import script_texts
from app.web.translation.catalogues import faults as stale
from app.web.translation.catalogues import identity, read, template, untranslated
from checks.sources import trees

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "docs" / "develop" / "words.md"
MARKS = ("say", "N_")
LETTERS = re.compile(r"[A-Za-z]{2}")
NOT_SHOWN = ("cli", "servers")
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


def faults() -> Iterator[str]:
    """Yield what is wrong with the texts of the sources and of the documents."""
    fresh = template()
    yield from stale(fresh)
    for code in TRANSLATED:
        if missing := len(untranslated(read(code))):
            of = sum(bool(text.id) for text in fresh)
            sys.stdout.write(f"{code}: {of - missing} of {of} texts are translated; a release needs all.\n")
    names = [identity(text.context, text.id) for text in fresh if text.id]
    if len(names) != len(set(names)):
        yield "Two texts have one identity: make app/web/translation/catalogues.py:identity longer."
    yield from faults_of_marks(fresh)
    yield from faults_of_words(fresh)


def forms(fresh: Catalog) -> Iterator[tuple[str, str, str | None]]:
    """Yield each form of each text, with where it stands and its context."""
    for text in fresh:
        path, _ = text.locations[0] if text.locations else ("", 0)
        for form in text.id if isinstance(text.id, tuple) else (text.id,):
            yield path, form, text.context


def faults_of_marks(fresh: Catalog) -> Iterator[str]:
    """Yield the marked texts that Babel does not find, and the English words in the gaps of sentences."""
    found = {form for _, form, _ in forms(fresh)}
    for text in set(script_texts()) - found:
        yield f"The scripts' text {text!r} is not found: mark it with N_."
    for name, tree in trees().items():
        for text in marked(tree):
            if text not in found and any(map(str.isalpha, GAP.sub("", text))):
                yield f"{name}: Babel passes over {text!r}: mark it outside of f-strings and brackets."
        if not set(NOT_SHOWN) & set(name.split(".")):
            for line in english_values(tree):
                yield f"{name}:{line}: an English word is put into a sentence: make it a message of its own."


def marked(tree: ast.AST) -> Iterator[str]:
    """Yield the texts that a module marks."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id=name), args=[ast.Constant(value=str(text)), *_]) if name in MARKS:
                yield text


def is_english(value: ast.expr) -> bool:
    """Return whether words are written where a value is made, not marked as a message."""
    match value:
        case ast.Constant(value=str(text)):
            return bool(LETTERS.search(text))
        case ast.JoinedStr(values=parts):
            return any(isinstance(part, ast.Constant) and is_english(part) for part in parts)
        case ast.IfExp(body=one, orelse=other):
            return is_english(one) or is_english(other)
        case ast.Call(func=ast.Attribute(attr="join", value=between)):
            return is_english(between)
        case _:
            return False


def english_values(tree: ast.AST) -> Iterator[int]:
    """Yield the lines of sentences with English words among their values, written there or just before."""
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        inside = list(ast.walk(function))
        named = {
            target.id
            for one in inside
            if isinstance(one, ast.Assign) and is_english(one.value)
            for target in one.targets
            if isinstance(target, ast.Name)
        }
        for call in inside:
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "say":
                values = [one.value for one in call.keywords]
                if any(is_english(one) or (isinstance(one, ast.Name) and one.id in named) for one in values):
                    yield call.lineno


def faults_of_words(fresh: Catalog) -> Iterator[str]:
    """Yield the words of texts and documents that docs/develop/words.md rules out."""
    pattern = ruled_out()
    for path, form, context in forms(fresh):
        if form and path != SEARCHED and context != SIGNED:
            yield from _ruled_out_in(form, pattern, path)
    roots = [*ROOT.glob("*.md"), *(ROOT / "deploy").glob("*.md"), *(ROOT / "docs").rglob("*.md")]
    for document in sorted(path for path in roots if path != TABLE):
        for number, line in sentences(document.read_text()):
            yield from _ruled_out_in(line, pattern, str(document.relative_to(ROOT)), number)


def ruled_out() -> re.Pattern[str]:
    """Return what finds the words of the table's last column, but not within a longer word."""
    rows = [line.split("|") for line in TABLE.read_text().splitlines() if line.startswith("| ")]
    words = {word.strip() for row in rows[2:] for word in row[3].split(",") if word.strip()}
    longest = sorted(words, key=len, reverse=True)
    return re.compile(rf"(?<![\w-])({'|'.join(map(re.escape, longest))})(?:s|es)?(?![\w-])", re.IGNORECASE)


def _ruled_out_in(text: str, pattern: re.Pattern[str], path: str, line: int = 0) -> Iterator[str]:
    for word in pattern.findall(GIVEN.sub(" ", text)):
        if (word.lower(), path) not in MEANT_OTHERWISE:
            yield f"{path}:{line or ''} {word!r} is ruled out by docs/develop/words.md: {text}"


def sentences(document: str) -> Iterator[tuple[int, str]]:
    """Yield the numbered lines of a document outside of its blocks of code."""
    inside = False
    for number, line in enumerate(document.splitlines(), 1):
        if line.lstrip().startswith("```"):
            inside = not inside
        elif not inside:
            yield number, line
