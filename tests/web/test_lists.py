"""Every list can be taken along as a file: its key leads to what the page shows, and to no secret."""

import re
from collections.abc import AsyncIterator
from datetime import timedelta
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from fastapi.routing import APIRoute

from app.access.accounts import TokenWish
from app.access.roles import Role
from app.access.tokens import Scope
from tests.fakes import fake_app
from tests.web.desk import Desk
from tests.web.office import HERE, PASSWORD, Office

FILE = re.compile(r'href="(/api/[^"]+)" download="[^"]+\.json"')
KEY = re.compile(r'json_key\("(/api/[^,]+?)"(?:,| ~ \()')
TEMPLATES = Path(__file__).resolve().parents[2] / "templates"
SIGNED = {
    "signatures": [{"role": "technician", "name": "Ayşe Yılmaz", "strokes": [[[10, 20], [400, 250]]]}],
    "confirmed": True,
}
SECRETS = re.compile(r"password|hash|secret|pin", re.IGNORECASE)


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as one:
        yield one


@pytest.fixture
async def office(tmp_path: Path) -> Office:
    office = Office(tmp_path)
    await office.hire(Role.ADMINISTRATOR, Role.OPERATOR)
    return office


def names_in(value: Any) -> set[str]:
    """Return every name that JSON gives to a value, however deep."""
    match value:
        case dict():
            return set(value) | {name for inner in value.values() for name in names_in(inner)}
        case list():
            return {name for inner in value for name in names_in(inner)}
        case _:
            return set()


@pytest.mark.parametrize(
    ("page", "file"),
    [
        ("/", "/api/v1/trackers"),
        ("/recordings", "/api/v1/recordings?limit=1000"),
        ("/records", "/api/v1/records?limit=1000"),
        ("/alarms", "/api/v1/alarms"),
        ("/alarms?view=history", "/api/v1/alarms/history?limit=1000"),
        ("/audit", "/api/v1/audit?limit=1000"),
        ("/audit/access", "/api/v1/audit/access?limit=1000"),
        ("/alarms/guide", "/api/v1/alarms/catalogue"),
        ("/restore", "/api/v1/backups"),
        ("/site/horizon", "/api/v1/site/horizon"),
        ("/records/compare?pick=1&pick=2", "/api/v1/records/comparison?first=1&second=2"),
        ("/trackers/T1/settings", "/api/v1/trackers/T1"),
        ("/trackers/T1/drive-tests", "/api/v1/trackers/T1/drive-tests"),
        ("/trackers/T1/drive", "/api/v1/trackers/T1/drive/choices"),
    ],
)
async def test_a_list_is_taken_along_as_a_file(page: str, file: str, desk: Desk) -> None:
    await fill(desk)
    shown = await desk.ask("GET", page)
    assert file in [unescape(one) for one in FILE.findall(shown.text)]
    answer = await desk.ask("GET", file)
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "application/json"


async def fill(desk: Desk) -> None:
    """Have something stand in every list: two records, a backup, a horizon."""
    for path, told in (
        ("trackers/T1/records", SIGNED),
        ("trackers/T1/records", SIGNED),
        ("backups", None),
    ):
        assert (await desk.ask("POST", f"/api/v1/{path}", json=told)).is_success, path
        await desk.forward(1)
    skyline = {"points": [{"azimuth_deg": 135, "elevation_deg": 8}]}
    assert (await desk.ask("PUT", "/api/v1/site/horizon", json=skyline)).is_success


async def test_what_one_person_ordered_is_taken_along_alone(desk: Desk) -> None:
    assert (await desk.ask("POST", "/api/v1/trackers/T1/records", json=SIGNED)).status_code == 201
    shown = await desk.ask("GET", "/audit?actor=nobody")
    (file,) = FILE.findall(shown.text.replace("&amp;", "&"))
    assert file.endswith("actor=nobody")
    assert (await desk.ask("GET", file)).json()["items"] == []
    assert (await desk.ask("GET", "/api/v1/audit?limit=1000")).json()["items"]


@pytest.mark.parametrize(
    ("page", "file", "shown"),
    [
        ("/users", "/api/v1/users", "operator-1"),
        ("/users", "/api/v1/sessions", "administrator-1"),
        ("/tokens", "/api/v1/tokens", "SCADA"),
        ("/account", "/api/v1/me/sessions", "administrator-1"),
    ],
)
async def test_users_sessions_and_tokens_are_taken_along_without_secrets(
    page: str, file: str, shown: str, office: Office
) -> None:
    wish = TokenWish("SCADA", frozenset({Scope.READ}), None, timedelta(days=1), "")
    text = await office.keeper.do(lambda: office.keeper.accounts.mint(HERE, wish, office.clock.now()))
    session = await office.session("administrator")
    async with office.browser(session) as browser:
        assert file in FILE.findall((await browser.get(page)).text)
        answer = await browser.get(file)
    assert shown in answer.text
    for secret in (PASSWORD, text, session):
        assert secret not in answer.text
    assert [name for name in names_in(answer.json()) if SECRETS.search(name)] == []


async def test_own_sessions_are_those_of_whoever_asks(office: Office) -> None:
    await office.session("administrator")
    async with office.browser(await office.session("operator")) as browser:
        own = (await browser.get("/api/v1/me/sessions")).json()["items"]
    assert {one["user"] for one in own} == {"operator-1"}


async def test_only_an_administrator_takes_users_along(office: Office) -> None:
    async with office.browser(await office.session("operator")) as browser:
        for file in ("users", "sessions", "tokens", "audit", "audit/access"):
            assert (await browser.get(f"/api/v1/{file}")).status_code == 403


SEEN = re.compile(r'<table\b|class="list-(?:rows|plain)\b|class="alarm-guide')
TAKEN = re.compile(r"json_key\(|csv_key\(|\bdownload\b|\.csv")
LEFT = {
    "_protection.html": "values of this moment; the trends have them as curves and as a file",
    "tracker.html": "values of this moment; the trends have them as curves and as a file",
    "components.html": "specimens of the parts that pages are made of",
    "machine.html": "fields of a form; the page Settings has all settings of a tracker as a file",
    "network.html": "where to go on while a new address is tried",
    "run.html": "the five steps; the commissioning record has them",
}
"""Tables and lists without a file of their own, and why."""


def test_every_list_and_table_can_be_taken_along_or_says_why_not() -> None:
    pages = {page.name: page.read_text() for page in TEMPLATES.glob("*.html")}
    shown = {name for name, text in pages.items() if SEEN.search(text)}
    taken = {name for name in shown if TAKEN.search(pages[name])}
    assert len(taken) > 20
    assert shown - taken == set(LEFT)


def test_every_key_that_keeps_a_list_leads_to_a_call() -> None:
    calls = {
        route.path
        for route in fake_app().routes
        if isinstance(route, APIRoute) and "GET" in (route.methods or ())
    }
    keys = [
        path.replace('" ~ frame.tracker_id ~ "', "{tracker_id}").split("?")[0]
        for page in TEMPLATES.glob("*.html")
        for path in KEY.findall(" ".join(page.read_text().split()))
    ]
    assert len(keys) > 10
    assert [path for path in keys if path not in calls] == []
