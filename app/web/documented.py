"""The OpenAPI document, with its errors."""

import json
from typing import Any

from fastapi import FastAPI

from app.own import own_folder
from app.web.api.base import ProblemDetails

DOCUMENT = own_folder("docs") / "openapi.json"
PARAMETERS = {
    "Last-Event-ID": "Id of the last event that arrived: what came after it is sent first.",
    "action": "What the show is to do.",
    "actor": "Only what was done under this name.",
    "begin": "The first instant.",
    "channel": "The way on which alarms are sent.",
    "end": "The last instant.",
    "first": "Number of the one record.",
    "format": "The form in which it is returned.",
    "from_year": "The first year.",
    "kind": "Only of this kind.",
    "limit": "At most so many.",
    "press_id": "Id that the press began with.",
    "second": "Number of the other record.",
    "show_id": "Id of the show.",
    "since": "From this instant on.",
    "to_year": "The last year.",
    "tracker_id": "Only what concerns this tracker.",
    "until": "Up to this instant.",
}
"""What parameters mean whose calls say no more of them."""


class DocumentedApp(FastAPI):
    """An application whose document describes its errors too."""

    def openapi(self) -> dict[str, Any]:
        """Return the document with the schema of problems."""
        document = super().openapi()
        problem = ProblemDetails.model_json_schema(ref_template="#/components/schemas/{model}")
        schemas: dict[str, Any] = document["components"]["schemas"]
        for name, schema in problem.pop("$defs", {}).items():
            schemas.setdefault(name, schema)
        schemas["ProblemDetails"] = problem
        for schema in schemas.values():
            _tell_defaults(schema)
        for path in document["paths"].values():
            for call in path.values():
                _tell_parameters(call)
        return document


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


def written(app: FastAPI) -> str:
    """Return the document as it is committed."""
    return json.dumps(app.openapi(), indent=2, sort_keys=True, ensure_ascii=False) + "\n"
