"""The API's document through a linter of its standard, without a complaint."""

from typing import Any

import orjson
from openapi_spec_validator import OpenAPIV31SpecValidator

from app.web.documented import DOCUMENT, PARAMETERS

CALLS = ("get", "put", "post", "patch", "delete")


def document() -> dict[str, Any]:
    found: dict[str, Any] = orjson.loads(DOCUMENT.read_bytes())
    return found


def complaints(found: dict[str, Any]) -> list[str]:
    return [error.message for error in OpenAPIV31SpecValidator(found).iter_errors()]


def test_the_linter_has_no_complaint() -> None:
    assert complaints(document()) == []


def test_the_linter_would_complain() -> None:
    broken = document()
    call = next(iter(broken["paths"].values()))["get"]
    del call["responses"]
    call["parameters"] = [{"name": "span", "in": "nowhere"}]
    assert len(complaints(broken)) > 0


def test_every_call_says_what_it_does_and_has_a_name_of_its_own() -> None:
    calls = [call for path in document()["paths"].values() for kind, call in path.items() if kind in CALLS]
    assert [call["operationId"] for call in calls if not (call["summary"] and call["description"])] == []
    assert len({call["operationId"] for call in calls}) == len(calls)
    given = [one for call in calls for one in call.get("parameters", ())]
    assert [one["name"] for one in given if not one.get("description")] == []
    assert set(PARAMETERS) - {one["name"] for one in given} == set()
