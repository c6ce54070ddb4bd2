"""What Babel finds by `babel.cfg` is what the program says: nothing that is marked is passed over."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.web.languages.catalogue import GAP
from app.web.languages.script_texts import script_texts
from app.web.translation.catalogues import ROOT, template

MARKS = ("say", "N_")


@pytest.fixture(scope="module")
def found() -> set[str]:
    return {form for text in template() for form in (text.id if isinstance(text.id, tuple) else (text.id,))}


def marked(path: Path) -> Iterator[str]:
    """Return the texts that a module marks, read from its syntax tree."""
    for node in ast.walk(ast.parse(path.read_text())):
        match node:
            case ast.Call(func=ast.Name(id=name), args=[ast.Constant(value=str(text)), *_]) if name in MARKS:
                yield text


def test_every_marked_text_of_every_module_is_found(found: set[str]) -> None:
    """Babel passes over a mark within an f-string, or in brackets behind another call."""
    texts = {text for path in (ROOT / "app").rglob("*.py") for text in marked(path)}
    assert len(texts) > 2000
    assert {text for text in texts - found if any(map(str.isalpha, GAP.sub("", text)))} == set()


def test_every_text_of_a_script_is_found(found: set[str]) -> None:
    assert "Tracking" in script_texts()
    assert set(script_texts()) - found == set()


def test_texts_come_from_templates_scripts_modules_profiles_and_documents() -> None:
    places = {path for text in template() for path, _ in text.locations}
    assert {path.split("/")[0] for path in places} == {"templates", "static", "app", "docs"}
    assert any(path.endswith(".toml") for path in places)
