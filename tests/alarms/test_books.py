"""The books of a site: looking at one place after the other gives what one look at all of them gives."""

from datetime import UTC, datetime, timedelta

from hypothesis import given, settings
from hypothesis import strategies as st

from app.alarms import lifecycle as pages
from app.alarms.books import Books
from app.alarms.conditions import Condition
from app.alarms.lifecycle import Book
from app.alarms.view import Ranking
from tests.amount import amount

NOON = datetime(2027, 6, 21, 9, 0, tzinfo=UTC)
PLACES = (None, *(f"T{number}" for number in range(12)))
CODES = ("drive_restarted", "encoder_jump", "following_error", "not_stowed", "drive_lost")
SITE_CODES = ("store_behind", "disk_low")

conditions = st.sets(
    st.one_of(
        st.tuples(st.sampled_from(CODES), st.sampled_from(PLACES[1:])),
        st.tuples(st.sampled_from(SITE_CODES), st.none()),
    ),
    max_size=20,
)
lives = st.lists(st.tuples(conditions, st.sampled_from((0.5, 3.0, 40.0, 700.0))), max_size=8)
maintained = st.frozensets(st.sampled_from(PLACES[1:]), max_size=2)


def condition(code: str, place: str | None) -> Condition:
    return Condition(code, place, "North field", f"It is {code}.")


def shown(book: Book, at: datetime, now: datetime) -> object:
    ranking = Ranking()
    for place in PLACES:
        mine = [alarm for alarm in book.alarms.values() if alarm.tracker_id == place]
        ranking.renew(place, mine, at, now, flood=book.flood)
    return ranking.shown(flood=book.flood)


@settings(max_examples=amount(20, 40))
@given(lives, maintained)
def test_place_by_place_the_books_become_what_one_book_becomes(
    life: list[tuple[set[tuple[str, str | None]], float]], maintenance: frozenset[str]
) -> None:
    whole, books, now = Book(), Books((), NOON, NOON), NOON
    for present, seconds in life:
        now += timedelta(seconds=seconds)
        seen = sorted(present, key=str)
        whole, changes = pages.step(
            whole, [condition(*one) for one in seen], now, now, maintenance=maintenance
        )
        parts = []
        for place in (*PLACES[1:], None):
            mine = tuple(condition(*one) for one in seen if one[1] == place)
            after, changed = books.look(place, mine, now, now, in_maintenance=place in maintenance)
            books.put(place, after, now, now)
            parts.extend(changed)
        assert {one.alarm_id: one for one in books.alarms} == whole.alarms
        assert sorted(parts, key=str) == sorted(changes, key=str)
        assert (books.of(None).flood, books.of(None).raised) == (whole.flood, whole.raised)
        assert books.shown(now, now) == shown(whole, now, now)


def test_a_set_clock_moves_the_end_of_a_shelf() -> None:
    books = Books((), NOON, NOON)
    books.put("T1", books.look("T1", (condition("encoder_jump", "T1"),), NOON, NOON)[0], NOON, NOON)
    shelved, _ = pages.shelve(books.of("T1"), "encoder_jump@T1", "ayse", "known", timedelta(minutes=30), NOON)
    books.put("T1", shelved, NOON, NOON)
    assert books.shown(NOON, NOON)[0][0].shelved_until == NOON + timedelta(minutes=30)
    ahead = NOON + timedelta(hours=1)
    assert books.shown(ahead, NOON)[0][0].shelved_until == ahead + timedelta(minutes=30)
