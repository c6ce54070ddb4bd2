"""The tables of access on both databases: as their migrations make them, and written by several at once."""

import threading
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import text

from app.access import migrations
from app.access.events import AccessEvent, chained
from app.access.migrations import check, differences, upgrade
from app.access.opening import open_store
from app.access.roles import Role
from app.access.store import AccessStore, Change
from app.access.users import User
from app.audit.chain import FIRST
from app.base.build import VERSION
from app.base.settings import Settings
from app.store.connections import sharing_engine, transaction
from app.store.store import StoreFailed, StoreUnfit
from tests.patience import PATIENCE_S

NOW = datetime(2026, 11, 21, 12, tzinfo=UTC)
WRITERS, EACH = 4, 5
ADA = User("ada", frozenset({Role.ADMINISTRATOR}), "hash", NOW, NOW)


@pytest.fixture
def settings(tmp_path: Path, database: str | None) -> Settings:
    return Settings(data_dir=tmp_path, database_url=database)


@pytest.fixture
def store(settings: Settings) -> Iterator[AccessStore]:
    opened = open_store(settings)
    yield opened
    opened.close()


def execute(settings: Settings, statement: str) -> object:
    """Run one statement on the database of users; return the first value that it found."""
    engine = sharing_engine(settings.access_url)
    with transaction(engine) as connection:
        done = connection.execute(text(statement))
        found = done.scalar_one_or_none() if done.returns_rows else None
    engine.dispose()
    return found


def told(number: int) -> AccessEvent:
    return AccessEvent(NOW, "ada", "session", "10.0.0.9", "user_added", f"user-{number}", "")


def test_the_migrations_make_the_tables_that_the_panel_uses(settings: Settings) -> None:
    engine = sharing_engine(settings.access_url)
    upgrade(engine)
    upgrade(engine)
    with transaction(engine) as connection:
        assert differences(connection) == []
        connection.execute(text("CREATE TABLE of_somebody_else (name INTEGER)"))
        assert differences(connection) == []
        connection.execute(text("ALTER TABLE access_users ADD COLUMN colour INTEGER"))
        assert "colour" in str(differences(connection))
    engine.dispose()


def test_the_check_of_every_change_finds_no_difference() -> None:
    assert check() == []


@pytest.mark.parametrize(
    ("statement", "told"),
    [
        ("UPDATE access_version SET version_num = '9999'", "revision 9999; this version supports up to 0002"),
        (
            "UPDATE access_meta SET value = '999.0.1' WHERE name = 'version'",
            f"999.0.1; this version is {VERSION}",
        ),
    ],
)
def test_users_of_a_newer_version_are_left_alone(
    settings: Settings, store: AccessStore, statement: str, told: str
) -> None:
    with store.writing() as change:
        change.put_user(ADA)
    store.close()
    execute(settings, statement)
    newer = f"The users were stored by a newer version of Heliopanel ({told}). Install that version, or"
    for use in (AccessStore.load, AccessStore.changes, lambda store: store.writing().__enter__()):
        opened = open_store(settings)
        with pytest.raises(StoreUnfit) as refused:
            use(opened)
        opened.close()
        assert str(refused.value).startswith(newer)
        assert refused.value.exit_code == 2


def test_users_that_no_version_was_noted_for_are_taken_and_noted(
    settings: Settings, store: AccessStore
) -> None:
    with store.writing() as change:
        change.put_user(ADA)
    store.close()
    execute(settings, "DELETE FROM access_meta WHERE name = 'version'")
    opened = open_store(settings)
    assert opened.load().users == {"ada": ADA}
    opened.close()
    assert execute(settings, "SELECT value FROM access_meta WHERE name = 'version'") == VERSION


def test_users_are_copied_before_their_tables_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settings = Settings(data_dir=tmp_path)
    store = open_store(settings)
    with store.writing() as change:
        change.put_user(ADA)
    store.close()
    execute(settings, "UPDATE access_version SET version_num = '0000'")
    monkeypatch.setattr(migrations, "_migrate", lambda _: None)
    opened = open_store(settings)
    assert opened.load().users == {"ada": ADA}
    opened.close()
    copy = AccessStore(f"sqlite:///{tmp_path / 'access.db.before-0002'}", b"")
    assert copy.load().users == {"ada": ADA}
    copy.close()


def test_what_was_begun_and_never_finished_is_finished(settings: Settings, store: AccessStore) -> None:
    engine = sharing_engine(settings.access_url)
    upgrade(engine)
    engine.dispose()
    assert (store.exists(), store.load().users, store.changes()) == (False, {}, 0)
    with store.writing() as change:
        change.put_user(ADA)
    assert store.load().users == {"ada": ADA}


def test_events_are_only_appended(store: AccessStore) -> None:
    with store.writing() as change:
        change.note(told(1))
    engine = sharing_engine(store._url)
    for statement in ("UPDATE access_events SET actor = 'eve'", "DELETE FROM access_events"):
        with pytest.raises(StoreFailed, match="only ever appended"), transaction(engine) as connection:
            connection.execute(text(statement))
    engine.dispose()
    assert [event.actor for event, _, _ in store.events()] == ["ada"]


def test_a_change_that_fails_leaves_nothing(store: AccessStore) -> None:
    with store.writing() as change:
        change.note(told(1))
    before = store.changes()
    with pytest.raises(ZeroDivisionError), store.writing() as change:
        _noted_then_failed(change)
    assert (store.changes(), len(store.events())) == (before, 1)


def _noted_then_failed(change: Change) -> None:
    change.note(told(2))
    raise ZeroDivisionError


def test_who_writes_at_the_same_time_breaks_no_chain_and_hides_no_change(
    store: AccessStore, settings: Settings
) -> None:
    with store.writing() as change:
        change.note(told(0))
    before, at_once, others = store.changes(), threading.Barrier(WRITERS), []

    def write(first: int) -> None:
        other = open_store(settings)
        at_once.wait(PATIENCE_S)
        for number in range(EACH):
            with other.writing() as change:
                change.note(told(first + number))
        other.close()

    for writer in range(WRITERS):
        others.append(threading.Thread(target=write, args=(1 + writer * EACH,)))
        others[-1].start()
    for other in others:
        other.join(PATIENCE_S)
    assert store.changes() == before + WRITERS * EACH
    events, previous = store.events(), FIRST
    assert len(events) == 1 + WRITERS * EACH
    for event, link, own in events:
        assert link == previous
        assert own == chained(previous, event)
        previous = own
