"""Every number of every request, written as true and as a text, is refused at whatever depth it stands."""

from collections.abc import Iterator
from copy import deepcopy
from functools import cache
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
from app.web.api.base import Input
from tests.fakes import FakeMachine, fake_app

POSING = (True, "1")
T1 = "/api/v1/trackers/{tracker_id}"
PATCH = f"PATCH {T1}"
PROGRAM = {"name": "p", "steps": [{"from_h": 6, "first_deg": 1, "second_deg": 30}]}
CORNERS = [{"azimuth_deg": 1, "elevation_deg": 0}] * 3
DAY = {"tracker_id": "T1", "date": "2026-06-21"}
NUMBERS: list[tuple[str, dict[str, Any], str]] = [
    (f"POST {T1}/commands", {"type": "move", "azimuth_deg": 1, "elevation_deg": 20}, "azimuth_deg"),
    (PATCH, {"azimuth": {"minimum_deg": 1}}, "azimuth.minimum_deg"),
    (PATCH, {"strategy": {"kind": "interval", "minutes": 1}}, "strategy.minutes"),
    (
        PATCH,
        {"strategy": {"kind": "stepped", "program": PROGRAM}},
        "strategy.program.steps.0.first_deg",
    ),
    (
        PATCH,
        {"protection": {"stows": {"snow": {"azimuth_deg": 1}}}},
        "protection.stows.snow.azimuth_deg",
    ),
    (
        PATCH,
        {"machine": {"regions": [{"name": "W", "corners": CORNERS}]}},
        "machine.regions.0.corners.2.azimuth_deg",
    ),
    (f"PUT {T1}/program", PROGRAM, "steps.0.first_deg"),
    (
        "POST /api/v1/simulations",
        DAY | {"weather": {"steps": [{"time": "09:00", "wind_mps": 1}]}},
        "weather.steps.0.wind_mps",
    ),
    (
        "PUT /api/v1/site/horizon",
        {"points": CORNERS[:1]},
        "points.0.azimuth_deg",
    ),
]
"""A number of each depth and kind of place: the request, a right body, and where the number stands."""


@cache
def adapters() -> dict[str, TypeAdapter[Any]]:
    """Return what reads the body of every request of the API that has one, files aside."""
    return {
        f"{min(route.methods)} {route.path}": route.body_field._type_adapter
        for route in fake_app().routes
        if isinstance(route, APIRoute) and route.path.startswith("/api/") and route.body_field is not None
        if "Body_" not in str(route.body_field.field_info.annotation)
    }


def models(schema: Any) -> Iterator[type]:
    """Yield every model that a schema of pydantic reads."""
    if isinstance(schema, dict):
        if schema.get("type") == "model":
            yield schema["cls"]
        schema = list(schema.values())
    if isinstance(schema, list | tuple):
        for inner in schema:
            yield from models(inner)


def test_every_body_is_read_by_models_that_tell_numbers_from_what_poses_as_one() -> None:
    read = {name: set(models(adapter.core_schema)) for name, adapter in adapters().items()}
    assert {name for name, kinds in read.items() if not kinds} == {f"PUT {T1}/program"}
    assert {kind for kinds in read.values() for kind in kinds if not issubclass(kind, Input)} == set()


@pytest.mark.parametrize(("name", "body", "place"), NUMBERS, ids=[place for _, _, place in NUMBERS])
def test_a_number_written_as_something_else_is_refused(name: str, body: dict[str, Any], place: str) -> None:
    read = adapters()[name].validate_python
    *path, last = (int(key) if key.isdigit() else key for key in place.split("."))
    read(body)
    for posing in POSING:
        changed = deepcopy(body)
        inner: Any = changed
        for key in path:
            inner = inner[key]
        inner[last] = posing
        with pytest.raises(ValidationError):
            read(changed)


async def test_a_move_to_no_number_moves_nothing(client: AsyncClient, machine: FakeMachine) -> None:
    body = '{"type": "move", "azimuth_deg": true, "elevation_deg": 20}'
    headers = {"Content-Type": "application/json"}
    answer = await client.post("/api/v1/trackers/T1/commands", content=body, headers=headers)
    assert (answer.status_code, "azimuth_deg" in answer.text) == (422, True)
    assert not machine.orders


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
