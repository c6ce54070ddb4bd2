"""Names as people type and paste them: one spelling of each is stored, without what is not seen."""

import json
from collections.abc import Awaitable, Callable
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
from app.base.message import told_of_value
from app.base.names import JOINERS, clean, tidy, unseen
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
Sends = Callable[[Desk, str], Awaitable[httpx.Response]]
Reads = Callable[[Desk], Awaitable[str]]
CORNERS = "170 0; 190 0; 190 30"
PROGRAM = {"steps": [{"from_h": 6, "first_deg": 110, "second_deg": 30}]}


def code_of(row: dict[str, str]) -> str:
    """Return the code of the character for which a name is refused, nothing where it is stored."""
    return row["stored"].removeprefix(REFUSED) if row["stored"].startswith(REFUSED) else ""


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


@pytest.fixture
async def desk(tmp_path: Path) -> Any:
    async with Desk(tmp_path) as built:
        await built.forward(0.5)
        yield built


@pytest.mark.parametrize("entrance", ENTRANCES)
async def test_a_name_is_stored_in_one_spelling_or_refused(entrance: str, desk: Desk) -> None:
    send, read = ENTRANCES[entrance]
    for row in NAMES:
        answer = await send(desk, row["text"])
        if code := code_of(row):
            assert answer.status_code == 422, (row["why"], answer.text)
            assert f"contains an invisible character ({code})" in unescape(answer.text), row["why"]
        else:
            assert answer.status_code < 400, (row["why"], answer.text)
            assert await read(desk) == row["stored"], row["why"]
        await desk.forward(0.1)


@pytest.mark.parametrize("row", NAMES, ids=lambda row: row["why"])
async def test_a_new_tracker_has_a_name_as_it_is_stored(row: dict[str, str]) -> None:
    machine = FakeMachine()
    async with serving(fake_app(machine)) as client:
        answer = await client.post("/trackers", data={"tracker_id": "T9", "name": row["text"]})
    if code := code_of(row):
        assert answer.status_code == 422
        assert f"({code})" in unescape(answer.text)
        assert 'id="name-error"' in answer.text
    else:
        assert answer.status_code == 303
        assert machine.trackers["T9"].config.name == row["stored"]


@pytest.mark.parametrize("row", NAMES, ids=lambda row: row["why"])
def test_whoever_signs_has_one_spelling(row: dict[str, str]) -> None:
    if code := code_of(row):
        if code in ("U+0009", "U+0085", "U+2028", "U+2029"):
            return  # a blank between two parts of a name
        with pytest.raises(SignatureRefused, match=code.replace("+", r"\+")):
            signature(SignatureRole.TECHNICIAN, row["text"], "[]")
    else:
        signed = signature(SignatureRole.TECHNICIAN, row["text"], "[]")
        assert signed is not None
        assert signed.name == row["stored"]


MODELS: dict[str, Callable[[str], str]] = {
    "simulation": lambda name: NewSimulation(tracker_id="T1", date="2026-06-21", title=name).title,
    "study": lambda name: NewStudy(latitude_deg=41, longitude_deg=36, date="2026-06-21", title=name).title,
    "signature": lambda name: NewRecord(signatures=[{"role": "technician", "name": name}]).signatures[0].name,
    "remark": lambda name: NewRecord(signatures=[{"role": "technician", "name": "A"}], remark=name).remark,
}


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("row", NAMES, ids=lambda row: row["why"])
def test_texts_of_the_api_have_one_spelling(row: dict[str, str], model: str) -> None:
    code = code_of(row)
    if not code:
        assert MODELS[model](row["text"]) == row["stored"]
    elif not (model == "remark" and code in ("U+0085", "U+2028", "U+2029")):
        with pytest.raises(ValidationError) as refused:
            MODELS[model](row["text"])
        assert code in told_of_value(refused.value.errors()[0])


@pytest.mark.parametrize("row", NAMES, ids=lambda row: row["why"])
def test_what_is_stored_stays_as_it_is(row: dict[str, str]) -> None:
    stored = tidy(row["text"])
    assert tidy(stored) == stored
    assert (unseen(stored) is None) == (not code_of(row))


def test_a_remark_has_lines() -> None:
    assert clean("Gu\u0308nes\u0327 \r\n\r\nna\u00adme\n", lines=True) == "Güneş\n\nname"
    with pytest.raises(ValueError, match="U\\+202E"):
        clean("one\ntwo\u202e", lines=True)


