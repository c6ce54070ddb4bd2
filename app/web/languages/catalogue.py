"""What a language has for each English text, sentences with gaps included."""

import re
from asyncio import to_thread
from collections.abc import Callable, Mapping
from functools import cache, lru_cache, partial
from gettext import GNUTranslations, NullTranslations
from itertools import chain
from pathlib import Path
from typing import IO

from app.web.languages.given_names import GIVEN, with_names
from app.web.languages.known import ENGLISH, LANGUAGES, LOCALE, Language
from app.web.languages.patterns import GAP, Pattern, Patterns

LONGEST = 600
"""Longer texts are no sentences of ours: they stay as they are."""

KEPT = 4096
"""So many sentences are remembered, as the same ones come with every state."""

_NAMES = """
    name names tracker_id site_name actor holder by who user path file zone where link host
    address port version code url recording_id show_id id given key"""
NAMES = frozenset(_NAMES.split())
"""Gaps in which something stands that people or machines named: a word there is not translated."""

NO_NAME = "Site"
"""Where an alarm stands that belongs to no tracker: a word in the place of a name."""

NUMBER = re.compile(r"(?<![\w.])(\d+)\.(\d+)(?![\w.]*\.\d|\d)")
GROUPED = re.compile(r"(?<![\d.,])\d{1,3}(?:,\d{3})+(?![\d,])")
THIN_SPACE = "\u202f"
SENTENCE_END = re.compile(r"(?<=[.!?]) (?=-?\d|[A-Z])")
JOINT = re.compile(r"(: |, | and |; | or | · )")
INNER_SENTENCE = re.compile(r": [A-Z]")
"""What a sentence says further on: rarely of something that it is about."""
MOST_SENTENCES, MOST_NAME_WORDS, MOST_TOGETHER, MOST_SPACES, MOST_NESTED = 40, 8, 4, 2, 4


