"""What a language has for each English text, and messages made anew in it."""

import re
from asyncio import to_thread
from collections.abc import Callable, Mapping
from datetime import date
from enum import Enum
from functools import cache, lru_cache, partial
from gettext import GNUTranslations, NullTranslations
from pathlib import Path
from typing import IO

from app.base.message import CONTEXT_END, Message, Shown, Word
from app.web.languages.known import ENGLISH, LANGUAGES, LOCALE, Language, in_words

GAP = re.compile(r"\{([a-z][a-z0-9_]*)\}")
NUMBER = re.compile(r"(?<![\w.])(\d+)\.(\d+)(?![\w.]*\.\d|\d)")
GROUPED = re.compile(r"(?<![\d.,])\d{1,3}(?:,\d{3})+(?![\d,])")
THIN_SPACE = "\u202f"
JOINT = re.compile(r"(: |, | and |; | or | · )")

DOCUMENTS = "guide"
"""The context of the blocks of the documents, which are read only when somebody opens one."""
BLOCK = f"{DOCUMENTS}{CONTEXT_END}"


class _Stored(GNUTranslations):
    """Everything that the file of a language has."""

    _catalog: dict[object, str]

    def blocks(self) -> dict[str, str]:
        """Take out the blocks of the documents and return them."""
        found = [key for key in self._catalog if isinstance(key, str) and key.startswith(BLOCK)]
        return {key.removeprefix(BLOCK): self._catalog.pop(key) for key in found}


class Catalogue(_Stored):
    """The texts of one language; of English nothing is stored, as every text is its own translation."""

    def __init__(
        self,
        language: Language,
        stored: IO[bytes] | None = None,
        read_blocks: Callable[[], Mapping[str, str]] = dict,
    ) -> None:
        self._catalog = {}
        self.plural: Callable[[int], int] = lambda count: int(count != 1)
        self.language = language
        self._read_blocks = read_blocks
        if stored is None:
            NullTranslations.__init__(self)
        else:
            super().__init__(stored)
            self._catalog.pop("", None)
            self.blocks()

    @property
    def texts(self) -> Mapping[object, str]:
        """Return everything that is translated, plurals by text and form."""
        return self._catalog

    def gettext(self, message: str) -> str:
        """Return a text; one that is not translated is returned as it is."""
        return self._catalog.get(message) or message

    def block(self, markdown: str) -> str:
        """Return a block of a document; one that is not translated is returned as it is."""
        return self._read_blocks().get(markdown) or markdown

    def number(self, text: str) -> str:
        """Return a text with the numbers in it as this language writes them, thousands with a thin space."""
        if self.language.point == ".":
            return text
        apart = GROUPED.sub(lambda found: found[0].replace(",", THIN_SPACE), text)
        return NUMBER.sub(rf"\1{self.language.point}\2", apart)

    def said(self, text: str) -> str:
        """Return a message or a word in this language; any other text is data and stays what it is."""
        match text:
            case Message():
                return self.rendered(text) if self._catalog else str(text)
            case Word() | Enum():
                return self.word(text)
            case _:
                return text

    def rendered(self, message: Message) -> str:
        """Return a message made anew in this language; names in it stay as they are."""
        own = message.template.rpartition(CONTEXT_END)[2]
        text = self._catalog.get(message.template) or self._joined(own)
        values = message.values
        return GAP.sub(lambda gap: self._shown(values[gap[1]]) if gap[1] in values else gap[0], text)

    def _joined(self, template: str) -> str:
        """Return what stands between the parts of a list, and the stop after a sentence, of this language."""
        if not self._catalog or any(map(str.isalpha, JOINT.sub("", GAP.sub("", template)))):
            return template
        apart = JOINT.sub(lambda joint: self.language.joints.get(joint[0], joint[0]), template)
        return apart.removesuffix(".") + self.language.stop if apart.endswith(".") else apart

    def _shown(self, value: object) -> str:
        match value:
            case Message():
                return self.said(value)
            case Word() | Enum():
                return self.word(str(value))
            case str() if not isinstance(value, Shown):
                return value
            case Shown(spec="%Y-%m-%d", value=date() as day):
                return day.strftime(self.language.date)
            case _:
                return self.number(str(value))

    def word(self, text: str) -> str:
        """Return a word that travels in this language, by itself or by its label."""
        forms = (text, text[:1].upper() + text[1:], in_words(text))
        return next((found for form in forms if (found := self._catalog.get(form))), text)


def _path(language: Language) -> Path:
    return LOCALE / language.code / "LC_MESSAGES" / "heliopanel.mo"


def load(language: Language) -> Catalogue:
    """Return the catalogue of a language, an empty one where none is stored."""
    path = _path(language)
    if not path.exists():
        return Catalogue(language)
    with path.open("rb") as stored:
        return Catalogue(language, stored, partial(_blocks_of, path))


@lru_cache(maxsize=1)
def _blocks_of(path: Path) -> Mapping[str, str]:
    """Return the blocks of the documents; those of one language are kept, as pages keep what they show."""
    with path.open("rb") as stored:
        return _Stored(stored).blocks()


_READ: dict[str, Catalogue] = {}
"""Each catalogue takes 2 MB: those are held whose language somebody has asked for."""


def catalogue_of(code: str) -> Catalogue:
    """Return the catalogue of a language by its code, English for any other; each is read once."""
    language = LANGUAGES.get(code, ENGLISH)
    if language.code not in _READ:
        _READ[language.code] = load(language)
    return _READ[language.code]


async def catalogue_for(code: str) -> Catalogue:
    """Return the same for a request; reading takes 50 ms, so that a thread does it and others do not wait."""
    return catalogue_of(code) if code in _READ else await to_thread(catalogue_of, code)


@cache
def offered() -> tuple[Language, ...]:
    """Return the languages that a page can be shown in: English, and those that are translated."""
    return tuple(one for one in LANGUAGES.values() if one is ENGLISH or _path(one).exists())
