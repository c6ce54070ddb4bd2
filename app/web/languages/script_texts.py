"""The texts that the scripts of a page write, in the language of the page."""

import re
from collections.abc import Iterable, Iterator
from functools import cache

import orjson
from markupsafe import Markup

from app.base.own import own_folder
from app.tracker.motion.hybrid import HybridPhase
from app.tracker.protections.words import Protection
from app.tracker.state.snapshot import ActivityName, ShowPhase
from app.tracker.values.mode import Mode
from app.tracker.values.operator_message import StateWord
from app.web.languages.catalogue import Catalogue, catalogue_of
from app.web.languages.known import ENGLISH, in_words

SCRIPTS = own_folder("static") / "js"
SCRIPT_TEXT = re.compile(r"(?<![\w.])_\(\s*\"((?:[^\"\\\n]|\\.)*)\"")
LIVE_WORDS = (ActivityName, HybridPhase, Mode, Protection, ShowPhase, StateWord)
"""What a script shows as words: the same as `words` in app/web/shell/formats.py."""


def texts_of(source: str) -> Iterator[tuple[int, str]]:
    """Return place and text of everything that a script marks as `_("...")`."""
    for found in SCRIPT_TEXT.finditer(source):
        yield found.start(), found[1].replace('\\"', '"').replace("\\\\", "\\")


@cache
def script_texts() -> tuple[str, ...]:
    """Return every text of the scripts, and the words of live values."""
    marked = (text for path in sorted(SCRIPTS.rglob("*.js")) for _, text in texts_of(path.read_text()))
    return tuple(dict.fromkeys((*marked, *_live_words())))


def _live_words() -> Iterable[str]:
    for words in LIVE_WORDS:
        yield from map(in_words, words)


@cache
def for_page(code: str) -> Markup:
    """Return what the scripts of a page need as JSON, nothing where they speak English."""
    catalogue = catalogue_of(code)
    return Markup("") if catalogue.language is ENGLISH else Markup(_json(catalogue))  # noqa: S704 - escaped below


def _json(catalogue: Catalogue) -> str:
    told = {"texts": {text: wanted for text in script_texts() if (wanted := catalogue.gettext(text)) != text}}
    return orjson.dumps(told).decode().replace("<", "\\u003c")
