"""The OpenAPI document, with its errors."""

import json
from typing import Any

from fastapi import FastAPI

from app.own import own_folder
from app.web.api.base import ProblemDetails

DOCUMENT = own_folder("docs") / "openapi.json"


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
        return document


def _tell_defaults(schema: dict[str, Any]) -> None:
    """Move defaults that are objects into words: clients' generators give up a schema that has one."""
    for field in schema.get("properties", {}).values():
        if isinstance(field.get("default"), dict):
            left_out = json.dumps(field.pop("default"), sort_keys=True)
            told = field.get("description", "")
            field["description"] = f"{told} When left out: `{left_out}`.".strip()


def written(app: FastAPI) -> str:
    """Return the document as it is committed."""
    return json.dumps(app.openapi(), indent=2, sort_keys=True, ensure_ascii=False) + "\n"
