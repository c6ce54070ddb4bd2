"""Every call of the REST API, from its document and from the table of permissions."""

from itertools import groupby
from typing import Any

import orjson

from app.web.documented import DOCUMENT
from tests.web.route_table import ROUTES
from tools.manual.made.markdown import code, page, table, text

INTRODUCTION = """Every call, with the permission that it needs; [permissions and
roles](../operate/operators-guide.md#users) are the operator's guide's, and [the integrator's
guide](../integrate/integrators-guide.md) goes through the calls that most programs need.

The whole document, with every field and every answer, is [openapi.json](../openapi.json) (OpenAPI 3.1);
a running Heliopanel serves its own at `/api/v1/openapi.json`. Clients are generated from it."""
BASE = "/api/v1/"


def api_page() -> str:
    """Return the page."""
    paths: dict[str, dict[str, Any]] = orjson.loads(DOCUMENT.read_bytes())["paths"]
    calls = sorted(
        (_area(path), path, method.upper(), told)
        for path, one in paths.items()
        for method, told in one.items()
    )
    areas = groupby(calls, key=lambda call: call[0])
    return page("REST API", INTRODUCTION, *(_part(area, list(calls)) for area, calls in areas))


def _area(path: str) -> str:
    return path.removeprefix(BASE).partition("/")[0]


def _part(area: str, calls: list[tuple[str, str, str, dict[str, Any]]]) -> str:
    rows = [
        (method, code(path), text(told["summary"]), ROUTES[f"{method} {path}"].value)
        for _, path, method, told in calls
    ]
    return f"## {area}\n\n" + table(("method", "path", "what", "permission"), rows)
