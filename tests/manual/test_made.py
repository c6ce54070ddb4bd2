"""The pages of Reference are what the code says now, and every setting stands in the documents."""

import re

import pytest

from app.base.settings import FILE_VARIABLE, PREFIX, Settings
from tests.manual.made.pages import REFERENCE, pages
from tests.manual.site import ROOT

VARIABLES = {FILE_VARIABLE, *(PREFIX + name.upper() for name in Settings.model_fields)}
NAMED = re.compile(rf"\b{PREFIX}[A-Z_]+[A-Z]\b(?!_)")
OF_OTHERS = re.compile(rf"{PREFIX}(TEST_\w+|DOCS|SCREENS|SOAK|NAME)")
"""Variables of tests, and a word that stands for any name."""
MADE = ["alarms", "api", "commands", "errors", "mqtt-topics", "settings", "sizing", "sunspec-map"]
DOCUMENTS = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "deploy").glob("*.*")]


@pytest.fixture(scope="module")
def made() -> dict[str, str]:
    return pages()


@pytest.mark.parametrize("name", MADE)
def test_a_page_of_reference_is_what_the_code_says(name: str, made: dict[str, str]) -> None:
    assert (REFERENCE / f"{name}.md").read_text() == made[name], "Renew it with: make reference"


def test_every_page_that_is_made_is_looked_at(made: dict[str, str]) -> None:
    assert sorted(made) == MADE


def test_documents_name_every_setting_and_no_other() -> None:
    named = {name for document in DOCUMENTS for name in NAMED.findall(document.read_text())}
    assert VARIABLES - named == set()
    assert {name for name in named - VARIABLES if not OF_OTHERS.fullmatch(name)} == set()


def test_every_setting_says_what_it_does() -> None:
    assert [name for name, field in Settings.model_fields.items() if not field.description] == []
