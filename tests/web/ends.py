"""Requests with values at and beyond the ends of every range that the API's document gives, one at a time."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

from tests.amount import SOAK

Schema = dict[str, Any]

HUGE = "a number beyond every float"
"""Stands for 1e400, which Python's JSON cannot write."""
DATES = ["0001-01-01", "1900-12-31", "1901-01-01", "2099-12-31", "2100-01-01", "9999-12-31", "2026-02-30"]
INSTANTS = [
    "0001-01-01T00:00:00+14:00",
    "0001-01-01T00:00:00Z",
    "1969-12-31T23:59:59Z",
    "9999-12-31T23:59:59-12:00",
    "9999-12-31T23:59:59.999999Z",
    "2026-06-21T12:00:00",
    "1e18",
]
TEXTS = ["", "\0", "\ud800", "é" * 5000]
NO_NUMBERS: list[Any] = [float("nan"), HUGE, -(10**30)]
OTHERS: list[Any] = [True, None, []]
"""What may come in a body instead of anything at all."""


@dataclass(frozen=True, slots=True)
class Case:
    """One request: everything as usual but for one value."""

    method: str
    path: str
    headers: dict[str, str]
    body: bytes | None
    changed: str

    def __str__(self) -> str:
        return f"{self.method} {self.path[:200]} {self.changed[:200]}"


class Document:
    """The API's document, asked for requests."""

    def __init__(self, document: dict[str, Any], ids: dict[str, str]) -> None:
        self._schemas = document["components"]["schemas"]
        self._paths = document["paths"]
        self._bodies_tried: dict[str, tuple[str, str]] = {}
        self._ids = ids

    def operations(self) -> list[tuple[str, str]]:
        """Return all operations, method and path."""
        return [(method, path) for path, item in self._paths.items() for method in item]

    def cases(self, method: str, path: str) -> Iterator[Case]:
        """Return the requests of one operation: as usual, and with one value changed."""
        operation = self._paths[path][method]
        given, schema = operation.get("parameters", []), self._body_schema(operation)
        usual = {one["name"]: self._usual(one) for one in given if one.get("required")}
        sent = _Sent(method, path, given)
        usual_body = None if schema is None else self._example(schema)
        yield sent.case(usual, usual_body, "as usual")
        for one in given:
            if not SOAK and not self._is_first({"name": one["name"], **one["schema"]}, method, path):
                continue
            for value in _as_text(self._ends(one["schema"])):
                yield sent.case({**usual, one["name"]: value}, usual_body, f"{one['name']} = {value!r}")
        if schema is not None and self._is_first(schema, method, path):
            for where, body in self._changed(schema):
                yield sent.case(usual, body, where)

    def _is_first(self, schema: Schema, method: str, path: str) -> bool:
        """Return whether no other call has this body or, but in the soak, this parameter."""
        return self._bodies_tried.setdefault(str(schema), (method, path)) == (method, path)

    def _usual(self, parameter: dict[str, Any]) -> Any:
        return self._ids.get(parameter["name"]) or self._example(parameter["schema"], parameter)

    def _body_schema(self, operation: dict[str, Any]) -> Schema | None:
        content = operation.get("requestBody", {}).get("content", {})
        return content["application/json"]["schema"] if "application/json" in content else None

    def _kinds(self, schema: Schema) -> list[Schema]:
        """Return the schemas that one stands for: those it names, null left out."""
        if "$ref" in schema:
            return self._kinds(self._schemas[schema["$ref"].rpartition("/")[2]])
        kinds = schema.get("oneOf") or schema.get("anyOf")
        if not kinds:
            return [schema]
        found = [kind for one in kinds for kind in self._kinds(one)]
        return [one for one in found if one.get("type") != "null"]

    def _example(self, schema: Schema, told: Schema | None = None) -> Any:
        """Return a value as an integrator would send it, without what may be left out."""
        kind = self._kinds(schema)[0]
        for one in (told or {}, schema, kind):
            known = one.get("examples", []) + [one[name] for name in ("example", "const") if name in one]
            if known or "enum" in one:
                return (known or one["enum"])[0]
        match kind.get("type"):
            case "object":
                return self._object(kind)
            case "array":
                items = kind.get("prefixItems") or [kind.get("items", {})] * max(1, kind.get("minItems", 1))
                return [self._example(one) for one in items]
            case "integer" | "number":
                return _within(kind)
            case "boolean":
                return True
        return _text(kind)

    def _object(self, kind: Schema) -> dict[str, Any]:
        told = kind.get("properties", {})
        needed = [name for name, one in told.items() if name in kind.get("required", []) or "const" in one]
        return {name: self._ids.get(name) or self._example(told[name]) for name in needed}

    def _changed(self, schema: Schema) -> Iterator[tuple[str, Any]]:
        """Return bodies in which one value is another, and which it is."""
        for value in {repr(one): one for one in (*self._ends(schema), *OTHERS)}.values():
            yield f"= {value!r}", value
        for kind in self._kinds(schema):
            if kind.get("type") == "object":
                usual = self._object(kind)
                for name, one in kind.get("properties", {}).items():
                    for where, value in self._changed(one):
                        yield f".{name}{where}", {**usual, name: value}
            if kind.get("type") == "array":
                rest = self._example(kind)[1:]
                for where, value in self._changed((kind.get("prefixItems") or [kind.get("items", {})])[0]):
                    yield f"[0]{where}", [value, *rest]

    def _ends(self, schema: Schema) -> Iterator[Any]:
        """Return what is tried for a value: the ends of its ranges, what lies beyond, and what it is not."""
        for kind in self._kinds(schema):
            match kind.get("type"):
                case "integer":
                    yield from [*_around(kind, 1), *NO_NUMBERS, 1.5]
                case "number":
                    yield from [*_around(kind, 1e-9), *NO_NUMBERS]
                case "string":
                    yield from _texts(kind)
                case "array":
                    longest = kind.get("maxItems", 1000)
                    yield from [[], [self._example(kind.get("items", {}))] * (longest + 1), [None]]
            yield from kind.get("enum", [])[-1:]


