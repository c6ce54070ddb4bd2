"""Every number of every request, written as true and as a text, is refused at whatever depth it stands."""

from collections.abc import AsyncIterator, Iterator
from copy import deepcopy
from typing import Any

import pytest
from fastapi.routing import APIRoute
from httpx import AsyncClient
from pydantic import TypeAdapter, ValidationError

from app.gateway import mqtt_commands
from app.link.codec import LENGTH_BYTES, Execute, FrameBroken, decode_request, encode_request
from app.tracker.commands.commands import Move
from app.tracker.settings.config import Orientation
from app.web import sockets
from tests.fakes import FakeMachine, fake_app, serving
from tests.web.test_openapi import APP

Place = tuple[str | int, ...]
POSING = (True, "1")
VARIANTS = 20
LEFT_OUT: dict[str, tuple[tuple[str, ...], ...]] = {
    "PUT /api/v1/site/clock": (("at",),),
    "POST /api/v1/trackers/{tracker_id}/shows": (("start", "end"), ("date",)),
    "POST /api/v1/simulations": (
        ("start", "end", "weather.steps", "weather.csv"),
        ("date", "weather.scenario", "weather.csv"),
        ("date", "weather.steps", "weather.scenario"),
    ),
}
"""What requests cannot have together: each of these is left out in turn, so that nothing is never sent."""


def sample(schema: dict[str, Any], known: dict[str, Any], variant: int = 0) -> Any:  # noqa: C901
    """Return a value with every field that the schema knows; `variant` chooses among alternatives."""
    if "$ref" in schema:
        return sample(known[schema["$ref"].rpartition("/")[2]], known, variant)
    for word in ("const", "default"):
        if schema.get(word) is not None:
            return schema[word]
    if schema.get("examples"):
        return schema["examples"][0]
    if "enum" in schema:
        return schema["enum"][0]
    for word in ("anyOf", "oneOf"):
        if word in schema:
            real = [one for one in schema[word] if one.get("type") != "null"]
            return sample(real[min(variant, len(real) - 1)], known, variant)
    match schema.get("type"):
        case "object":
            parts = schema.get("properties", {}).items()
            found = {name: sample(one, known, variant) for name, one in parts}
            return found | ({"corners": 3 * found["corners"]} if "corners" in found else {})
        case "array":
            inner = schema.get("prefixItems") or [schema.get("items", {})]
            return [sample(one, known, variant) for one in inner]
        case "number" | "integer":
            low = schema.get("minimum", schema.get("exclusiveMinimum", 0))
            return min(low + 1, schema.get("maximum", low + 1))
        case "boolean":
            return True
        case _:
            return "2026-06-21T12:00:00+03:00" if schema.get("format") == "date-time" else "2026-06-21"


def adapters() -> dict[str, TypeAdapter[Any]]:
    """Return what reads the body of every request of the API that has one, files aside."""
    return {
        f"{min(route.methods)} {route.path}": route.body_field._type_adapter
        for route in APP.routes
        if isinstance(route, APIRoute) and route.path.startswith("/api/") and route.body_field is not None
        if "Body_" not in str(route.body_field.field_info.annotation)
    }


ADAPTERS = adapters()


def bodies(name: str) -> list[Any]:
    """Return bodies that are right and have, together, every field that there is."""
    schema = ADAPTERS[name].json_schema()
    found: list[Any] = []
    for variant in range(VARIANTS):
        for left_out in LEFT_OUT.get(name, ((),)):
            body = sample(schema, schema.get("$defs", {}), variant)
            for path in left_out:
                _without(body, path.split("."))
            if body not in found:
                found.append(body)
    return found


def _without(body: Any, path: list[str]) -> None:
    for name in path[:-1]:
        body = body[name]
    body.pop(path[-1], None)


def numbers(body: Any, place: Place = ()) -> Iterator[Place]:
    """Yield where every number of a body stands."""
    if isinstance(body, dict | list):
        for key, value in body.items() if isinstance(body, dict) else enumerate(body):
            yield from numbers(value, (*place, key))
    elif isinstance(body, int | float) and not isinstance(body, bool):
        yield place


