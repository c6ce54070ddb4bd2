"""Files that are made of the code are what the code makes now."""

import re
from collections.abc import Iterator
from itertools import zip_longest
from math import isclose
from pathlib import Path

from app.research.document import document
from app.research.library import papers
from app.web.documented import written
from app.web.openapi import DOCUMENT
from tests.fakes import fake_app
from tools.fault_table import proofs, rows
from tools.manual.made.pages import REFERENCE, pages

ROOT = Path(__file__).resolve().parents[1]
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def faults() -> Iterator[str]:
    """Yield the files that are not current, with the command that makes them anew."""
    if DOCUMENT.read_text() != written(fake_app()):
        yield f"{DOCUMENT.relative_to(ROOT)} is not current: run python -m app.web.openapi."
    for name, text in pages().items():
        if (REFERENCE / f"{name}.md").read_text() != text:
            yield f"docs/reference/{name}.md is not what the code says: run make reference."
    kept = (ROOT / "docs" / "explain" / "papers.md").read_text()
    if not alike(kept, document(papers())):
        path = "docs/explain/papers.md"
        yield f"{path} is not current: run heliopanel papers --markdown > {path}."
    numbers, proven = [row.number for row in rows()], proofs().keys()
    if numbers != sorted(set(numbers)):
        yield "tests/golden/fault_table.csv: the rows must be in their order, each once."
    for number in sorted(set(numbers) ^ proven):
        yield f"Row {number} of tests/golden/fault_table.csv and the tests with its mark do not match."


def alike(kept: str, now: str) -> bool:
    """Return whether words are the same to the letter, and numbers to a hundredth, on any processor."""
    pairs = zip_longest(NUMBER.findall(kept), NUMBER.findall(now), fillvalue="nan")
    same = all(isclose(float(one), float(other), rel_tol=0.01, abs_tol=0.001) for one, other in pairs)
    return same and NUMBER.sub("#", kept).strip() == NUMBER.sub("#", now).strip()
