"""Every list can be taken along as a file: its key leads to what the page shows, and to no secret."""

import re
from collections.abc import AsyncIterator
from datetime import timedelta
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
SIGNED = {"signatures": [{"role": "technician", "name": "Ayşe Yılmaz", "strokes": [[[10, 20], [400, 250]]]}]}
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
    ],
)
async def test_a_list_is_taken_along_as_a_file(page: str, file: str, desk: Desk) -> None:
    assert (await desk.ask("POST", "/api/v1/trackers/T1/records", json=SIGNED)).status_code == 201
    shown = await desk.ask("GET", page)
    assert file in FILE.findall(shown.text)
    answer = await desk.ask("GET", file)
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "application/json"


async def test_what_one_person_ordered_is_taken_along_alone(desk: Desk) -> None:
    assert (await desk.ask("POST", "/api/v1/trackers/T1/records", json=SIGNED)).status_code == 201
    shown = await desk.ask("GET", "/audit?actor=nobody")
    (file,) = FILE.findall(shown.text.replace("&amp;", "&"))
    assert file.endswith("actor=nobody")
    assert (await desk.ask("GET", file)).json()["entries"] == []
    assert (await desk.ask("GET", "/api/v1/audit?limit=1000")).json()["entries"]


@pytest.mark.parametrize(
    ("page", "file", "shown"),
    [
        ("/users", "/api/v1/users", "operator-1"),
        ("/users", "/api/v1/sessions", "administrator-1"),
        ("/tokens", "/api/v1/tokens", "SCADA"),
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


async def test_only_an_administrator_takes_users_along(office: Office) -> None:
    async with office.browser(await office.session("operator")) as browser:
        for file in ("users", "sessions", "tokens", "audit", "audit/access"):
            assert (await browser.get(f"/api/v1/{file}")).status_code == 403


def test_every_key_that_keeps_a_list_leads_to_a_call() -> None:
    calls = {
        route.path
        for route in fake_app().routes
        if isinstance(route, APIRoute) and "GET" in (route.methods or ())
    }
    keys = [
        path.replace('" ~ frame.tracker_id ~ "', "{tracker_id}").split("?")[0]
        for page in TEMPLATES.glob("*.html")
        for path in KEY.findall(page.read_text())
    ]
    assert len(keys) > 10
    assert [path for path in keys if path not in calls] == []
