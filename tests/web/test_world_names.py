"""Names as people type and paste them: one spelling of each is stored, without what is not seen."""

import json
import re
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from html import unescape
from io import BytesIO
from pathlib import Path
from typing import Any
from unicodedata import normalize

import httpx
import pytest
from PIL import Image
from pydantic import TypeAdapter, ValidationError

from app.base.logs import _on_one_line
from app.base.names import JOINERS, clean, tidy
from app.gateway.sunspec_points import _text_words
from app.tracker.settings.mechanics import Region
from app.web.features.records.photos import PhotoRefused
from app.web.features.records.record_orders import add_photo
from app.web.features.records.records_api import NewRecord
from app.web.features.records.signatures import SignatureRefused, SignatureRole, signature
from app.web.features.studies.simulations_api import NewSimulation
from app.web.features.studies.study_orders import NewStudy
from tests.fakes import FakeMachine, fake_app, serving
from tests.golden.table import rows
from tests.web.desk import Desk
from tests.web.filled import values_of

NAMES = rows("world/names.csv")
REFUSED = "refused "
T1, API = "/trackers/T1", "/api/v1/trackers/T1"
TYPED, STORED = "Gu\u0308nes\u0327\u00a0K.", "Güneş K."
UNSEEN, CODE = "G\u202eK", "U+202E"


@pytest.mark.parametrize("row", NAMES, ids=lambda row: row["why"])
def test_a_name_has_one_spelling_or_is_refused(row: dict[str, str]) -> None:
    if row["stored"].startswith(REFUSED):
        with pytest.raises(ValueError, match=re.escape(f"({row['stored'].removeprefix(REFUSED)})")):
            clean(row["text"])
        return
    stored = clean(row["text"])
    assert stored == row["stored"] == tidy(stored)
    words = _text_words(stored, 8)
    told = b"".join(one.to_bytes(2) for one in words).rstrip(b"\0").decode()
    assert len(words) == 8
    assert stored.startswith(told)
    assert told == told.rstrip(JOINERS)
    assert "\n" not in _on_one_line(stored)


Entrance = tuple[str, str, str, dict[str, Any]]
CORNERS = [{"azimuth_deg": one, "elevation_deg": other} for one, other in ((170, 0), (190, 0), (190, 30))]
ENTRANCES: list[Entrance] = [
    ("site", "POST", "/site/name", {"name": None}),
    ("site", "PATCH", "/api/v1/site", {"name": None}),
    ("tracker", "POST", f"{T1}/settings", {"name": None}),
    ("tracker", "PATCH", API, {"name": None}),
    ("region", "POST", f"{T1}/machine", {"region0_name": None, "region0_corners": "170 0; 190 0; 190 30"}),
    ("region", "PATCH", API, {"machine": {"regions": [{"name": None, "corners": CORNERS}]}}),
    (
        "program",
        "POST",
        f"{T1}/strategy/program",
        {"program_name": None, "at": ["06:00"], "first": ["110"], "second": ["30"]},
    ),
    (
        "program",
        "PUT",
        f"{API}/program",
        {"name": None, "steps": [{"from_h": 6, "first_deg": 110, "second_deg": 30}]},
    ),
    ("token", "POST", "/tokens", {"name": None, "days": "1", "scope": ["read"]}),
    ("token", "POST", "/api/v1/tokens", {"name": None, "scopes": ["read"]}),
]
"""What has a name, and what sends it; the name stands in the place of None."""
FORMS = {path: path for path in (f"{T1}/settings", f"{T1}/machine", "/tokens")}
FORMS[f"{T1}/strategy/program"] = f"{T1}/strategy"
"""Forms that are sent as their pages show them, with what is typed in its place."""
LIMITED = ("site", "tracker", "region")


def with_name(body: Any, name: str) -> Any:
    match body:
        case None:
            return name
        case dict():
            return {key: with_name(value, name) for key, value in body.items()}
        case list():
            return [with_name(value, name) for value in body]
    return body


async def send(desk: Desk, entrance: Entrance, name: str) -> httpx.Response:
    _, method, path, body = entrance
    typed = with_name(body, name)
    if path.startswith("/api/"):
        return await desk.ask(method, path, json=typed)
    shown = values_of((await desk.ask("GET", FORMS[path])).text, path) if path in FORMS else {}
    return await desk.ask(method, path, data={**shown, **typed})


async def read(desk: Desk, what: str) -> str:
    """Return the name under which something is stored; a token is removed."""
    tracker = (await desk.ask("GET", API)).json()
    match what:
        case "site":
            return str((await desk.ask("GET", "/api/v1/site")).json()["site_name"])
        case "tracker":
            return str(tracker["name"])
        case "region":
            return str(tracker["machine"]["regions"][0]["name"])
        case "program":
            return str(tracker["strategy"]["program"]["name"])
    [token] = (await desk.ask("GET", "/api/v1/tokens")).json()["items"]
    await desk.ask("DELETE", f"/api/v1/tokens/{token['token_id']}")
    return str(token["name"])


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as built:
        await built.forward(0.5)
        yield built


