"""What a language has for each English text, sentences with gaps included."""

import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from gettext import GNUTranslations, NullTranslations
from typing import IO

from app.web.languages.known import ENGLISH, LANGUAGES, LOCALE, Language
from app.web.languages.patterns import GAP, Patterns

LONGEST = 600
"""Longer texts are no sentences of ours: they stay as they are."""

KEPT = 4096
"""So many sentences are remembered, as the same ones come with every state."""

_NAMES = """
    name names name2 name3 tracker_id site_name actor holder by who user path file zone where link host
    address port version code url recording_id show_id id given key"""
NAMES = frozenset(_NAMES.split())
"""Gaps in which something stands that people or machines named: it is not translated."""

NUMBER = re.compile(r"(?<![\w.])(\d+)\.(\d+)(?![\w.]*\.\d|\d)")
SENTENCE_END = re.compile(r"(?<=[.!?]) (?=[A-Z])")
LIST = re.compile(r"(, | and |; | or )")


class Catalogue(GNUTranslations):
    """The texts of one language; of English nothing is stored, as every text is its own translation."""

    def __init__(self, language: Language, stored: IO[bytes] | None = None) -> None:
        self._catalog: dict[object, str] = {}
        self.plural: Callable[[int], int] = lambda count: int(count != 1)
        self.language = language
        if stored is None:
            NullTranslations.__init__(self)
        else:
            super().__init__(stored)
        self._patterns = Patterns(text for text in self._catalog if isinstance(text, str))
        self.said = lru_cache(maxsize=KEPT)(self._said)

    @property
    def texts(self) -> Mapping[object, str]:
        """Return everything that is translated, plurals by text and form."""
        return self._catalog

    def gettext(self, message: str) -> str:
        """Return a text; one that is not translated is returned as it is."""
        return self._catalog.get(message) or message

    def number(self, text: str) -> str:
        """Return a text with the numbers in it as this language writes them."""
        return text if self.language.point == "." else NUMBER.sub(rf"\1{self.language.point}\2", text)

    def _said(self, sentence: str) -> str:
        """Return a sentence of the program in this language; one that is not known stays English."""
        if not self._catalog or len(sentence) > LONGEST:
            return sentence
        return self._known(sentence) or self._by_sentences(sentence) or sentence

    def _known(self, sentence: str, depth: int = 2) -> str | None:
        if found := self._catalog.get(sentence):
            return found
        matched = self._patterns.match(sentence)
        if matched is None:
            return None
        pattern, values = matched
        wanted = self._catalog.get(pattern.text)
        if wanted is None:
            return None
        said = {name: self._value(name, value, depth) for name, value in values.items()}
        return GAP.sub(lambda gap: said.get(gap[1], gap[0]), wanted)

    def _value(self, name: str, value: str, depth: int) -> str:
        """Return what stands in a gap: words in this language, names and what is not known as they are."""
        if name in NAMES:
            return value
        if not any(letter.isalpha() for letter in value):
            return self.number(value)
        known = self._known(value, depth - 1) if depth else self._catalog.get(value)
        return known or self._by_list(value) or self.number(value)

    def _by_list(self, value: str) -> str | None:
        """Return an enumeration such as `azimuth and elevation`, its members each for itself."""
        parts = LIST.split(value)
        if len(parts) == 1:
            return self._catalog.get(_capital(value)) if value.islower() and " " not in value else None
        return "".join(self._catalog.get(part) or self.number(part) for part in parts)

    def _by_sentences(self, text: str) -> str | None:
        """Return several sentences, each for itself, None where none is known."""
        sentences = SENTENCE_END.split(text)
        if len(sentences) == 1:
            return None
        known = [self._known(sentence) for sentence in sentences]
        if not any(known):
            return None
        return " ".join(found or sentence for found, sentence in zip(known, sentences, strict=True))


def _capital(word: str) -> str:
    return word[:1].upper() + word[1:]


def load(language: Language) -> Catalogue:
    """Return the catalogue of a language, an empty one where none is stored."""
    path = LOCALE / language.code / "LC_MESSAGES" / "heliopanel.mo"
    if not path.exists():
        return Catalogue(language)
    with path.open("rb") as stored:
        return Catalogue(language, stored)


@lru_cache(maxsize=len(LANGUAGES))
def catalogue_of(code: str) -> Catalogue:
    """Return the catalogue of a language by its code; each is read once."""
    return load(LANGUAGES.get(code, ENGLISH))
