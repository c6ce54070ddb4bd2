"""Names that people gave (sites, trackers, users): in a sentence they are values, never looked up.

A sentence of the program arrives as plain English. Before it is looked up, every name in it gives way to a
sign that no text has, and comes back afterwards.
"""

import re
from collections.abc import Iterable, Iterator

FIRST_SIGN = 0xE000
SIGNS = re.compile("[\ue000-\uf8ff]")
STAND_IN = re.compile("Q([\ue000-\uf8ff])\\1\\1")
MOST_NAMES, MOST_IN_A_SENTENCE = 20_000, 6


class GivenNames:
    """The names that are known; `version` grows with every new one."""

    def __init__(self) -> None:
        self._names: set[str] = set()
        self._pattern: re.Pattern[str] | None = None
        self.version = 0

    def know(self, names: Iterable[str]) -> None:
        """Take in names; those that are known already cost nothing."""
        new = {name for name in names if name.strip()} - self._names
        if not new or len(self._names) + len(new) > MOST_NAMES:
            return
        self._names |= new
        self.version += 1
        longest_first = sorted(self._names, key=len, reverse=True)
        self._pattern = re.compile("|".join(map(_whole, longest_first)))

    def __contains__(self, name: str) -> bool:
        return name in self._names

    def forget(self) -> None:
        """Know no name any more."""
        self._names, self._pattern = set(), None
        self.version += 1

    def variants(self, sentence: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield a sentence with stand-ins for the names in it, and the names; nothing where there are none.

        First every name gives way, then all but one: what looks like a name may be a word of ours.
        """
        if self._pattern is None or SIGNS.search(sentence):
            return
        found = list(self._pattern.finditer(sentence))[:MOST_IN_A_SENTENCE]
        names = tuple(one[0] for one in found)
        for left in (None, *range(len(found))) if found else ():
            yield _masked(sentence, found, left), names


def _whole(name: str) -> str:
    """Return the pattern of a name that is no part of a longer word."""
    before = r"(?<!\w)" if name[:1].isalnum() else ""
    after = r"(?!\w)" if name[-1:].isalnum() else ""
    return f"{before}{re.escape(name)}{after}"


def _masked(sentence: str, found: list[re.Match[str]], left: int | None) -> str:
    parts, at = [], 0
    for number, one in enumerate(found):
        if number != left:
            parts += [sentence[at : one.start()], "Q" + chr(FIRST_SIGN + number) * 3]
            at = one.end()
    return "".join((*parts, sentence[at:]))


def with_names(text: str, names: tuple[str, ...]) -> str:
    """Return a text with the names again in the places of their stand-ins."""
    return STAND_IN.sub(lambda sign: names[ord(sign[1]) - FIRST_SIGN], text)


GIVEN = GivenNames()
"""The names that this process has met."""
