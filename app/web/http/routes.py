"""Every route of an application, in the order of its routers, with what it needs."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from starlette.routing import BaseRoute, Mount, compile_path
from starlette.types import Scope

from app.base.permission import Permission
from app.web.http.late_routes import LateRoute
from app.web.http.needs import Need, need_of

STATIC = "STATIC"
STATIC_PATH = "/s"


class RouteUnguarded(Exception):
    """A route does not say what it needs; the panel does not start."""


@dataclass(frozen=True, slots=True)
class Guarded:
    """A route as the gate knows it: path, methods (`WS` for a WebSocket), what it matches, what it needs."""

    path: str
    methods: frozenset[str]
    pattern: re.Pattern[str]
    need: Need | None


class Asked(NamedTuple):
    """What a request asks for: method and path of its route, what that needs, the parameters of the path.

    What no route takes has no key and needs what reading does.
    """

    key: str
    need: Need
    path_parameters: dict[str, str]


NOTHING = Asked("", Need(Permission.READ), {})


def guarded_routes(routes: Iterable[BaseRoute]) -> tuple[Guarded, ...]:
    """Return every route, or raise `RouteUnguarded` for those that do not say what they need."""
    found = tuple(walk(routes))
    if missing := sorted(_keys(one for one in found if one.need is None and one.path != STATIC_PATH)):
        raise RouteUnguarded(f"Nothing says who may call {', '.join(missing)}: add @needs(...) at the route.")
    return found


def table(routes: Iterable[Guarded]) -> dict[str, Need]:
    """Return what every route needs, by method and path, such as `POST /stop`."""
    return {key: one.need for one in routes if one.need is not None for key in _keys((one,))}


def _keys(routes: Iterable[Guarded]) -> Iterator[str]:
    return (f"{method} {one.path}" for one in routes for method in one.methods)


def walk(routes: Iterable[BaseRoute], prefix: str = "") -> Iterator[Guarded]:
    """Yield every route; what a router includes stands below the prefix that it was included with.

    FastAPI would tell this too, but only after building each route's whole validation anew, 0.7 s an app.
    """
    for route in routes:
        if isinstance(route, Mount):
            yield Guarded(prefix + route.path, frozenset({"GET"}), route.path_regex, need_of(route.app))
        elif not isinstance(route, LateRoute) and (inner := getattr(route, "original_router", None)):
            yield from walk(inner.routes, prefix + getattr(route, "include_context").prefix)  # noqa: B009
        else:
            path = prefix + str(getattr(route, "path", ""))
            methods = frozenset(getattr(route, "methods", None) or {"WS"}) - {"HEAD"}
            yield Guarded(path, methods, _pattern(path), need_of(getattr(route, "endpoint")))  # noqa: B009


def asked_of(routes: Iterable[Guarded], scope: Scope) -> Asked:
    """Return what a request asks for."""
    method = "WS" if scope["type"] == "websocket" else "GET" if scope["method"] == "HEAD" else scope["method"]
    for route in routes:
        if match := route.pattern.match(scope["path"]):
            if route.path == STATIC_PATH:
                return Asked(STATIC, Need(Permission.OPEN), {})
            if method in route.methods:
                return Asked(f"{method} {route.path}", route.need or NOTHING.need, match.groupdict())
    return NOTHING


def methods_of(routes: Iterable[Guarded], path: str) -> list[str]:
    """Return every method that an address takes; the framework tells those of its first route alone."""
    found = frozenset[str]().union(*(route.methods for route in routes if route.pattern.match(path)))
    return sorted((found | {"HEAD"} if "GET" in found else found) - {"WS"})


@cache
def _pattern(path: str) -> re.Pattern[str]:
    return compile_path(path)[0]
