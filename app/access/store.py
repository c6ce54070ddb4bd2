"""Users, sessions, tokens and wrong passwords on disk; the panel and the command line both write here."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Engine, Table, delete, insert, inspect, select, update

from app.access import tables
from app.access.access_cache import Book
from app.access.events import AccessEvent, Recorded, chained, covered
from app.access.migrations import upgrade
from app.access.roles import Role
from app.access.sessions import STEP_UP, Session
from app.access.throttle import FORGOTTEN_AFTER, Failures
from app.access.tokens import Scope, Token
from app.access.users import User
from app.audit.chain import FIRST, Link
from app.base.clock import SMALL_CORRECTION
from app.base.message import parts_of, with_parts
from app.store.connections import sharing_engine, sqlite_path, transaction
from app.store.files import keep_private, make_folder

KEY, CHANGES = "key", "changes"
PEOPLE = (tables.users, tables.sessions, tables.tokens, tables.failures)


class AccessStore:
    """The database of access, made with the first thing that is written; `key` is then its secret.

    An older one is brought up to date when it is first read; a newer one is refused with `StoreUnfit`.
    """

    def __init__(self, url: str, key: bytes) -> None:
        self._url = url
        self._key = key
        self._engine: Engine = sharing_engine(url)
        self._made = False

    def close(self) -> None:
        """Close the connections."""
        self._engine.dispose()

    def exists(self) -> bool:
        """Return whether anything was ever written."""
        if not self._made:
            path = sqlite_path(self._url)
            if path is not None and not path.exists():
                return False
            with transaction(self._engine) as connection:
                found = inspect(connection).has_table(tables.meta.name) and _has_key(connection)
            if found:
                upgrade(self._engine)
                self._made = True
        return self._made

    def load(self) -> Book:
        """Return everything that requests are judged by."""
        if not self.exists():
            return Book(self._key)
        with transaction(self._engine) as connection:
            return Book(
                key=bytes.fromhex(_meta(connection, KEY)),
                users={row["name"]: _user(row) for row in _rows(connection, tables.users)},
                sessions={row["digest"]: Session(**row) for row in _rows(connection, tables.sessions)},
                tokens={row["token_id"]: _token(row) for row in _rows(connection, tables.tokens)},
                changes=int(_meta(connection, CHANGES)),
            )

    def end_future(self, now: datetime) -> None:
        """End what was stored under a clock that was ahead; call it as a process begins, with its clock."""
        if self.exists():
            with self.writing() as change:
                change.end_future(now)

    def changes(self) -> int:
        """Return a number that grows with everything written."""
        if not self.exists():
            return 0
        with transaction(self._engine) as connection:
            return int(_meta(connection, CHANGES))

    @contextmanager
    def writing(self) -> Iterator["Change"]:
        """Yield one change: all of it happens, or nothing."""
        self._make()
        with transaction(self._engine) as connection:
            number = _locked(connection) + 1
            yield Change(connection)
            connection.execute(
                update(tables.meta).where(tables.meta.c.name == CHANGES).values(value=str(number))
            )

    def failures(self, subjects: Iterable[str]) -> dict[str, Failures]:
        """Return how often each of these was wrong."""
        if not self.exists():
            return {}
        with transaction(self._engine) as connection:
            return _failures(connection, subjects)

    def events(self) -> list[tuple[AccessEvent, str, str]]:
        """Return every event with the hash of the one before and its own, oldest first."""
        if not self.exists():
            return []
        with transaction(self._engine) as connection:
            rows = connection.execute(select(tables.events).order_by(tables.events.c.number)).mappings()
            return [_event(dict(row)) for row in rows]

    def newest_events(self, before: int | None, limit: int) -> list[Recorded]:
        """Return events with their numbers, newest first; `before` is the number of the last one known."""
        if not self.exists():
            return []
        columns = tables.events.c
        wanted = select(tables.events).order_by(columns.number.desc()).limit(limit)
        if before is not None:
            wanted = wanted.where(columns.number < before)
        with transaction(self._engine) as connection:
            rows = [dict(row) for row in connection.execute(wanted).mappings()]
        return [Recorded(row["number"], _event(row)[0]) for row in rows]

    def links(self) -> list[Link]:
        """Return every event as the chain of hashes sees it, oldest first."""
        found = enumerate(self.events(), start=1)
        return [Link(number, covered(event), previous, own) for number, (event, previous, own) in found]

    def _make(self) -> None:
        if self.exists():
            return
        path = sqlite_path(self._url)
        if path is not None:
            make_folder(path.parent)
            keep_private(path)
        upgrade(self._engine)
        with transaction(self._engine) as connection:
            if not _has_key(connection):
                start = [{"name": KEY, "value": self._key.hex()}, {"name": CHANGES, "value": "0"}]
                connection.execute(insert(tables.meta), start)
        self._made = True


class Change:
    """What can be written, inside one transaction that nobody else writes in."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def users(self) -> dict[str, User]:
        """Return all users as they are now."""
        return {row["name"]: _user(row) for row in _rows(self._connection, tables.users)}

    def put_user(self, user: User) -> None:
        """Add a user, or replace the one of that name."""
        row = asdict(user) | {"roles": _listed(user.roles)}
        self._put(tables.users, "name", row)

    def remove_user(self, name: str) -> None:
        """Remove a user with all sessions and tokens."""
        self._connection.execute(delete(tables.users).where(tables.users.c.name == name))
        self._connection.execute(delete(tables.tokens).where(tables.tokens.c.owner == name))
        self.end_sessions(name)

    def put_session(self, session: Session) -> None:
        """Add a session, or replace the one of that digest."""
        self._put(tables.sessions, "digest", asdict(session))

    def end_session(self, digest: str) -> None:
        """End one session."""
        self._connection.execute(delete(tables.sessions).where(tables.sessions.c.digest == digest))

    def end_sessions(self, user: str, *, but: str = "") -> None:
        """End all sessions of a user, one excepted."""
        mine = (tables.sessions.c.user == user) & (tables.sessions.c.digest != but)
        self._connection.execute(delete(tables.sessions).where(mine))

    def end_old_sessions(self, began_before: datetime) -> None:
        """Forget the sessions of people that began too long ago."""
        old = (tables.sessions.c.began_at < began_before) & (tables.sessions.c.token_id == "")
        self._connection.execute(delete(tables.sessions).where(old))

    def end_future(self, now: datetime) -> None:
        """End the sessions and proofs of the future, and count every span that begins there from now."""
        sessions, failures = tables.sessions.c, tables.failures.c
        for begun in (sessions.began_at, sessions.used_at, sessions.proven_at):
            ends = (begun > now + SMALL_CORRECTION) & (sessions.token_id == "")
            self._connection.execute(delete(tables.sessions).where(ends))
            self._connection.execute(update(tables.sessions).where(begun > now).values({begun: now}))
        stepped = update(tables.sessions).where(sessions.stepped_until > now + STEP_UP)
        self._connection.execute(stepped.values(stepped_until=None))
        self._connection.execute(update(tables.failures).where(failures.last_at > now).values(last_at=now))

    def put_token(self, token: Token) -> None:
        """Add a token, or replace the one of that id."""
        trackers = None if token.trackers is None else _listed(token.trackers)
        row = asdict(token) | {"scopes": _listed(token.scopes), "trackers": trackers}
        self._put(tables.tokens, "token_id", row)

    def remove_token(self, token_id: str) -> None:
        """Remove a token and the sessions of the cabinet's panel that it was for."""
        self._connection.execute(delete(tables.tokens).where(tables.tokens.c.token_id == token_id))
        self._connection.execute(delete(tables.sessions).where(tables.sessions.c.token_id == token_id))

    def failures(self, subjects: Iterable[str]) -> dict[str, Failures]:
        """Return how often each of these was wrong."""
        return _failures(self._connection, subjects)

    def put_failures(self, subject: str, failures: Failures) -> None:
        """Remember how often something was wrong; what is a day old is forgotten."""
        row = {"subject": subject, "count": failures.count, "last_at": failures.last_at}
        self._put(tables.failures, "subject", row)
        old = tables.failures.c.last_at < failures.last_at - FORGOTTEN_AFTER
        self._connection.execute(delete(tables.failures).where(old))

    def forgive(self, subjects: Iterable[str]) -> None:
        """Forget what was wrong."""
        self._connection.execute(delete(tables.failures).where(tables.failures.c.subject.in_(list(subjects))))

    def forgive_user(self, name: str) -> None:
        """Forget what was wrong for a user, and for the addresses at which it was."""
        subject, begin = tables.failures.c.subject, f"{name}@"
        here = select(subject).where(subject.startswith(begin, autoescape=True))
        found = self._connection.execute(here).scalars().all()
        self.forgive([f"account:{name}", *found, *(f"address:{one.removeprefix(begin)}" for one in found)])

    def empty(self) -> None:
        """Remove all users, sessions, tokens and wrong passwords; events stay."""
        for table in PEOPLE:
            self._connection.execute(delete(table))

    def note(self, event: AccessEvent) -> None:
        """Append an event, chained to the one before."""
        last = select(tables.events.c.hash).order_by(tables.events.c.number.desc()).limit(1)
        previous = self._connection.execute(last).scalar_one_or_none() or FIRST
        row = asdict(event) | {"prev_hash": previous, "hash": chained(previous, event)}
        row["result_parts"] = parts_of(event.result)
        self._connection.execute(insert(tables.events), row)

    def _put(self, table: Table, key: str, row: dict[str, Any]) -> None:
        self._connection.execute(delete(table).where(table.c[key] == row[key]))
        self._connection.execute(insert(table), row)


