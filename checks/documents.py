"""What the documents name exists: modules, names, places, links, tests, settings, pages, scopes of tokens."""

import ast
import re
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from app.access.tokens import SCOPES, Scope
from app.base.permission import Permission
from app.base.settings import FILE_VARIABLE, PREFIX, Settings

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
NAMED = re.compile(r"`((?:app|bench|tests|tools)/[\w/]+\.py):([\w.]+)`")
PLACES = re.compile(r"`((?:app|templates|static|tests|alembic|deploy|docs|bench|checks|tools)/[\w./-]*)`")
LINKS = re.compile(r"\]\((?!https?:|#|mailto:)([^)#\s]+)")
VARIABLE = re.compile(rf"\b{PREFIX}[A-Z_]+[A-Z]\b(?!_)")
OF_OTHERS = re.compile(rf"{PREFIX}(TEST_\w+|DOCS|SCREENS|SOAK|NAME)")
"""Variables of tests, and a word that stands for any name."""
SECTIONS = ("start", "operate", "install", "connect", "integrate", "reference", "explain", "develop")
MANUAL = "zensical.toml"
MAY = {
    Permission.READ: "read",
    Permission.STOP: "stop",
    Permission.OPERATE: "move",
    Permission.CONFIGURE: "set up",
    Permission.REPORT: "report weather",
    Permission.SIMULATE: "simulate",
}


def faults() -> Iterator[str]:
    """Yield what a document names and what is not there."""
    for document in DOCUMENTS:
        yield from (f"{document.relative_to(ROOT)}: {fault}: correct it." for fault in faults_of(document))
    yield from faults_of_security()
    yield from faults_of_settings()
    yield from faults_of_navigation()
    yield from faults_of_scopes()


def faults_of(document: Path) -> Iterator[str]:
    """Yield the names, places and links of a document that do not exist."""
    text = document.read_text()
    for module, name in NAMED.findall(text):
        if not (ROOT / module).exists() or name not in defined_in(ROOT / module):
            yield f"{module} has no {name}"
    yield from (f"{place} does not exist" for place in PLACES.findall(text) if not (ROOT / place).exists())
    for link in LINKS.findall(text):
        if not (document.parent / link).exists():
            yield f"the link to {link} leads nowhere"


@cache
def defined_in(path: Path) -> set[str]:
    """Return every name that a module defines, methods and fields as Class.name."""
    return {name for node in ast.parse(path.read_text()).body for name in _names(node, "")}


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


def faults_of_security() -> Iterator[str]:
    """Yield each test that SECURITY.md names and that does not exist."""
    texts = (path.read_text() for path in (ROOT / "tests").rglob("test_*.py"))
    known = {name for text in texts for name in re.findall(r"def (test_\w+)\(", text)}
    for name in re.findall(r"`(test_\w+)`", (ROOT / "SECURITY.md").read_text()):
        if name not in known:
            yield f"SECURITY.md: there is no test {name}: name the one that there is."


def faults_of_settings() -> Iterator[str]:
    """Yield settings that no document names, that there are not, and that have no description."""
    known = {FILE_VARIABLE, *(PREFIX + name.upper() for name in Settings.model_fields)}
    documents = [*DOCUMENTS, *(ROOT / "deploy").glob("*.*")]
    named = {name for document in documents for name in VARIABLE.findall(document.read_text())}
    yield from (f"No document names the setting {name}: run make reference." for name in known - named)
    for name in named - known:
        if not OF_OTHERS.fullmatch(name):
            yield f"A document names {name}, which is no setting: correct it."
    for name, field in Settings.model_fields.items():
        if not field.description:
            yield f"app/base/settings.py: {name} does not say what it does: describe it."


def faults_of_navigation() -> Iterator[str]:
    """Yield the pages of the manual that its navigation leaves out."""
    found = list(_listed(tomllib.loads((ROOT / MANUAL).read_text())["project"]["nav"]))
    for section in SECTIONS:
        for path in (ROOT / "docs" / section).rglob("*.md"):
            if (name := str(path.relative_to(ROOT / "docs"))) not in found:
                yield f"docs/{name} is not in the manual's navigation: name it in {MANUAL}."
    order = [one for one in dict.fromkeys(name.partition("/")[0] for name in found) if one in SECTIONS]
    if order != list(SECTIONS):
        yield f"{MANUAL}: the sections are to stand in this order: {', '.join(SECTIONS)}."


def _listed(entries: list[Any]) -> Iterator[str]:
    for entry in entries:
        for target in [entry] if isinstance(entry, str) else entry.values():
            yield from [target] if isinstance(target, str) else _listed(target)


def faults_of_scopes() -> Iterator[str]:
    """Yield a fault where the integrator's guide does not say what each scope may."""
    guide = "docs/integrate/integrators-guide.md"
    rows = [
        f"| `{scope}` | {', '.join(word for needs, word in MAY.items() if needs in SCOPES[scope])} |\n"
        for scope in Scope
    ]
    table = "| scope | may |\n| --- | --- |\n" + "".join(rows)
    if table + "\n" not in (ROOT / guide).read_text():
        yield f"{guide}: the table of scopes must be:\n{table}"
