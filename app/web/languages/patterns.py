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
NEXT_SENTENCE = re.compile(r"(?:(?<=[a-z)]{3}[.!?])|(?<=\d[.!?])) (?=[A-Z])")
SHORT_GAPS = frozenset(("unit", "unit2", "name", "line", "axis"))
"""Gaps in which a few words stand, never sentences."""
MOST_TRIED = 40
"""So many patterns are tried for one sentence, those with the longest fixed text first."""
MOST_FOUND = 6


THIN, LONGEST_UNIT = 3, 3
"""A pattern with fewer letters of its own fits too much that is something else."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """An English text taken apart at its gaps: there is one part more than there are gaps."""

    text: str
    parts: tuple[str, ...]
    gaps: tuple[str, ...]

    def fillings(self, sentence: str) -> list[dict[str, str]]:
        """Return what may stand in the gaps of a sentence, read from either end; else nothing."""
        first, last = self.parts[0], self.parts[-1]
        inner = sentence[len(first) : len(sentence) - len(last)]
        if len(sentence) < len(first) + len(last) or sentence != f"{first}{inner}{last}":
            return []
        fixed = self.parts[1:-1]
        found = [_from_left(inner, fixed)]
        if found[0] is not None and fixed:
            found.append(_from_right(inner, fixed))
        return [
            dict(zip(self.gaps, values, strict=True))
            for values in found
            if values is not None
            and not (self.is_thin and not all(map(_is_measure, values)))
            and not self._swallows(values)
        ]

    def _swallows(self, values: list[str]) -> bool:
        """Return whether a gap within a sentence holds the end of one sentence and the start of the next."""
        return any(
            NEXT_SENTENCE.search(value) and (gap in SHORT_GAPS or after.startswith((".", ")")))
            for gap, value, after in zip(self.gaps, values, self.parts[1:], strict=True)
        )

    @property
    def fixed_length(self) -> int:
        """Return how many letters and signs are the pattern's own."""
        return sum(map(len, self.parts))

    @property
    def is_thin(self) -> bool:
        """Return whether hardly a word stands between the gaps, as in `{low} to {high}`."""
        return sum(map(len, WORD.findall(" ".join(self.parts)))) < THIN


def _from_left(text: str, fixed: tuple[str, ...]) -> list[str] | None:
    """Return what stands between fixed parts, each found as early as can be; None where one is missing."""
    values, at = [], 0
    for part in fixed:
        found = text.find(part, at)
        if found < 0:
            return None
        values.append(text[at:found])
        at = found + len(part)
    return [*values, text[at:]]


def _from_right(text: str, fixed: tuple[str, ...]) -> list[str] | None:
    """Return what stands between fixed parts, each found as late as can be; None where one is missing."""
    values, end = [], len(text)
    for part in reversed(fixed):
        found = text.rfind(part, 0, end)
        if found < 0:
            return None
        values.append(text[found + len(part) : end])
        end = found
    return [text[:end], *reversed(values)]


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

    def matches(self, sentence: str) -> list[tuple[Pattern, dict[str, str]]]:
        """Return the patterns that a sentence may be made from, each with what stands in its gaps."""
        tried: list[Pattern] = []
        for word in dict.fromkeys(WORD.findall(sentence)):
            tried += self._by_word.get(word, ())
        tried.sort(key=lambda pattern: -pattern.fixed_length)
        found: list[tuple[Pattern, dict[str, str]]] = []
        for pattern in tried[:MOST_TRIED]:
            found += ((pattern, values) for values in pattern.fillings(sentence))
            if len(found) >= MOST_FOUND:
                break
        return found


def _whole_words(pattern: Pattern) -> set[str]:
    """Return the words of the fixed text that no gap can lengthen."""
    apart = "0".join(pattern.parts)
    return {found[0] for found in WORD.finditer(apart) if not _touches_gap(apart, found)}


def _touches_gap(text: str, found: re.Match[str]) -> bool:
    before, after = text[found.start() - 1 : found.start()], text[found.end() : found.end() + 1]
    return before.isalnum() or after.isalnum()
