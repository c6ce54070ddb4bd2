"""The alarms of a site, a book for each tracker and one for the site itself: each is looked at on its own."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from datetime import datetime, timedelta

from app.alarms import lifecycle as pages
from app.alarms.alarm import Alarm
from app.alarms.conditions import Condition
from app.alarms.lifecycle import Book, Change, Happened
from app.alarms.view import Ranking, Shown

Place = str | None
"""A tracker's id, or None: the site."""

NOTHING = Book()
CLOCK_MOVED = timedelta(seconds=1)


class Books:
    """Every look costs what its place has; the order of urgency is kept, and a flood counts all places."""

    def __init__(self, standing: Iterable[Alarm], at: datetime, now: datetime) -> None:
        self._books: dict[Place, Book] = {}
        self._raised: list[datetime] = []
        self._shift = at - now
        self._ranking = Ranking()
        self._shown: Shown | None = None
        by_place: dict[Place, list[Alarm]] = {}
        for alarm in standing:
            by_place.setdefault(alarm.tracker_id, []).append(alarm)
        for place, alarms in by_place.items():
            self._books[place] = pages.restored(alarms)
        self._rank(at, now)

    @property
    def places(self) -> tuple[Place, ...]:
        """Return the places that have alarms."""
        return tuple(self._books)

    @property
    def alarms(self) -> Iterator[Alarm]:
        """Yield every alarm."""
        for book in self._books.values():
            yield from book.alarms.values()

    @property
    def flood_grew(self) -> bool:
        """Return whether alarms were raised that the site's book does not count yet."""
        return bool(self._raised)

    def of(self, place: Place) -> Book:
        """Return the book of one place."""
        return self._books.get(place, NOTHING)

    def look(
        self,
        place: Place,
        present: tuple[Condition, ...],
        at: datetime,
        now: datetime,
        *,
        in_maintenance: bool = False,
        settled: bool = True,
    ) -> tuple[Book, tuple[Change, ...]]:
        """Return the next book of one place and what changed, as `step` does; `put` takes it."""
        book = self.of(place)
        if place is None:
            elsewhere, self._raised = self._raised, []
            return pages.step(book, present, at, now, settled=settled, raised_elsewhere=elsewhere)
        if not present and not book.alarms:
            return book, ()
        maintenance = frozenset((place,)) if in_maintenance else frozenset()
        after, changes = pages.step(book, present, at, now, maintenance=maintenance, settled=settled)
        self._raised.extend(now for one in changes if one.what is Happened.RAISED)
        return replace(after, raised=(), flood=False), changes

    def put(self, place: Place, book: Book, at: datetime, now: datetime) -> None:
        """Let this be the book of a place from now on."""
        before = self.of(place)
        if book.alarms or book.raised or book.flood:
            self._books[place] = book
        else:
            self._books.pop(place, None)
        if before.flood != book.flood:
            self._rank(at, now)
        elif before.alarms != book.alarms:
            self._ranking.renew(place, book.alarms.values(), at, now, flood=self.of(None).flood)
            self._shown = None

    def shown(self, at: datetime, now: datetime) -> Shown:
        """Return the alarms that stand, at most 50, and how many; the same object if none changed."""
        if abs((at - now) - self._shift) >= CLOCK_MOVED:
            self._rank(at, now)
        if self._shown is None:
            self._shown = self._ranking.shown(flood=self.of(None).flood)
        return self._shown

    def _rank(self, at: datetime, now: datetime) -> None:
        """Put all alarms in order anew: a flood began or ended, or the site's clock was set."""
        self._shift = at - now
        self._ranking = Ranking()
        self._shown = None
        for place, book in self._books.items():
            self._ranking.renew(place, book.alarms.values(), at, now, flood=self.of(None).flood)
