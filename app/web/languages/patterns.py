"""Sentences with gaps: which English pattern a sentence was made from, and what stands in its gaps.

No regular expression is run over a sentence: each pattern is looked for by one rare word of it, and its fixed
parts are then found from left to right, so that the time is bounded by the length of the sentence.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

GAP = re.compile(r"\{([a-z][a-z0-9_]*)\}")
WORD = re.compile(r"[^\W\d_]+")
MOST_TRIED = 40
"""So many patterns are tried for one sentence, those with the longest fixed text first."""


THIN, LONGEST_UNIT = 3, 3
"""A pattern with fewer letters of its own fits too much that is something else."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """An English text taken apart at its gaps: there is one part more than there are gaps."""

    text: str
    parts: tuple[str, ...]
    gaps: tuple[str, ...]

    def filled(self, sentence: str) -> dict[str, str] | None:
        """Return what stands in the gaps of a sentence, None where it is not of this pattern."""
        first, last = self.parts[0], self.parts[-1]
        if len(sentence) < len(first) + len(last) or not (
            sentence.startswith(first) and sentence.endswith(last)
        ):
            return None
        at, end, values = len(first), len(sentence) - len(last), []
        for part in self.parts[1:-1]:
            found = sentence.find(part, at, end) if part else at
            if found < 0:
                return None
            values.append(sentence[at:found])
            at = found + len(part)
        values.append(sentence[at:end])
        if at > end or (self.is_thin and not all(map(_is_measure, values))):
            return None
        return dict(zip(self.gaps, values, strict=True))

    @property
    def is_thin(self) -> bool:
        """Return whether hardly a word stands between the gaps, as in `{low} to {high}`."""
        return sum(map(len, WORD.findall(" ".join(self.parts)))) < THIN


def _is_measure(value: str) -> bool:
    """Return whether something is a number or a unit."""
    has_digit = any(letter.isdigit() for letter in value)
    return " " not in value and (has_digit or 0 < len(value) <= LONGEST_UNIT)


def pattern_of(text: str) -> Pattern | None:
    """Return a text as a pattern, None where it has no gaps."""
    gaps = tuple(GAP.findall(text))
    return Pattern(text, tuple(GAP.split(text)[::2]), gaps) if gaps else None


class Patterns:
    """All patterns of a language, found by the rarest word of each."""

    def __init__(self, texts: Iterable[str]) -> None:
        patterns = [pattern for text in texts if (pattern := pattern_of(text))]
        words = {pattern: _whole_words(pattern) for pattern in patterns}
        how_many = Counter(word for found in words.values() for word in found)
        by_word: dict[str, list[Pattern]] = defaultdict(list)
        for pattern, found in words.items():
            if found:
                by_word[min(found, key=lambda word: (how_many[word], word))].append(pattern)
        self._by_word: Mapping[str, list[Pattern]] = by_word

    def match(self, sentence: str) -> tuple[Pattern, dict[str, str]] | None:
        """Return the pattern of a sentence and what stands in its gaps; the longest one fits best."""
        tried: list[Pattern] = []
        for word in dict.fromkeys(WORD.findall(sentence)):
            tried += self._by_word.get(word, ())
        tried.sort(key=lambda pattern: -len("".join(pattern.parts)))
        for pattern in tried[:MOST_TRIED]:
            values = pattern.filled(sentence)
            if values is not None:
                return pattern, values
        return None


def _whole_words(pattern: Pattern) -> set[str]:
    """Return the words of the fixed text that no gap can lengthen."""
    apart = "0".join(pattern.parts)
    return {found[0] for found in WORD.finditer(apart) if not _touches_gap(apart, found)}


def _touches_gap(text: str, found: re.Match[str]) -> bool:
    before, after = text[found.start() - 1 : found.start()], text[found.end() : found.end() + 1]
    return before.isalnum() or after.isalnum()
