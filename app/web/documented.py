"""The OpenAPI document, with its errors."""

import json
from collections.abc import Mapping
from typing import Any

from fastapi import FastAPI
from starlette.routing import Route

from app.base.own import own_folder
from app.base.permission import Permission
from app.web.api.base import ProblemDetails
from app.web.described.examples import exemplify
from app.web.described.properties import describe
from app.web.described.security import secure
from app.web.http.needs import Need, needs
from app.web.http.problems import ProblemCode
from app.web.http.routes import table

DOCUMENT = own_folder("docs") / "openapi.json"
PARAMETERS = {
    "Last-Event-ID": "Id of the last event that arrived: what came after it is sent first.",
    "action": "What the show is to do.",
    "actor": "Only what was done under this name.",
    "channel": "The way on which alarms are sent.",
    "end": "Up to this instant.",
    "end_year": "The last year.",
    "first": "Number of the one record.",
    "format": "The form in which it is returned.",
    "kind": "Only of this kind.",
    "limit": "At most so many.",
    "press_id": "Id that the press began with.",
    "second": "Number of the other record.",
    "show_id": "Id of the show.",
    "start": "From this instant on.",
    "start_year": "The first year.",
    "tracker_id": "Only what concerns this tracker.",
}
"""What parameters mean whose calls say no more of them."""


class DocumentedApp(FastAPI):
    """An application whose document describes its errors and permissions too."""

    def setup(self) -> None:
        """Have the route of the document say what it needs."""
        super().setup()
        for route in self.routes:
            if isinstance(route, Route):
                needs(Permission.READ)(route.endpoint)

    def openapi(self) -> dict[str, Any]:
        """Return the document that comes with the program: making one would hold up every page."""
        if self.openapi_schema is None:
            self.openapi_schema = json.loads(DOCUMENT.read_bytes())
        return self.openapi_schema

    def make_document(self) -> dict[str, Any]:
        """Return the document of these routes, with what FastAPI does not say by itself."""
        self.openapi_schema = None
        document = super().openapi()
        _complete(document, table(self.state.routes))
        return document


def _complete(document: dict[str, Any], routes: Mapping[str, Need]) -> None:
    problem = ProblemDetails.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas: dict[str, Any] = document["components"]["schemas"]
    for name, schema in problem.pop("$defs", {}).items():
        schemas.setdefault(name, schema)
    schemas["ProblemDetails"] = problem
    schemas["ProblemCode"]["description"] = _kinds_of_problems()
    describe(schemas)
    for schema in schemas.values():
        _tell_defaults(schema)
    for path in document["paths"].values():
        for call in path.values():
            _tell_parameters(call)
    exemplify(document)
    secure(document, routes)


def _kinds_of_problems() -> str:
    """Return every code with its status and when it occurs."""
    return "\n".join(f"- `{one.value}` ({one.status}): {one.when}" for one in ProblemCode)


def _tell_defaults(schema: dict[str, Any]) -> None:
    """Move defaults that are objects into words: clients' generators give up a schema that has one."""
    for field in schema.get("properties", {}).values():
        if isinstance(field.get("default"), dict):
            left_out = json.dumps(field.pop("default"), sort_keys=True)
            told = field.get("description", "")
            field["description"] = f"{told} When left out: `{left_out}`.".strip()


def _tell_parameters(call: dict[str, Any]) -> None:
    """Describe the parameters that a call says nothing of."""
    for parameter in call.get("parameters", ()):
        parameter.setdefault("description", PARAMETERS.get(parameter["name"], ""))


def written(app: DocumentedApp) -> str:
    """Return the document as it is committed."""
    return json.dumps(app.make_document(), indent=1, sort_keys=True, ensure_ascii=False) + "\n"
