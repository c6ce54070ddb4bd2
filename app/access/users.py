"""Users: their names, roles and the rules that a change must keep."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime

from app.access.roles import Role
from app.base.message import N_, join, say

NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9._-]{0,30}[A-Za-z0-9])?")
RESERVED = frozenset({"nobody", "this-computer", "operator", "controller", "system"})


class AccessRefused(Exception):
    """A change of users, passwords or tokens cannot be; the text says what to change."""


@dataclass(frozen=True, slots=True)
class User:
    """A person who may sign in."""

    name: str
    roles: frozenset[Role]
    password_hash: str
    created_at: datetime
    changed_at: datetime

    @property
    def is_administrator(self) -> bool:
        """Return whether this person may manage users."""
        return Role.ADMINISTRATOR in self.roles


def checked_name(name: str) -> str:
    """Return the name in lower case if it can be one, else raise `AccessRefused`."""
    if not NAME.fullmatch(name) or name.lower() in RESERVED:
        raise AccessRefused(
            say(
                "A user name has 1 to 32 letters, digits, dots, or dashes and begins with a letter "
                "or a digit, such as anna.k; {join} are reserved.",
                join=join(", ", sorted(RESERVED)),
            )
        )
    return name.lower()


def checked_roles(roles: Iterable[Role]) -> frozenset[Role]:
    """Return the roles if there is one, else raise `AccessRefused`."""
    found = frozenset(roles)
    if not found:
        raise AccessRefused(say("Choose a role: {role}.", role=join(", ", Role)))
    return found


def keep_an_administrator(users: Iterable[User], changed: str, roles: frozenset[Role]) -> None:
    """Raise `AccessRefused` if nobody would be left who may manage users."""
    others = [user for user in users if user.name != changed]
    if Role.ADMINISTRATOR in roles or any(user.is_administrator for user in others):
        return
    raise AccessRefused(
        N_("Heliopanel needs at least one administrator: give that role to another user first.")
    )
