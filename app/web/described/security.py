"""Who may call an operation, and with what: the document's security schemes."""

from collections.abc import Mapping
from typing import Any

from app.access.roles import GRANTS
from app.access.tokens import SCOPES
from app.access.tokens import permissions_of as of_token
from app.base.permission import Permission
from app.web.http.needs import Need

SCHEMES: dict[str, dict[str, str]] = {
    "token": {
        "type": "http",
        "scheme": "bearer",
        "description": "A token that an administrator creates, with scopes and an end: for programs.",
    },
    "session": {
        "type": "apiKey",
        "in": "cookie",
        "name": "__Host-heliopanel",
        "description": "The cookie of `POST /api/v1/session`; without TLS its name is `heliopanel-` and the "
        "port. A change sends `csrf_token` of `GET /api/v1/me` as `X-CSRF-Token`.",
    },
    "ticket": {
        "type": "apiKey",
        "in": "query",
        "name": "ticket",
        "description": "A ticket of `POST /api/v1/tickets`: for one stream or download, within 5 s.",
    },
    "stop_ticket": {
        "type": "apiKey",
        "in": "query",
        "name": "stop_ticket",
        "description": "What a page keeps to stop trackers after its session has ended; nothing else.",
    },
}
"""As long as there is no user, a request from the controller's own computer needs none of them."""

OF_TOKENS = of_token(frozenset(SCOPES))
OF_USERS = frozenset().union(*GRANTS.values())


def secure(document: dict[str, Any], routes: Mapping[str, Need]) -> None:
    """Add the schemes, and to each operation those that open it, with the permission that it needs."""
    document["components"]["securitySchemes"] = SCHEMES
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            _secure(routes[f"{method.upper()} {path}"], operation)


def _secure(need: Need, operation: dict[str, Any]) -> None:
    permission = need.permission
    operation["security"] = [{name: []} for name in schemes_of(need)]
    needed = "No permission is needed." if permission is Permission.OPEN else f"Permission: `{permission}`."
    proven = " A session must have confirmed its password within 5 minutes." if need.proven else ""
    operation["description"] = f"{operation['description']}\n\n{needed}{proven}"


def schemes_of(need: Need) -> list[str]:
    """Return the schemes that open a route, none for a route that is open."""
    permission = need.permission
    if permission is Permission.OPEN:
        return []
    opening = {
        "token": permission in OF_TOKENS,
        "session": permission in OF_USERS,
        "ticket": need.ticketed,
        "stop_ticket": permission is Permission.STOP,
    }
    return [name for name, opens in opening.items() if opens]