DOCUMENTS = "guide"
"""The context of the blocks of the documents, which are read only when somebody opens one."""
BLOCK = f"{DOCUMENTS}\x04"


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
        self._patterns = Patterns(text for text in self._catalog if isinstance(text, str))
        self._said_once = lru_cache(maxsize=KEPT)(self._said_with_names)

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

    def said(self, sentence: str) -> str:
        """Return a sentence of the program in this language; one that is not known stays English.

        Names that people gave stay as they are, whatever texts there are with the same words.
        """
        return self._said_once(sentence, GIVEN.version)

    def _said_with_names(self, sentence: str, _version: int) -> str:
        if not self._catalog or len(sentence) > LONGEST:
            return sentence
        if found := self._catalog.get(sentence):
            return found if sentence not in GIVEN else sentence
        has_names = False
        for masked, names in GIVEN.variants(sentence):
            has_names = True
            if (said := self._said(masked)) is not None:
                return with_names(said, names)
        return sentence if has_names else self._said(sentence) or sentence

    def _said(self, sentence: str) -> str | None:
        known = self._all_known(sentence) or self._known(sentence)
        return known or self._by_sentences(sentence) or self._piece(sentence)

    def _all_known(self, text: str) -> str | None:
        """Return several sentences that are known to the letter; no pattern is better than that."""
        said = [self._catalog.get(sentence) for sentence in SENTENCE_END.split(text, MOST_SENTENCES - 1)]
        return " ".join(filter(None, said)) if all(said) else None

    def _known(self, sentence: str, depth: int = MOST_NESTED) -> str | None:
        if found := self._catalog.get(sentence):
            return found
        matches = self._patterns.matches(sentence)
        if not matches:
            return None
        pattern, values = max(matches, key=self._likelihood)
        said = {name: self._value(name, value, depth) for name, value in values.items()}
        return GAP.sub(lambda gap: said.get(gap[1], gap[0]), self._catalog[pattern.text])

    def _likelihood(self, match: tuple[Pattern, Mapping[str, str]], *, is_within: bool = False) -> int:
        """Return how well a pattern explains a sentence; unknown words in a gap count against it."""
        pattern, values = match
        *inner, last = pattern.gaps
        about = inner if pattern.parts[-1] in ("", ".") else (*inner, last)
        astray = {gap for gap in about if INNER_SENTENCE.search(values[gap])}
        return pattern.fixed_length + sum(
            -4 * len(value) if gap in astray else self._weight(value, is_within=is_within)
            for gap, value in values.items()
        )

    def _weight(self, value: str, *, is_within: bool) -> int:
        """Return how well what stands in a gap is explained; what stands in a gap of that only whether."""
        if value in self._catalog or value.removesuffix(".") in self._catalog:
            return len(value)
        if " " not in value:
            return int(value[:1].isdigit())
        matches = self._patterns.matches(value)
        if not matches or is_within:
            return 0 if matches else -len(value)
        return max(0, *(self._likelihood(match, is_within=True) for match in matches))

    def _value(self, name: str, value: str, depth: int) -> str:
        """Return what stands in a gap: words in this language, names and what is not known as they are."""
        if name in NAMES:
            return self._catalog.get(value, value) if " " in value or value == NO_NAME else value
        if not any(letter.isalpha() for letter in value):
            return self.number(value)
        known = self._known(value, depth - 1) if depth else self._catalog.get(value)
        return known or self._by_sentences(value) or self._piece(value) or self.number(value)

    def _by_sentences(self, text: str) -> str | None:
        """Return several sentences, each for itself, None where none is known."""
        sentences = SENTENCE_END.split(text, MOST_SENTENCES - 1)
        if len(sentences) == 1:
            return None
        said, is_known = [], False
        while sentences:
            count, found = self._first_known(sentences)
            said.append(found or sentences[0])
            is_known = is_known or found is not None
            sentences = sentences[count:]
        return " ".join(said) if is_known else None

    def _first_known(self, sentences: list[str]) -> tuple[int, str | None]:
        """Return how many of the sentences stand together as one text, and what that is in this language."""
        for count in range(min(len(sentences), MOST_TOGETHER), 1, -1):
            if found := self._catalog.get(" ".join(sentences[:count])):
                return count, found
        return 1, self._known(sentences[0]) or self._piece(sentences[0])

    def _piece(self, text: str) -> str | None:
        """Return what is no text of its own: a list, something said of a name, one word."""
        return self._in_parts(text) or self._word(text)

    def _in_parts(self, text: str) -> str | None:
        """Return a list such as `azimuth and elevation` part by part."""
        parts = JOINT.split(text)
        if len(parts) == 1:
            return self._of_subject(text)
        known = [self._catalog.get(part) or self._of_subject(part) or self._word(part) for part in parts[::2]]
        pairs = list(zip(known, parts[::2], strict=True))
        if not any(known) or any(not found and part.count(" ") > MOST_SPACES for found, part in pairs):
            return None
        said = [found or self.number(part) for found, part in pairs]
        joints = [self.language.joints.get(joint, joint) for joint in parts[1::2]]
        return "".join(chain.from_iterable(zip(said, [*joints, ""], strict=True)))

    def _word(self, value: str) -> str | None:
        """Return what is known as a label only, as `azimuth` is, or without its stop, as `Holding.` is."""
        if value.endswith(".") and (label := self._catalog.get(value[:-1])):
            return label + self.language.stop
        return self._catalog.get(value[:1].upper() + value[1:]) if value[:1].islower() else None

    def _of_subject(self, text: str) -> str | None:
        """Return what is said of a name, such as `T07 is busy with a show.`; None where that is not known."""
        words = text.split(" ", MOST_NAME_WORDS)
        for count in range(1, len(words)):
            rest = text[sum(len(word) + 1 for word in words[:count]) :]
            if not rest[:1].islower() or " " not in rest:
                continue
            found = self._catalog.get(rest)
            ended = self._catalog.get(rest[:-1]) if rest.endswith(".") else None
            if found or ended:
                name = " ".join(words[:count])
                return f"{self._catalog.get(name) or name} {found or f'{ended}{self.language.stop}'}"
        return None


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
