"""The table of recipes in docs/develop/contributing.md names the files that the tests change and add."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from tests.soak.built.recipes import test_recipe_of_a_drive_profile as drive_profile
from tests.soak.built.recipes import test_recipe_of_a_language as language
from tests.soak.built.recipes import test_recipe_of_a_page as page
from tests.soak.built.recipes import test_recipe_of_a_protection as protection
from tests.soak.built.recipes import test_recipe_of_a_setting as setting
from tests.soak.built.recipes import test_recipe_of_an_alarm as alarm
from tests.soak.built.recipes.program_copy import ROOT

DOCUMENT = ROOT / "docs/develop/contributing.md"
ROW = re.compile(r"^\| (an? [a-z ]+) \| (\d+) \| (.*) \| (.*) \|$", re.MULTILINE)
PATH = re.compile(r"`([^`]+)`")


class Files(NamedTuple):
    """How many files a recipe needs, those it changes, and the folders of those it adds."""

    number: int
    changed: frozenset[str]
    folders: frozenset[str]


FOLLOWED: Mapping[str, tuple[Iterable[str], Iterable[str]]] = {
    "a setting of a tracker": (setting.EDITS, ()),
    "an alarm": (alarm.EDITS, ()),
    "a drive profile": ((), drive_profile.NEW),
    "a page": (page.EDITS, page.NEW),
    "a language": (language.EDITS, language.NEW),
    "a protection": (protection.EDITS, protection.NEW),
}


def folder(name: str) -> str:
    """Return the folder that is there already and that an added file lies below."""
    parents = Path(name).parents
    return f"{next(parent for parent in parents if (ROOT / parent).is_dir()).as_posix()}/"


def files(changed: Iterable[str], added: Iterable[str]) -> Files:
    changed, added = frozenset(changed), frozenset(added)
    return Files(len(changed | added), changed, frozenset(map(folder, added)))


def test_the_document_names_the_files_of_every_recipe() -> None:
    rows = {
        name: Files(int(number), frozenset(PATH.findall(changed)), frozenset(PATH.findall(added)))
        for name, number, changed, added in ROW.findall(DOCUMENT.read_text(encoding="utf-8"))
    }
    del rows["an order"]
    assert rows == {name: files(*followed) for name, followed in FOLLOWED.items()}
