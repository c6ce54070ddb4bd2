"""What the documents say exists, exists."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
NAMED = re.compile(r"`((?:app|bench|tests)/[\w/]+\.py):([\w.]+)`")
PLACES = re.compile(r"`((?:app|templates|static|tests|alembic|deploy|docs|bench)/[\w./-]*)`")
MEASURED = re.compile(r"\*\*([\d.,]+(?: ?[a-z]+)?)\*\*", re.IGNORECASE)
LINKS = re.compile(r"\]\((?!https?:|#|mailto:)([^)#\s]+)")


def defined_in(path: Path) -> set[str]:
    """Return every name that a module defines, methods and fields as Class.name."""
    names: set[str] = set()
    for node in ast.parse(path.read_text()).body:
        names |= _names(node, "")
    return names


def _names(node: ast.stmt, prefix: str) -> set[str]:
    match node:
        case ast.ClassDef():
            inner = {name for child in node.body for name in _names(child, f"{prefix}{node.name}.")}
            return {prefix + node.name} | inner
        case ast.FunctionDef() | ast.AsyncFunctionDef():
            return {prefix + node.name}
        case ast.AnnAssign(target=ast.Name(id=name)):
            return {prefix + name}
        case ast.Assign():
            return {prefix + target.id for target in node.targets if isinstance(target, ast.Name)}
        case _:
            return set()


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_name_in_a_document_exists(document: Path) -> None:
    missing = [
        f"{module}:{name}"
        for module, name in NAMED.findall(document.read_text())
        if not (ROOT / module).exists() or name not in defined_in(ROOT / module)
    ]
    assert not missing


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_place_and_link_in_a_document_exists(document: Path) -> None:
    text = document.read_text()
    missing = [place for place in PLACES.findall(text) if not (ROOT / place).exists()]
    missing += [link for link in LINKS.findall(text) if not (document.parent / link).exists()]
    assert not missing


def test_every_measured_number_of_the_readme_is_in_the_document_that_its_line_links() -> None:
    lines = [line for line in (ROOT / "README.md").read_text().splitlines() if MEASURED.search(line)]
    assert lines
    for line in lines:
        linked = " ".join((ROOT / link).read_text() for link in LINKS.findall(line))
        gone = [number for number in MEASURED.findall(line) if number not in linked]
        assert not gone, f"The README says {gone}, which was measured anew; write the new number in: {line}"


def test_the_readme_can_be_read_in_a_minute() -> None:
    assert len((ROOT / "README.md").read_text().splitlines()) <= 70
