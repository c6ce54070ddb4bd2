"""The search over pages, settings, alarms and documents: what fits best comes first."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from starlette.requests import Request

from app.base.message import N_, join
from app.tracker.state.snapshot import Snapshot
from app.web.features.guide.guide_contexts import Hit
from app.web.features.guide.search_index import ALARM, DOCUMENT, PAGE, SETTING, Entry, index
from app.web.features.guide.search_score import Words, nearness, plain, score, words_of
from app.web.languages import said
from app.web.shell.contexts import Link
from app.web.shell.frame import shown_site

MOST_HITS = 60
MOST_NEAR = 12
FEW_TRACKERS = 10
"""Of so many trackers each place is told; of more those that the words name."""
PREFERRED: dict[str, float] = {PAGE: 1.5, SETTING: 1.0, ALARM: 0.5, DOCUMENT: 0.0}

Scored = list[tuple[float, Hit]]


@dataclass(frozen=True, slots=True)
class Found:
    """What a search found, the best first; `is_near` where nothing has all the words."""

    hits: tuple[Hit, ...]
    is_near: bool = False


def found(request: Request, words: str) -> Found:
    """Return everything that has all the words, or else what comes nearest."""
    asked = _asked(plain(words).split(), _trackers(request))
    if hits := _best(asked.hits(score), MOST_HITS):
        return Found(hits)
    near = _best(asked.hits(nearness), MOST_NEAR)
    return Found(near, is_near=bool(near))


@dataclass(frozen=True, slots=True)
class _Asked:
    """The words without those that name trackers, and the trackers that are meant."""

    needles: Sequence[str]
    trackers: Sequence[Snapshot]
    names_tracker: bool

    def hits(self, worth: Callable[[Words, Sequence[str]], float]) -> Scored:
        """Return what the words are worth something for."""
        if self.names_tracker and not self.needles:
            return self._of_named()
        fitting = ((entry, worth(words, self.needles)) for entry, words in index())
        found = [(value + PREFERRED[entry.kind], entry) for entry, value in fitting if value]
        own = self._by_name(worth)
        return [*own, *((value, hit) for value, entry in found if (hit := _hit(entry, self.trackers)))]

    def _of_named(self) -> Scored:
        """Return the tracker that is meant, its live page first, with all its pages."""
        pages = [entry for entry, _ in index() if entry.kind == PAGE and entry.of_tracker]
        return [(0.0, hit) for page in pages if (hit := _hit(page, self.trackers))]

    def _by_name(self, worth: Callable[[Words, Sequence[str]], float]) -> Scored:
        """Return trackers whose name or id has the words."""
        own = ((one, words_of((one.tracker_id, one.name), (), ())) for one in self.trackers)
        fitting = ((one, worth(words, self.needles)) for one, words in own)
        return [(value + PREFERRED[PAGE], _live(one)) for one, value in fitting if value]


def _asked(needles: Sequence[str], trackers: Sequence[Snapshot]) -> _Asked:
    """Return what is asked: a tracker whose id or whole name stands among the words is meant.

    A name of one word, alone, may as well be something else that is looked for.
    """
    for one in trackers:
        for name in (one.tracker_id, one.name, *_numbers(one.tracker_id)):
            words = plain(name).split()
            is_sure = name != one.name or len(words) > 1
            if words and (rest := _without(needles, words)) is not None and (rest or is_sure):
                return _Asked(rest, (one,), names_tracker=True)
    return _Asked(needles, trackers[:FEW_TRACKERS], names_tracker=False)


def _numbers(tracker_id: str) -> tuple[str, ...]:
    """Return how a tracker may be called by its number, such as `tracker 7` for T07."""
    number = tracker_id.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz-_").lstrip("0")
    kinds = ("tracker", said(N_("Tracker"))) if number.isdecimal() else ()
    return tuple(f"{kind} {number}" for kind in kinds)


def _without(needles: Sequence[str], words: Sequence[str]) -> Sequence[str] | None:
    """Return the needles without these words where they stand in a row, None where they do not."""
    for at in range(len(needles) - len(words) + 1):
        if list(needles[at : at + len(words)]) == list(words):
            return [*needles[:at], *needles[at + len(words) :]]
    return None


def _trackers(request: Request) -> tuple[Snapshot, ...]:
    site = shown_site(request)
    return tuple(site.trackers) if site else ()


def _best(scored: Scored, most: int) -> tuple[Hit, ...]:
    return tuple(hit for _, hit in sorted(scored, key=lambda one: -one[0])[:most])


def _hit(entry: Entry, trackers: Iterable[Snapshot]) -> Hit | None:
    """Return an entry as what was found: a tracker's leads to the first, with ways to the others."""
    if not entry.of_tracker:
        return Hit(entry.kind, entry.title, entry.href, entry.text, is_foreign=entry.is_foreign)
    ways = [Link(one.tracker_id, f"/trackers/{one.tracker_id}{entry.href}") for one in trackers]
    if not ways:
        return None
    name = ways[0].label
    return Hit(entry.kind, join(": ", (name, entry.title)), ways[0].href, entry.text, tuple(ways[1:]))


def _live(one: Snapshot) -> Hit:
    return Hit(PAGE, f"{one.tracker_id}: {one.name}", f"/trackers/{one.tracker_id}", "")