PAGES: dict[str, tuple[str, str]] = {
    "a maintenance inhibit": ("lock", "name"),
    "its reason": ("lock", "reason"),
    "service mode": ("service", "name"),
    "unlocking the settings": ("settings-lock/open", "reason"),
}
"""Texts of a tracker that go into its journal: their form, and their field."""


@pytest.mark.parametrize("what", PAGES)
@pytest.mark.parametrize(
    ("typed", "stored"), [("Gu\u0308nes\u0327\u00a0K.", "Güneş K."), ("G\u202eK", "U+202E")]
)
async def test_what_is_typed_at_a_tracker_has_one_spelling(
    what: str, typed: str, stored: str, desk: Desk
) -> None:
    path, field = PAGES[what]
    answer = await desk.ask("POST", f"{T1}/{path}", data={"name": "A", "reason": "B", field: typed})
    if stored == "U+202E":
        assert answer.status_code in (409, 422)
        assert "invisible character (U+202E)" in unescape(answer.text)
        return
    assert answer.status_code == 303, answer.text
    events = (await desk.ask("GET", "/api/v1/journal")).json()["items"]
    assert any(stored in json.dumps(one, ensure_ascii=False) for one in events), events
    if field == "name":
        asked = {"text": typed}
        assert (await desk.ask("GET", "/api/v1/journal", params=asked)).json()["items"], (
            "found as it was typed"
        )
        assert stored in unescape((await desk.ask("GET", "/journal", params=asked)).text)


STORED = dict.fromkeys(row["stored"] for row in NAMES if not code_of(row))


@pytest.mark.parametrize("name", STORED)
async def test_a_name_with_joiners_goes_wherever_names_go(name: str) -> None:
    machine = FakeMachine()
    for tracker in machine.trackers.values():
        tracker.config = replace(tracker.config, name=name)
    machine.site = replace(machine.site, name=name)
    async with serving(fake_app(machine)) as client:
        for page in (f"{T1}/record", f"{T1}/settings", f"{T1}/label"):
            answer = await client.get(page)
            assert answer.status_code == 200, page
            assert name in unescape(answer.text), page
        paper = await client.get(f"{API}/record", params={"format": "pdf"})
        assert paper.content.startswith(b"%PDF")
        assert (await client.get("/metrics")).status_code == 200
        assert (await client.get(API)).json()["name"] == name
    words = _text_words(name, 8)
    told = b"".join(one.to_bytes(2) for one in words).rstrip(b"\0").decode()
    assert len(words) == 8
    assert name.startswith(told)
    assert told == told.rstrip(JOINERS)
    assert "\n" not in _on_one_line(name)


async def test_the_length_is_that_of_what_is_stored(desk: Desk) -> None:
    longest = "ảấộữịè" * 10
    for what in ("site, page", "site, API", "tracker, page", "tracker, API", "region, page"):
        send, read = ENTRANCES[what]
        assert (await send(desk, normalize("NFD", longest))).status_code < 400
        assert await read(desk) == longest
        assert (await send(desk, longest + "x")).status_code == 422


@pytest.mark.parametrize(("typed", "stored"), [("Gu\u0308nes\u0327\u00a0K.", "Güneş K."), ("G\u202e", "")])
async def test_a_caption_has_one_spelling(typed: str, stored: str) -> None:
    sent: list[Any] = []

    async def send(order: Any) -> None:
        sent.append(order)

    picture = BytesIO()
    Image.new("RGB", (2, 2)).save(picture, "PNG")
    if stored:
        await add_photo(send, "T1", picture.getvalue(), typed)
        assert [order.caption for order in sent] == [stored]
    else:
        with pytest.raises(PhotoRefused, match="U\\+202E"):
            await add_photo(send, "T1", picture.getvalue(), typed)
        assert not sent


async def test_a_reason_to_take_control_has_one_spelling(desk: Desk) -> None:
    asked = {"action": "take_over", "reason": "Gu\u0308nes\u202e"}
    answer = await desk.ask("POST", f"{API}/control", json=asked)
    assert answer.status_code == 422
    assert "U+202E" in answer.text


def test_regions_from_before_are_read() -> None:
    corners = [{"azimuth_deg": 1, "elevation_deg": 2}] * 3
    assert TypeAdapter(Region).validate_python({"name": "a\u202eb", "corners": corners}).name == "a\u202eb"


def test_a_text_that_is_too_long_to_be_stored_is_not_composed() -> None:
    marks = "a" + "\N{COMBINING ACUTE ACCENT}\N{COMBINING DOT BELOW}" * 200_000
    assert tidy(marks) == marks
    with pytest.raises(ValidationError, match="at most 120 characters"):
        NewStudy.model_validate({"date": "2026-06-21", "title": marks})