async def test_every_entrance_stores_one_spelling_and_counts_its_letters(desk: Desk) -> None:
    longest = "ảấộữịè" * 10
    for entrance in ENTRANCES:
        is_limited = entrance[0] in LIMITED
        names = {TYPED: STORED} | ({normalize("NFD", longest): longest} if is_limited else {})
        for typed, stored in names.items():
            answer = await send(desk, entrance, typed)
            assert answer.status_code < 400, (entrance, answer.text)
            assert await read(desk, entrance[0]) == stored, entrance
        refused = await send(desk, entrance, UNSEEN)
        assert refused.status_code == 422, (entrance, refused.text)
        assert f"contains an invisible character ({CODE})" in unescape(refused.text), entrance
        assert not is_limited or (await send(desk, entrance, longest + "x")).status_code == 422
        await desk.forward(0.1)


async def test_a_new_tracker_is_refused_beside_its_name(client: httpx.AsyncClient) -> None:
    answer = await client.post("/trackers", data={"tracker_id": "T9", "name": UNSEEN})
    assert answer.status_code == 422
    assert 'id="name-error"' in answer.text


MODELS: dict[str, Callable[[str], str]] = {
    "simulation": lambda name: NewSimulation(tracker_id="T1", date="2026-06-21", title=name).title,
    "study": lambda name: NewStudy(latitude_deg=41, longitude_deg=36, date="2026-06-21", title=name).title,
    "signature": lambda name: NewRecord(signatures=[{"role": "technician", "name": name}]).signatures[0].name,
    "remark": lambda name: NewRecord(signatures=[{"role": "technician", "name": "A"}], remark=name).remark,
    "signature, page": lambda name: getattr(signature(SignatureRole.TECHNICIAN, name, "[]"), "name"),  # noqa: B009
}


@pytest.mark.parametrize("model", MODELS)
def test_texts_of_the_api_have_one_spelling(model: str) -> None:
    assert MODELS[model](TYPED) == STORED
    with pytest.raises((ValidationError, SignatureRefused), match=r"U\+202E"):
        MODELS[model](UNSEEN)


def test_a_remark_has_lines() -> None:
    assert clean("Gu\u0308nes\u0327 \r\n\r\nna\u00adme\n", lines=True) == "Güneş\n\nname"
    with pytest.raises(ValueError, match="U\\+202E"):
        clean("one\ntwo\u202e", lines=True)


PAGES = {"lock": ("name", "reason"), "service": ("name",), "settings-lock/open": ("reason",)}
"""Texts of a tracker that go into its journal: their form, and their fields."""


async def test_what_is_typed_at_a_tracker_has_one_spelling(desk: Desk) -> None:
    for path, fields in PAGES.items():
        typed = {field: f"{TYPED} {path} {field}" for field in fields}
        for field in fields:
            refused = await desk.ask("POST", f"{T1}/{path}", data={**typed, field: UNSEEN})
            assert refused.status_code in (409, 422), (path, field)
            assert f"invisible character ({CODE})" in unescape(refused.text)
        answer = await desk.ask("POST", f"{T1}/{path}", data=typed)
        assert answer.status_code == 303, (path, answer.text)
        events = (await desk.ask("GET", "/api/v1/journal")).json()["items"]
        for field in fields:
            assert f"{STORED} {path} {field}" in json.dumps(events, ensure_ascii=False)
    asked = {"text": f"{TYPED} service"}
    assert (await desk.ask("GET", "/api/v1/journal", params=asked)).json()["items"], "found as it was typed"
    assert STORED in unescape((await desk.ask("GET", "/journal", params=asked)).text)


@pytest.mark.parametrize("name", ["می\u200cخواهم", "Team 👩\u200d🔧", '=1+1,"x"'])
async def test_a_name_goes_wherever_names_go(name: str, machine: FakeMachine) -> None:
    for tracker in machine.trackers.values():
        tracker.config = replace(tracker.config, name=name)
    machine.site = replace(machine.site, name=name)
    async with serving(fake_app(machine)) as client:
        for page in (f"{T1}/record", f"{T1}/settings", f"{T1}/label"):
            assert name in unescape((await client.get(page)).text), page
        paper = await client.get(f"{API}/record", params={"format": "pdf"})
        assert paper.content.startswith(b"%PDF")
        assert (await client.get("/metrics")).status_code == 200
        assert (await client.get(API)).json()["name"] == name


async def test_a_caption_has_one_spelling() -> None:
    sent: list[Any] = []

    async def send(order: Any) -> None:
        sent.append(order)

    picture = BytesIO()
    Image.new("RGB", (2, 2)).save(picture, "PNG")
    await add_photo(send, "T1", picture.getvalue(), TYPED)
    with pytest.raises(PhotoRefused, match="U\\+202E"):
        await add_photo(send, "T1", picture.getvalue(), UNSEEN)
    assert [order.caption for order in sent] == [STORED]


async def test_a_reason_to_take_control_has_one_spelling(desk: Desk) -> None:
    answer = await desk.ask("POST", f"{API}/control", json={"action": "take_over", "reason": UNSEEN})
    assert answer.status_code == 422
    assert CODE in answer.text


def test_regions_from_before_are_read() -> None:
    corners = [{"azimuth_deg": 1, "elevation_deg": 2}] * 3
    assert TypeAdapter(Region).validate_python({"name": "a\u202eb", "corners": corners}).name == "a\u202eb"


def test_a_text_that_is_too_long_to_be_stored_is_not_composed() -> None:
    marks = "a" + "\N{COMBINING ACUTE ACCENT}\N{COMBINING DOT BELOW}" * 200_000
    assert tidy(marks) == marks
