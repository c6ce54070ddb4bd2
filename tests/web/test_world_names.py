"""Names as people type and paste them: one spelling of each is stored, without what is not seen."""

import json
import re
from collections.abc import AsyncIterator, Awaitable, Callable
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
Sends = Callable[[Desk, str], Awaitable[httpx.Response]]
Reads = Callable[[Desk], Awaitable[str]]
CORNERS = "170 0; 190 0; 190 30"
PROGRAM = {"steps": [{"from_h": 6, "first_deg": 110, "second_deg": 30}]}


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


async def form(desk: Desk, page: str, typed: dict[str, Any], *, action: str = "") -> httpx.Response:
    """Send a form of a page as it is shown, with what is typed in its place."""
    shown = values_of((await desk.ask("GET", page)).text, action or page)
    assert shown, f"{page} has no form {action or page}"
    return await desk.ask("POST", action or page, data={**shown, **typed})


async def config(desk: Desk) -> Any:
    return (await desk.ask("GET", API)).json()


async def site_name(desk: Desk) -> str:
    return str((await desk.ask("GET", "/api/v1/site")).json()["site_name"])


async def tracker_name(desk: Desk) -> str:
    return str((await config(desk))["name"])


async def region_name(desk: Desk) -> str:
    return str((await config(desk))["machine"]["regions"][0]["name"])


async def program_name(desk: Desk) -> str:
    return str((await desk.ask("GET", f"{API}/program")).json()["name"])


async def token_name(desk: Desk) -> str:
    """Return the name of the only token, and remove it."""
    [token] = (await desk.ask("GET", "/api/v1/tokens")).json()["items"]
    await desk.ask("DELETE", f"/api/v1/tokens/{token['token_id']}")
    return str(token["name"])


def region(name: str) -> dict[str, Any]:
    corners = [{"azimuth_deg": one, "elevation_deg": other} for one, other in ((170, 0), (190, 0), (190, 30))]
    return {"machine": {"regions": [{"name": name, "corners": corners}]}}


ENTRANCES: dict[str, tuple[Sends, Reads]] = {
    "site, page": (lambda desk, name: desk.ask("POST", "/site/name", data={"name": name}), site_name),
    "site, API": (lambda desk, name: desk.ask("PATCH", "/api/v1/site", json={"name": name}), site_name),
    "tracker, page": (lambda desk, name: form(desk, f"{T1}/settings", {"name": name}), tracker_name),
    "tracker, API": (lambda desk, name: desk.ask("PATCH", API, json={"name": name}), tracker_name),
    "region, page": (
        lambda desk, name: form(desk, f"{T1}/machine", {"region0_name": name, "region0_corners": CORNERS}),
        region_name,
    ),
    "region, API": (lambda desk, name: desk.ask("PATCH", API, json=region(name)), region_name),
    "program, page": (
        lambda desk, name: form(
            desk,
            f"{T1}/strategy",
            {"program_name": name, "at": ["06:00"], "first": ["110"], "second": ["30"]},
            action=f"{T1}/strategy/program",
        ),
        program_name,
    ),
    "program, API": (
        lambda desk, name: desk.ask("PUT", f"{API}/program", json={"name": name, **PROGRAM}),
        program_name,
    ),
    "token, page": (
        lambda desk, name: form(desk, "/tokens", {"name": name, "days": "1", "scope": ["read"]}),
        token_name,
    ),
    "token, API": (
        lambda desk, name: desk.ask("POST", "/api/v1/tokens", json={"name": name, "scopes": ["read"]}),
        token_name,
    ),
}
"""Where each kind of name is typed, and where it is read again."""
LIMITED = ("site, page", "site, API", "tracker, page", "tracker, API", "region, page")


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as built:
        await built.forward(0.5)
        yield built


async def test_every_entrance_stores_one_spelling_and_counts_its_letters(desk: Desk) -> None:
    longest = "ảấộữịè" * 10
    for entrance, (send, read) in ENTRANCES.items():
        names = {TYPED: STORED} | ({normalize("NFD", longest): longest} if entrance in LIMITED else {})
        for typed, stored in names.items():
            answer = await send(desk, typed)
            assert answer.status_code < 400, (entrance, answer.text)
            assert await read(desk) == stored, entrance
        refused = await send(desk, UNSEEN)
        assert refused.status_code == 422, (entrance, refused.text)
        assert f"contains an invisible character ({CODE})" in unescape(refused.text), entrance
        assert entrance not in LIMITED or (await send(desk, longest + "x")).status_code == 422
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
