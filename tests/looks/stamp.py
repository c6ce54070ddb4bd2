"""Which pages were looked at, as they are now: a sum a page and language, kept in looked_at.json.

The sum of a page in English is over its HTML, every file that it loads, and the rules that judge it. That of
another language is over what words need room in: HTML and styles, the translations that the page shows, the
fonts, and the rules of layout; scripts change no room.
"""

import fcntl
import hashlib
import json
from collections.abc import Iterable
from functools import cache
from gettext import GNUTranslations
from pathlib import Path

from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES, LOCALE
from tests.browser.layout import SCREEN_SIZES
from tests.looks.files import CHINESE, content, loaded, says
from tests.looks.masked import masked
from tests.looks.rendered import Rendered

HERE = Path(__file__).parent
STAMP = HERE / "looked_at.json"
LOCK = HERE.parents[1] / "build" / "looks" / "lock"
OF_WORDS = ("layout.py", "letters.py", "looks/layout.js", "looks/letters.js")
OF_ALL = ("axe_rules.py", "reading.py", "axe", "looks")
OURS = ("judged.py", "keyboard.py", "figures.py", "fonts.py", "test_pages.py")
RULES, LETTERS = "(rules)", "(letters)"
"""Beside the pages: planted faults are found; a font of ours draws every letter of a language."""
SHORT = 8
Sums = dict[str, dict[str, str]]


def sums(pages: dict[str, Rendered]) -> Sums:
    """Return the sums of pages in every language, and those of the rules and of letters."""
    # Language by language: of one alone the catalogue keeps the documents.
    of = {code: {name: _sum(page, code) for name, page in pages.items()} for code in LANGUAGES}
    found = {name: {code: of[code][name] for code in LANGUAGES} for name in pages}
    fonts = [
        content("css/letters.css"),
        *(content(one) for one in sorted(loaded("/s/0000000000000000/css/letters.css"))),
    ]
    found[LETTERS] = {code: short([_letters(code), *fonts]) for code in LANGUAGES}
    found[RULES] = {"en": short(rules("en"))}
    return found


def _letters(code: str) -> str:
    """Return every letter that the program says in a language, by the compiled catalogues."""
    with (LOCALE / ("de" if code == "en" else code) / "LC_MESSAGES" / "heliopanel.mo").open("rb") as file:
        texts: dict[object, str] = vars(GNUTranslations(file))["_catalog"]
    return "".join(sorted(set("".join(map(str, texts) if code == "en" else texts.values()))))


def _sum(page: Rendered, code: str) -> str:
    files = loaded(page.html)
    if code != "zh_Hans":
        files = frozenset(one for one in files if not one.startswith(CHINESE))
    if code != "en":
        files = frozenset(one for one in files if not one.endswith(".js"))
    texts = page.texts.union(*(says(one) for one in loaded(page.html)))
    return short([
        masked(page.html), *(content(one) for one in sorted(files)), *rules(code), *translated(texts, code)
    ])  # fmt: skip


def translated(texts: Iterable[str], code: str) -> list[str]:
    """Return what texts are called in a language, and how it writes numbers."""
    catalogue = catalogue_of(code)
    if code == "en":
        return []
    plain = catalogue.texts
    found = [repr(LANGUAGES[code])]
    for text in sorted(texts):
        forms = [plain.get((text, form)) for form in range(3)]
        found.append(f"{text}={plain.get(text) or catalogue.block(text)}={forms}")
    return found


@cache
def rules(code: str) -> tuple[str, ...]:
    """Return what a page in a language is judged by."""
    shared = HERE.parent / "browser"
    named = [shared / name for name in OF_WORDS]
    if code == "en":
        named += [shared / name for name in OF_ALL] + [HERE / name for name in OURS]
    files = [file for one in named for file in ([one] if one.is_file() else sorted(one.rglob("*.js")))]
    return (repr(SCREEN_SIZES), *(file.read_text(encoding="utf-8") for file in files))


def short(parts: Iterable[str]) -> str:
    """Return a sum that is short enough to be read."""
    total = hashlib.sha256()
    for part in parts:
        total.update(part.encode() + b"\0")
    return total.hexdigest()[:SHORT]


def kept(path: Path = STAMP) -> Sums:
    """Return what was looked at and found good."""
    if not path.exists():
        return {}
    lines = json.loads(path.read_text(encoding="utf-8"))
    return {name: dict(part.split(":") for part in line.split()) for name, line in lines.items()}


def due(now: Sums, before: Sums) -> dict[str, list[str]]:
    """Return the pages, and of each the languages, that were not looked at as they are now."""
    found = {
        name: [code for code, one in codes.items() if before.get(name, {}).get(code) != one]
        for name, codes in now.items()
    }
    return {name: codes for name, codes in found.items() if codes}


def put(name: str, code: str, found: str | None, path: Path = STAMP) -> None:
    """Stamp a page in a language, or take its stamp away; several processes may do so at once."""
    LOCK.parent.mkdir(parents=True, exist_ok=True)
    with LOCK.open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        all_ = kept(path)
        codes = all_.setdefault(name, {})
        codes.pop(code, None)
        if found is not None:
            codes[code] = found
        write(all_, path)


def write(all_: Sums, path: Path = STAMP) -> None:
    """Write all stamps, a line a page."""
    order = list(LANGUAGES)
    lines = {
        name: " ".join(f"{code}:{codes[code]}" for code in order if code in codes)
        for name, codes in sorted(all_.items())
        if codes
    }
    new = path.with_suffix(".new")
    new.write_text(json.dumps(lines, indent=0) + "\n", encoding="utf-8")
    new.replace(path)