def _rows(connection: Connection, table: Table) -> list[dict[str, Any]]:
    return [dict(row) for row in connection.execute(select(table)).mappings()]


def _failures(connection: Connection, subjects: Iterable[str]) -> dict[str, Failures]:
    wanted = tables.failures.c.subject.in_(list(subjects))
    rows = connection.execute(select(tables.failures).where(wanted)).mappings()
    return {row["subject"]: Failures(row["count"], row["last_at"]) for row in rows}


def _has_key(connection: Connection) -> bool:
    asked = select(tables.meta.c.name).where(tables.meta.c.name == KEY)
    return connection.execute(asked).scalar_one_or_none() is not None


def _meta(connection: Connection, name: str) -> str:
    found: str = connection.execute(
        select(tables.meta.c.value).where(tables.meta.c.name == name)
    ).scalar_one()
    return found


def _locked(connection: Connection) -> int:
    """Return the number of changes; on PostgreSQL others wait here (SQLite's transactions begin locked)."""
    asked = select(tables.meta.c.value).where(tables.meta.c.name == CHANGES).with_for_update()
    return int(connection.execute(asked).scalar_one())


def _user(row: dict[str, Any]) -> User:
    return User(**row | {"roles": frozenset(Role(word) for word in row["roles"].split())})


def _token(row: dict[str, Any]) -> Token:
    trackers = None if row["trackers"] is None else frozenset(row["trackers"].split())
    return Token(
        **row | {"scopes": frozenset(Scope(word) for word in row["scopes"].split()), "trackers": trackers}
    )


def _event(row: dict[str, Any]) -> tuple[AccessEvent, str, str]:
    previous, own = row.pop("prev_hash"), row.pop("hash")
    row.pop("number")
    row["result"] = with_parts(row["result"], row.pop("result_parts"))
    return AccessEvent(**row), previous, own


def _listed(words: Iterable[str]) -> str:
    return " ".join(sorted(words))
