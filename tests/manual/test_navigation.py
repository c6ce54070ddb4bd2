"""Every page of a section is in the navigation, and the sections are in their order."""

import tomllib
from collections.abc import Iterator
from typing import Any

from tests.manual.site import CONFIG, ROOT

SECTIONS = ("start", "operate", "install", "connect", "integrate", "reference", "explain", "develop")


def listed(entries: list[Any]) -> Iterator[str]:
    for entry in entries:
        for target in [entry] if isinstance(entry, str) else entry.values():
            yield from [target] if isinstance(target, str) else listed(target)


def test_every_page_is_in_the_navigation() -> None:
    found = list(listed(tomllib.loads((ROOT / CONFIG).read_text())["project"]["nav"]))
    written = {
        str(path.relative_to(ROOT / "docs"))
        for name in SECTIONS
        for path in (ROOT / "docs" / name).rglob("*.md")
    }
    assert written - set(found) == set(), f"name it in {CONFIG}"
    assert [
        name for name in dict.fromkeys(one.partition("/")[0] for one in found) if name in SECTIONS
    ] == list(SECTIONS)
