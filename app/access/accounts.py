"""What can be done to users and tokens, by the pages, the API and the command line alike."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from app.access.events import AccessEvent
from app.access.passwords import Passwords
from app.access.principal import Principal
from app.access.roles import Role
from app.access.store import AccessStore, Change
from app.access.tokens import LIFETIME, LONGEST_LIFETIME, Scope, Token, digest_of, mint
from app.access.users import (
    AccessRefused,
    User,
    checked_name,
    checked_roles,
    keep_an_administrator,
)
from app.base.message import N_, say
from app.base.names import tidy, unseen

LONGEST_TOKEN_NAME = 64


@dataclass(frozen=True, slots=True)
class TokenWish:
    """What a new token shall be; with a PIN it is for a cabinet's panel, which views and stops."""

    name: str
    scopes: frozenset[Scope] = frozenset()
    trackers: frozenset[str] | None = None
    lifetime: timedelta = LIFETIME
    pin: str = ""


class Accounts:
    """Changes users and tokens; every change is one transaction with its event. Hashing makes these slow."""

    def __init__(self, store: AccessStore, passwords: Passwords) -> None:
        self._store = store
        self._passwords = passwords

    def add(self, by: Principal, name: str, roles: Iterable[Role], password: str, now: datetime) -> User:
        """Add a user; the first one must be an administrator."""
        name, wanted = checked_name(name), checked_roles(roles)
        user = User(name, wanted, self._passwords.hash(password, name), now, now)
        with self._store.writing() as change:
            users = change.users()
            if name in users:
                raise AccessRefused(say("User {name} already exists; choose another name.", name=name))
            if not users and not user.is_administrator:
                raise AccessRefused(
                    N_("The first user must be an administrator, to be able to add the others.")
                )
            change.put_user(user)
            note(change, by, "user_added", f"{name}: {_words(wanted)}", now)
        return user

    def set_roles(self, by: Principal, name: str, roles: Iterable[Role], now: datetime) -> None:
        """Give a user other roles, which count from the next request on."""
        wanted = checked_roles(roles)
        with self._store.writing() as change:
            users = change.users()
            user = _known(users, name)
            keep_an_administrator(users.values(), user.name, wanted)
            change.put_user(replace(user, roles=wanted, changed_at=now))
            before = _words(user.roles)
            note(change, by, "roles_changed", f"{user.name}: {before} -> {_words(wanted)}", now)

    def set_password(self, by: Principal, name: str, password: str, now: datetime, *, keep: str = "") -> None:
        """Give a user another password and end all sessions, except the one whose digest is `keep`.

        Whoever made mistakes with the former one does not wait.
        """
        hashed = self._passwords.hash(password, name.lower())
        with self._store.writing() as change:
            user = _known(change.users(), name)
            change.put_user(replace(user, password_hash=hashed, changed_at=now))
            change.end_sessions(user.name, but=keep)
            change.forgive_user(user.name)
            note(change, by, "password_changed", user.name, now)

    def remove(self, by: Principal, name: str, now: datetime, *, last: bool = False) -> None:
        """Remove a user with all sessions and tokens; `last` allows to remove the only one there is."""
        with self._store.writing() as change:
            users = change.users()
            user = _known(users, name)
            if not (last and len(users) == 1):
                keep_an_administrator(users.values(), user.name, frozenset())
            change.remove_user(user.name)
            note(change, by, "user_removed", user.name, now)

    def mint(self, by: Principal, wish: TokenWish, now: datetime) -> str:
        """Make a token and return its text, which is not kept."""
        wish = replace(wish, name=_checked(wish))
        pin_hash = self._passwords.hash_pin(wish.pin) if wish.pin else ""
        token_id, text = mint()
        token = Token(
            token_id,
            wish.name,
            by.name[:32],
            digest_of(text),
            wish.scopes,
            wish.trackers,
            now,
            now + wish.lifetime,
            pin_hash=pin_hash,
        )
        with self._store.writing() as change:
            change.put_token(token)
            what = "kiosk" if pin_hash else _words(wish.scopes)
            note(change, by, "token_made", f"{token.name} ({token_id}): {what}"[:100], now)
        return text

    def revoke(self, by: Principal, token_id: str, now: datetime) -> None:
        """Remove a token; what it opened ends within a second."""
        with self._store.writing() as change:
            change.remove_token(token_id)
            note(change, by, "token_revoked", token_id, now)

    def end_session(self, by: Principal, digest: str, now: datetime) -> None:
        """End a session; what it opened ends within a second."""
        with self._store.writing() as change:
            change.end_session(digest)
            note(change, by, "session_ended", digest[:8], now)

    def record(self, by: Principal, action: str, thing: str, now: datetime, result: str = "done") -> None:
        """Append to the events of access what changes no user."""
        with self._store.writing() as change:
            note(change, by, action, thing, now, result)

    def factory_reset(self, by: Principal, now: datetime) -> None:
        """Remove all users, sessions, tokens and wrong passwords."""
        with self._store.writing() as change:
            change.empty()
            note(change, by, "factory_reset", N_("all users, sessions and tokens"), now)


def note(change: Change, by: Principal, action: str, thing: str, now: datetime, result: str = "done") -> None:
    """Append what was done or tried to the events of access."""
    change.note(AccessEvent(now, by.actor[:100], by.via.value, by.address[:64], action, thing[:100], result))


def _known(users: dict[str, User], name: str) -> User:
    if (user := users.get(name.lower())) is None:
        raise AccessRefused(say("There is no user {name}; heliopanel users list shows all users.", name=name))
    return user


def _checked(wish: TokenWish) -> str:
    """Return the name of a token as it is stored, or raise `AccessRefused`."""
    name = tidy(wish.name)
    if fault := unseen(name):
        raise AccessRefused(fault)
    if not 1 <= len(name) <= LONGEST_TOKEN_NAME:
        raise AccessRefused(N_("Enter a token name of 1 to 64 characters that describes its purpose."))
    if not wish.scopes and not wish.pin:
        raise AccessRefused(say("Choose the purpose of the token: {scope}.", scope=", ".join(Scope)))
    if not timedelta(hours=1) <= wish.lifetime <= LONGEST_LIFETIME:
        raise AccessRefused(N_("A token is valid for 1 hour to 366 days."))
    return name


def _words(words: Iterable[str]) -> str:
    return ", ".join(sorted(words))
