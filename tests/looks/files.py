"""What a page loads: styles, scripts and what they import, fonts, and icons, by their content."""

import hashlib
import re
from functools import cache
from pathlib import Path

from app.base.own import own_folder
from app.web.http.assets import COMMENTS
from app.web.languages.script_texts import texts_of

STATIC = own_folder("static")
ASKED = re.compile(r"/s/[0-9a-f]{16}/([\w./-]+)")
NAMED = re.compile(r"""["'`(]([\w./-]+\.(?:js|css|woff2?|ttf|svg|png))["'`)]""")
CHINESE = "vendor/noto/"


def loaded(html: str) -> frozenset[str]:
    """Return the files that a page loads, below the folder of static files."""
    return reached(set(ASKED.findall(html)))


def reached(waiting: set[str]) -> frozenset[str]:
    """Return files and what they name."""
    found = set[str]()
    while waiting:
        path = waiting.pop()
        found.add(path)
        waiting |= _named(path) - found
    return frozenset(found)


@cache
def _named(path: str) -> set[str]:
    """Return the files that a style or a script names."""
    if Path(path).suffix not in COMMENTS:
        return set()
    beside = (STATIC / path).parent
    places = [(beside / name).resolve() for name in NAMED.findall(_bare(path))]
    return {place.relative_to(STATIC.resolve()).as_posix() for place in places if place.is_file()}


@cache
def _bare(path: str) -> str:
    """Return a style or a script without its comments, as it is served."""
    text = (STATIC / path).read_text(encoding="utf-8")
    return text if path.startswith("vendor/") else COMMENTS[Path(path).suffix].sub("", text)


@cache
def content(path: str) -> str:
    """Return a sum over what a file says."""
    is_text = Path(path).suffix in COMMENTS
    said = _bare(path).encode() if is_text else (STATIC / path).read_bytes()
    return f"{path} {hashlib.sha256(said).hexdigest()}"


@cache
def says(path: str) -> frozenset[str]:
    """Return the texts that a script writes."""
    is_script = path.endswith(".js") and not path.startswith("vendor/")
    return frozenset(text for _, text in texts_of(_bare(path))) if is_script else frozenset()
