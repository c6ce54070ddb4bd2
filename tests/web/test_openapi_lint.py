"""The API's document: ranges, lists, names, and descriptions; `make check` runs a linter of its standard."""

import re
from typing import Any

import orjson

from app.web.described.properties import told
from app.web.documented import DOCUMENT, PARAMETERS

CALLS = ("get", "put", "post", "patch", "delete")


def document() -> dict[str, Any]:
    found: dict[str, Any] = orjson.loads(DOCUMENT.read_bytes())
    return found


def test_every_list_has_items_and_says_where_it_continues() -> None:
    told = document()
    schemas = told["components"]["schemas"]
    lists = 0
    for path, calls in told["paths"].items():
        for method, call in calls.items():
            given = {one["name"] for one in call.get("parameters", ())}
            for schema in answers(call):
                assert schema.get("type") != "array" or path == EXPORT, (method, path)
                fields = (
                    schemas[schema["$ref"].rpartition("/")[2]].get("properties", {})
                    if "$ref" in schema
                    else {}
                )
                is_list = {"items", "next"} <= set(fields)
                lists += is_list
                assert is_list == ("items" in fields) == ("next" in fields), (method, path)
                assert is_list or "cursor" not in given, (method, path)
                assert ("limit" in given) == ("cursor" in given), (method, path)
    assert lists > 25


EXPORT = "/api/v1/journal/export"
"""Everything as one file."""


def answers(call: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the schemas of what a call answers in JSON when it is done."""
    done = (one for status, one in call["responses"].items() if status.startswith("2"))
    return [one["content"]["application/json"]["schema"] for one in done
            if "application/json" in one.get("content", {})]  # fmt: skip


def test_every_property_is_described_and_no_description_is_left_over() -> None:
    schemas = document()["components"]["schemas"]
    fields = {
        f"{name}.{key}": field["description"]
        for name, schema in schemas.items()
        for key, field in schema.get("properties", {}).items()
    }
    assert [place for place, description in fields.items() if not description] == []
    known = told()
    used = {text for place, text in fields.items() if text.partition(" When left out:")[0] in known.values()}
    taken = {text.partition(" When left out:")[0] for text in used}
    assert [name for name, text in known.items() if text not in taken] == []
    assert [name for name in known if name.endswith((*UNITS, SHARE)) and not UNIT.search(known[name])] == []


UNITS = ("_deg", "_s", "_mps", "_wm2", "_mm", "_kg", "_v", "_wh", "_kwh", "_h", "_dps", "_m", "_w")
SHARE = "_percent"
UNIT = re.compile("degree|second|meter|watt|gram|volt|hour|percent", re.IGNORECASE)


def test_every_call_says_what_it_does_and_has_a_name_of_its_own() -> None:
    calls = [call for path in document()["paths"].values() for kind, call in path.items() if kind in CALLS]
    assert [call["operationId"] for call in calls if not (call["summary"] and call["description"])] == []
    assert len({call["operationId"] for call in calls}) == len(calls)
    given = [one for call in calls for one in call.get("parameters", ())]
    assert [one["name"] for one in given if not one.get("description")] == []
    assert set(PARAMETERS) - {one["name"] for one in given} == set()