class _Sent:
    def __init__(self, method: str, path: str, given: list[dict[str, Any]]) -> None:
        self._method, self._path = method.upper(), path
        self._places = {one["name"]: one["in"] for one in given}

    def case(self, values: dict[str, Any], body: Any, changed: str) -> Case:
        path, query, headers = self._path, [], {}
        for name, value in values.items():
            text = quote(str(value), safe="", errors="surrogatepass")
            match self._places[name]:
                case "path":
                    path = path.replace("{" + name + "}", text)
                case "query":
                    query.append(f"{name}={text}")
                case _:
                    headers[name] = text[:8000]
        sent = None
        if body is not None:
            headers["content-type"] = "application/json"
            sent = json.dumps(body).replace(json.dumps(HUGE), "1e400").encode()
        return Case(self._method, path + ("?" + "&".join(query) if query else ""), headers, sent, changed)


def _within(kind: Schema) -> float | int:
    low = kind.get("minimum", kind.get("exclusiveMinimum"))
    high = kind.get("maximum", kind.get("exclusiveMaximum"))
    if low is None or high is None:
        return 1 if low is None else low + 1
    if kind["type"] == "integer":
        return int(min(low + 1, high))
    return float(low + (high - low) / 4)


def _around(kind: Schema, step: float) -> list[float | int]:
    """Return the ends of a number's range and what lies just beyond them."""
    low = kind.get("minimum", kind.get("exclusiveMinimum"))
    high = kind.get("maximum", kind.get("exclusiveMaximum"))
    return [*([] if low is None else [low - step, low]), *([] if high is None else [high, high + step])]


def _text(kind: Schema) -> str:
    match kind.get("format"):
        case "date":
            return "2026-06-21"
        case "date-time":
            return "2026-06-21T09:00:00Z"
    return "x" * max(1, kind.get("minLength", 1))


def _texts(kind: Schema) -> list[str]:
    known = {"date": DATES, "date-time": INSTANTS}.get(kind.get("format", ""), [])
    lengths = [
        kind[name] + more for name in ("minLength", "maxLength") if name in kind for more in (-1, 0, 1)
    ]
    return [*known, *TEXTS, *("x" * length for length in lengths if length < 100_000)]


def _as_text(values: Iterator[Any]) -> Iterator[str]:
    """Return values as an address has them, each once."""
    return iter(dict.fromkeys([*map(str, values), "true", "NaN"]))