def kind_of(body: Any, place: Place) -> tuple[object, ...]:
    """Return the field at a place, the same in every body that has it, among the fields beside it."""
    names, inner = [], body
    for key in place:
        names.append((key, frozenset(inner)) if isinstance(inner, dict) else ())
        inner = inner[key]
    return *names, body.get("type")


def with_value(body: Any, place: Place, value: object) -> Any:
    changed = deepcopy(body)
    inner = changed
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    return changed


@pytest.mark.parametrize("name", ADAPTERS)
def test_a_number_written_as_something_else_is_refused(name: str) -> None:
    read, tried = ADAPTERS[name].validate_python, set()
    for body in bodies(name):
        read(body)
        for place in numbers(body):
            if (kind := kind_of(body, place)) in tried:
                continue
            tried.add(kind)
            for posing in POSING:
                with pytest.raises(ValidationError):
                    read(with_value(body, place, posing))


def test_the_walk_meets_the_numbers_that_there_are() -> None:
    met = {str(place[-1]) for name in ADAPTERS for body in bodies(name) for place in numbers(body)}
    assert {"azimuth_deg", "latitude_deg", "port", "direction", "wind_mps", "duration_s"} <= met
    assert len(met) > 100


@pytest.mark.parametrize("number", [1, 1.5, 1e-9])
def test_an_integer_is_a_number(number: float) -> None:
    body = {"type": "move", "azimuth_deg": number, "elevation_deg": 20}
    assert ADAPTERS["POST /api/v1/trackers/{tracker_id}/commands"].validate_python(body)


@pytest.fixture
async def api() -> AsyncIterator[AsyncClient]:
    async with serving(fake_app(FakeMachine())) as client:
        yield client


@pytest.mark.parametrize("azimuth", ["true", '"150"', "false", "null", "[1]"])
async def test_a_move_to_no_number_moves_nothing(api: AsyncClient, azimuth: str) -> None:
    body = f'{{"type": "move", "azimuth_deg": {azimuth}, "elevation_deg": 20}}'
    headers = {"Content-Type": "application/json"}
    answer = await api.post("/api/v1/trackers/T1/commands", content=body, headers=headers)
    assert answer.status_code == 422
    assert "azimuth_deg" in answer.text


@pytest.mark.parametrize("posing", ["true", '"1"'])
def test_the_live_socket_and_mqtt_take_no_number_for_another(posing: str) -> None:
    beat = (
        '{{"type": "jog", "tracker_id": "T1", "press_id": "p", "axis": "azimuth", "direction": {}, '
        '"speed": "slow", "sequence": {}, "tc": {}, "rtt_ms": {}, "epoch": {}}}'
    )
    move = '{{"type": "move", "azimuth_deg": {}, "elevation_deg": {}, "client": "scada"}}'
    for adapter, text in ((sockets._incoming, beat), (mqtt_commands.MESSAGES, move)):
        count = text.count("{}")
        adapter.validate_json(text.format(*["1"] * count))
        for place in range(count):
            values = [posing if one == place else "1" for one in range(count)]
            with pytest.raises(ValidationError):
                adapter.validate_json(text.format(*values))


@pytest.mark.parametrize("posing", ["true", '"1"'])
def test_the_link_takes_no_number_for_another(posing: str) -> None:
    order = Execute(1, Move(Orientation(150.0, 20.0)), "op", "T1", None, None, 5.0, epoch=7, rank=1)
    text = encode_request(order)[LENGTH_BYTES:].decode()
    assert decode_request(text.encode()) == order
    for number in ("150.0", "20.0", '"number":1', "5.0", '"epoch":7', '"rank":1'):
        name = number.rpartition(":")[0]
        assert number in text
        with pytest.raises(FrameBroken):
            decode_request(text.replace(number, f"{name}:{posing}" if name else posing, 1).encode())
