"""Every recipe of docs/develop/contributing.md is followed in a copy; its table names the same files."""

import re
from collections.abc import Iterable
from pathlib import Path

import pytest

from tests.soak.built.recipes import alarm, drive_profile, language, page, protection, setting
from tests.soak.built.recipes.program_copy import ROOT, followed

DOCUMENT = ROOT / "docs/develop/contributing.md"
ROW = re.compile(r"^\| (an? [a-z ]+) \| (\d+) \| (.*) \| (.*) \|$", re.MULTILINE)
PATH = re.compile(r"`([^`]+)`")
RECIPES = {
    "a setting of a tracker": setting,
    "an alarm": alarm,
    "a drive profile": drive_profile,
    "a page": page,
    "a language": language,
    "a protection": protection,
}


@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_needs_no_other_file(tmp_path: Path, name: str) -> None:
    recipe = RECIPES[name]
    followed(tmp_path, recipe.EDITS, recipe.NEW, recipe.PROOF)


def test_the_document_names_the_files_of_every_recipe() -> None:
    rows = {
        name: (int(number), {*PATH.findall(changed)}, {*PATH.findall(added)})
        for name, number, changed, added in ROW.findall(DOCUMENT.read_text(encoding="utf-8"))
    }
    del rows["an order"]
    assert rows == {
        name: (len({*one.EDITS, *one.NEW}), {*one.EDITS}, folders(one.NEW)) for name, one in RECIPES.items()
    }


def folders(added: Iterable[str]) -> set[str]:
    """Return the folders that are there already and that added files lie below."""
    return {
        f"{next(parent for parent in Path(name).parents if (ROOT / parent).is_dir()).as_posix()}/"
        for name in added
    }
