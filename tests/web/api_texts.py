"""Every place of the API that takes a text, and texts for it: those of the forms, and tables of files."""

import json
import random
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote

import httpx

from tests.web.forms import HOSTILE, WORLD

METHODS = ("get", "post", "put", "patch", "delete")
ENDLESS = "/api/v1/stream"
"""It never ends; `tests/web/test_stream.py` holds what it takes."""
CALCULATED, SELDOM = ("/api/v1/simulations", "/api/v1/studies/programs"), 10
"""What calculates for seconds takes one text where the others take so many."""
JSON = "application/json"
TABLE = "time,azimuth_deg,elevation_deg\r\n06:00:00,90.5,20\r\n12:00:00,180,60,5\r\n"
TABLES = (
    TABLE.encode("utf-8-sig"),
    TABLE.encode("utf-16"),
    TABLE.replace(",", ";").encode("utf-8-sig"),
    TABLE.replace(",", ";").replace(".", ",").encode("cp1252"),
    b"sep=;\r\n" + TABLE.replace(",", ";").encode(),
    TABLE.replace(",", "\t").encode(),
    TABLE.replace("\r\n", "\r").encode(),
    "Süd;Höhe\r\n".encode("latin-1") + TABLE.encode(),
    TABLE.encode() + b";;;;\r\n" * 1000,
    b"=1+1,@SUM(A1),-2\r\n",
    b"\x00" * 1000,
    b"\xff\xfe\x00",
    b"PK\x03\x04" + bytes(range(256)),
    b"",
)
"""Tables as Excel and editors save them, and files that are none."""


@dataclass(frozen=True, slots=True)
class Place:
    """One text that an operation takes: in its path, its query, a header, or its body."""

    method: str
    path: str
    where: str
    name: tuple[str | int, ...]
    operation: dict[str, Any] = field(hash=False, compare=False)


def every_place(document: dict[str, Any]) -> list[Place]:
    """Return every place of the document where a text goes in."""
    return [
        place
        for path, item in document["paths"].items()
        for method in METHODS
        if method in item and path != ENDLESS
        for place in _places(method, path, item[method])
    ]


def _places(method: str, path: str, operation: dict[str, Any]) -> Iterator[Place]:
    for parameter in operation.get("parameters", ()):
        yield Place(method, path, parameter["in"], (parameter["name"],), operation)
    for kind, content in _contents(operation):
        if kind == JSON:
            for name in _leaves(_example(content)):
                yield Place(method, path, "json", name, operation)
        yield Place(method, path, kind, (), operation)


def _contents(operation: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    return list(operation.get("requestBody", {"content": {}})["content"].items())


def _example(content: dict[str, Any]) -> Any:
    examples = content.get("examples")
    return next(iter(examples.values()))["value"] if examples else content.get("example", {})


def _leaves(value: Any, name: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    yield name
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in pairs:
        yield from _leaves(inner, (*name, key))


def _with(value: Any, name: tuple[str | int, ...], text: str) -> Any:
    if not name:
        return text
    copy: Any = value.copy()
    copy[name[0]] = _with(value[name[0]], name[1:], text)
    return copy


def texts_for(place: Place) -> list[str | bytes]:
    """Return all that is worth sending to a place; a whole body is of bytes."""
    texts = (*HOSTILE, *WORLD)
    if place.where in ("path", "query", "header", "json"):
        return list(texts)
    return [*TABLES, *(text.encode("utf-8", "replace") for text in texts)]


def request_with(place: Place, text: str | bytes, client: httpx.AsyncClient) -> httpx.Request:
    """Return the operation's example with this text in its place."""
    path, query, headers = place.path, {}, {}
    for parameter in place.operation.get("parameters", ()):
        name, where, schema = parameter["name"], parameter["in"], parameter["schema"]
        is_place = place.where == where and place.name == (name,)
        value = str(text if is_place else (schema.get("examples") or [schema.get("default", "T1")])[0])
        if where == "path":
            path = path.replace(f"{{{name}}}", quote(value.encode("utf-8", "replace"), safe=""))
        elif where == "query" and (is_place or parameter.get("required")):
            query[name] = value
        elif is_place or parameter.get("required"):
            headers[name] = value.encode("utf-8", "replace").translate(None, b"\r\n\x00")
    body, kind = _body(place, text)
    if "content" in body:
        headers["Content-Type"] = kind.encode()
    return client.build_request(place.method.upper(), path, params=query, headers=headers, **body)


def _body(place: Place, text: str | bytes) -> tuple[dict[str, Any], str]:
    """Return what the client is to send, and its content type: the example, or the text in it or instead."""
    for kind, content in _contents(place.operation):
        example = _example(content)
        if kind.startswith("multipart/"):
            data = text if isinstance(text, bytes) else text.encode("utf-8", "replace")
            return {"files": {"file": (data[:20].decode("latin-1"), data)}}, kind
        if place.where == kind:
            return {"content": text}, kind
        if place.where == "json":
            return {"content": json.dumps(_with(example, place.name, str(text)))}, kind
        return {"content": example if isinstance(example, str) else json.dumps(example)}, kind
    return {}, ""


async def send_texts(client: httpx.AsyncClient, document: dict[str, Any], each: int, seed: int) -> int:
    """Send that many texts to each place and return how many were sent; no answer may be a failure."""
    chance, sent = random.Random(seed), 0
    for place in every_place(document):
        texts = texts_for(place)
        for text in chance.sample(texts, each // SELDOM if place.path in CALCULATED else each):
            answer = await client.send(request_with(place, text, client))
            assert answer.status_code < 500 or answer.status_code == 503, (place, text, answer.text)
            sent += 1
    return sent
