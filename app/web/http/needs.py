"""What a route needs, said at the route; one that says nothing keeps the panel from starting."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

from app.base.permission import Permission

Endpoint = TypeVar("Endpoint", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Need:
    """What a request needs: a permission, and maybe more.

    What is `proven` a session may do only within 5 minutes of typing the password: it changes users, tokens,
    drives, limits, or network settings. Where limits or the drive are part of a larger form,
    `app/web/api/limit_review.py` asks. What `lasts` ends within a second when who asked for it must leave.
    What is `ticketed` a one-shot ticket opens: streams and downloads, for which a program cannot send a
    header.
    """

    permission: Permission
    proven: bool = False
    lasts: bool = False
    ticketed: bool = False


_NEEDS: WeakKeyDictionary[Callable[..., Any], Need] = WeakKeyDictionary()


def needs(
    permission: Permission, *, proven: bool = False, lasts: bool = False, ticketed: bool = False
) -> Callable[[Endpoint], Endpoint]:
    """Say what the route of a function needs: stands between the two. A mounted application is given too."""

    def note(endpoint: Endpoint) -> Endpoint:
        _NEEDS[endpoint] = Need(permission, proven, lasts, ticketed)
        return endpoint

    return note


def need_of(endpoint: Callable[..., Any]) -> Need | None:
    """Return what the route of a function, or a mounted application, needs; None where nobody said."""
    return _NEEDS.get(endpoint)
