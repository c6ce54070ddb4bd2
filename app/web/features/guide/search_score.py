"""How well words fit what can be found: in its name, under another name, or in what is said of it."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from app.web.features.guide.guide import folded

GAP = re.compile(r"[\W_]+")
HAN = "\u3400-\u9fff"
SEAM = re.compile(f"(?<=[{HAN}])(?=[a-z0-9])|(?<=[a-z0-9])(?=[{HAN}])")
"""Where words of two scripts meet without a space, as in T7风速."""
IN_HAN = re.compile(f"[{HAN}]+")
WHOLE = re.compile(r"[a-z]{1,2}|[a-z]*\d+[a-z]*")
"""What counts only as a word of its own: `ip` is not in `strip`, and T1 not in T10."""
IN_TITLE, IN_ALSO, IN_TEXT = 6.0, 5.0, 1.5
INSIDE_A_WORD, VARIED = 0.7, 0.6
EXACTLY, TOGETHER = 8.0, 3.0
SHORTEST_PART = 4
ENDING = 2
"""So many last letters may differ where no text has a word as it was typed."""


@dataclass(frozen=True, slots=True)
class Words:
    """What a thing can be found by, plain: its title, other words, all else, and its names as a whole."""

    title: str
    also: str
    text: str
    names: frozenset[str]


def plain(text: str) -> str:
    """Return a text as words are compared: folded, with one space for whatever stands between them."""
    return GAP.sub(" ", SEAM.sub(" ", folded(text))).strip()


def words_of(titles: Iterable[str], also: Iterable[str], text: Iterable[str]) -> Words:
    """Return what a thing can be found by; other words are parted by commas, each a name of its own."""
    titles, others = tuple(titles), [name for one in also for name in re.split("[,，、;]", one)]
    names = frozenset(plain(name) for name in (*titles, *others))
    return Words(_line(titles), _line(others), _line(text), names - {""})


def score(words: Words, needles: Sequence[str]) -> float:
    """Return how well all the needles fit, 0 where one of them is nowhere."""
    found = [_place(words, needle) for needle in needles]
    if not found or not all(found):
        return 0.0
    asked = " ".join(needles)
    bonus = EXACTLY if asked in words.names else TOGETHER * (len(needles) > 1 and asked in words.title)
    return sum(found) / len(found) + bonus + 1.0 / (1 + words.title.count(" "))


def nearness(words: Words, needles: Sequence[str]) -> float:
    """Return how near the needles come where not all are there: 0 where not even half of them is."""
    found = [max(_place(words, part) * worth for part, worth in _parts(needle, words)) for needle in needles]
    hits = sum(one > 0.0 for one in found)
    return sum(found) / len(found) if found and 2 * hits >= len(found) else 0.0


def _place(words: Words, needle: str) -> float:
    """Return the worth of the best place that has a needle."""
    for text, worth in ((words.title, IN_TITLE), (words.also, IN_ALSO), (words.text, IN_TEXT)):
        if f" {needle}" in text if not WHOLE.fullmatch(needle) else f" {needle} " in text:
            return worth
        if not WHOLE.fullmatch(needle) and needle in text:
            return worth * INSIDE_A_WORD
    return 0.0


def _parts(needle: str, words: Words) -> list[tuple[str, float]]:
    """Return what may stand for a needle: itself, its beginning, a half of it where a word begins."""
    begin = "" if IN_HAN.fullmatch(needle) else " "
    named = words.title + words.also
    return [(needle, 1.0), *((part, VARIED) for part in _variants(needle) if begin + part in named)]


@lru_cache(maxsize=256)
def _variants(needle: str) -> tuple[str, ...]:
    if IN_HAN.fullmatch(needle):
        return tuple(needle[at : at + 2] for at in range(len(needle) - 1))
    ends = range(SHORTEST_PART, len(needle) - SHORTEST_PART + 1)
    halves = [half for at in ends for half in (needle[:at], needle[at:])]
    shorter = [needle[:-cut] for cut in range(1, ENDING + 1) if len(needle) - cut >= SHORTEST_PART]
    return (*shorter, *halves)


def _line(texts: Iterable[str]) -> str:
    return f" {plain(' '.join(texts))} "
