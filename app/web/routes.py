"""Every route of an application, in the order of its routers, to be held against the permissions."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache

from starlette.routing import BaseRoute, Mount, compile_path
from starlette.types import Scope

from app.access.roles import Permission
from app.web.late_routes import LateRoute
from app.web.route_permissions import ROUTES

STATIC = "STATIC"
STATIC_PATH = "/s"


class RouteUnguarded(Exception):
    """A route has no entry in the table of permissions; the panel does not start."""


@dataclass(frozen=True, slots=True)
class Guarded:
    """A route as the table knows it: its path, its methods (`WS` for a WebSocket), what it matches."""

    path: str
    methods: frozenset[str]
    pattern: re.Pattern[str]


def guarded_routes(routes: Iterable[BaseRoute]) -> tuple[Guarded, ...]:
    """Return every route, or raise `RouteUnguarded` for those that the table does not have."""
    found = tuple(walk(routes))
    keys = {f"{method} {one.path}" for one in found for method in one.methods if one.path != STATIC_PATH}
    if missing := sorted(keys - set(ROUTES)):
        raise RouteUnguarded(
            f"app/web/route_permissions.py has no entry for {', '.join(missing)}: write each below the "
            "permission that it needs."
        )
    return found


def walk(routes: Iterable[BaseRoute], prefix: str = "") -> Iterator[Guarded]:
    """Yield every route; what a router includes stands below the prefix that it was included with.

    FastAPI would tell this too, but only after building each route's whole validation anew, 0.7 s an app.
    """
    for route in routes:
        if isinstance(route, Mount):
            yield Guarded(prefix + route.path, frozenset({"GET"}), route.path_regex)
        elif not isinstance(route, LateRoute) and (inner := getattr(route, "original_router", None)):
            yield from walk(inner.routes, prefix + getattr(route, "include_context").prefix)  # noqa: B009
        else:
            path = prefix + str(getattr(route, "path", ""))
            methods = frozenset(getattr(route, "methods", None) or {"WS"}) - {"HEAD"}
            yield Guarded(path, methods, _pattern(path))


def needs(route: LateRoute, permission: Permission) -> bool:
    """Return whether the table has a route below this permission."""
    return any(ROUTES.get(f"{method} {route.path}") is permission for method in route.methods or ())


def key_of(routes: Iterable[Guarded], scope: Scope) -> tuple[str, dict[str, str]]:
    """Return a request's key in the table and its path's parameters; an empty key for what no route takes."""
    method = "WS" if scope["type"] == "websocket" else "GET" if scope["method"] == "HEAD" else scope["method"]
    for route in routes:
        if match := route.pattern.match(scope["path"]):
            if route.path == STATIC_PATH:
                return STATIC, {}
            if method in route.methods:
                return f"{method} {route.path}", match.groupdict()
    return "", {}


def methods_of(routes: Iterable[Guarded], path: str) -> list[str]:
    """Return every method that an address takes; the framework tells those of its first route alone."""
    found = (route.methods for route in routes if route.pattern.match(path))
    return sorted(frozenset().union(*found) - {"WS"})


@cache
def _pattern(path: str) -> re.Pattern[str]:
    return compile_path(path)[0]
