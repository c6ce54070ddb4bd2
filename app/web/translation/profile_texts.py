"""What the drive profiles that ship say to people, read from their files."""

import re
import tomllib
from collections.abc import Iterator
from typing import IO, Any

SENTENCE = re.compile(r"[A-Za-z]{2}.* |[^ ]+ .*[A-Za-z]{2}")
"""Several words; a name alone, such as `ElTrgt` or `D51`, is what the maker calls it."""
UNIT = re.compile(r"[A-Za-z]{4}| ")
"""A unit in words, such as `steps`; a sign, such as `deg/s`, is the same everywhere."""


def extract(
    file: IO[bytes], _keywords: object, _comments: object, **_options: object
) -> Iterator[tuple[int, str, str, list[str]]]:
    """Tell Babel everything in a profile that a page shows, each text once."""
    source = file.read().decode()
    for text in dict.fromkeys(_texts(tomllib.loads(source))):
        yield source.count("\n", 0, source.index(f'"{text}"')) + 1, "N_", text, []


def _texts(profile: dict[str, Any]) -> Iterator[str]:
    rows = profile["registers"].values()
    told = (profile["title"], profile["source"], profile.get("watchdog", {}).get("action", ""))
    told += tuple(row.get(name, "") for row in rows for name in ("text", "source"))
    yield from filter(SENTENCE.match, told)
    yield from (unit for row in rows if UNIT.search(unit := row.get("unit", "")))
