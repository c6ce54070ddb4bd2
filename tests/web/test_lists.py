"""Every list can be taken along as a file: its key leads to what the page shows, and to no secret."""

import re
from html import unescape
from pathlib import Path
from typing import Any

from fastapi.routing import APIRoute

from app.access.tokens import Scope
from tests.fakes import fake_app
from tests.web.desk import Desk
from tests.web.office import PASSWORD, Office

FILE = re.compile(r'href="(/api/[^"]+)" download="[^"]+\.json"')
KEY = re.compile(r'json_key\("(/api/[^,]+?)"(?:,| ~ \()')
TEMPLATES = Path(__file__).resolve().parents[2] / "templates"
SIGNED = {
    "signatures": [{"role": "technician", "name": "Ayşe Yılmaz", "strokes": [[[10, 20], [400, 250]]]}],
    "confirmed": True,
}
SECRETS = re.compile(r"password|hash|secret|pin", re.IGNORECASE)


def names_in(value: Any) -> set[str]:
    """Return every name that JSON gives to a value, however deep."""
    match value:
        case dict():
            return set(value) | {name for inner in value.values() for name in names_in(inner)}
        case list():
            return {name for inner in value for name in names_in(inner)}
        case _:
            return set()


PAGES = {
    "/": "trackers",
    "/recordings": "recordings?limit=1000",
    "/records": "records?limit=1000",
    "/alarms": "alarms",
    "/alarms?view=history": "alarms/history?limit=1000",
    "/audit": "audit?limit=1000",
    "/audit/access": "audit/access?limit=1000",
    "/alarms/guide": "alarms/catalogue",
    "/restore": "backups",
    "/site/horizon": "site/horizon",
    "/records/compare?pick=1&pick=2": "records/comparison?first=1&second=2",
    "/trackers/T1/settings": "trackers/T1",
    "/trackers/T1/drive-tests": "trackers/T1/drive-tests",
    "/trackers/T1/drive": "trackers/T1/drive/choices",
}


async def test_a_list_is_taken_along_as_a_file(desk: Desk) -> None:
    await fill(desk)
    for page, file in PAGES.items():
        shown = await desk.ask("GET", page)
        assert f"/api/v1/{file}" in [unescape(one) for one in FILE.findall(shown.text)], page
        answer = await desk.ask("GET", f"/api/v1/{file}")
        assert (answer.status_code, answer.headers["content-type"]) == (200, "application/json"), file
    whose = unescape((await desk.ask("GET", "/audit?actor=nobody")).text)
    (file,) = FILE.findall(whose)
    assert file.endswith("actor=nobody"), "what one person ordered is taken along alone"
    assert (await desk.ask("GET", file)).json()["items"] == []


async def fill(desk: Desk) -> None:
    """Have something stand in every list: two records, a backup, a horizon."""
    for path, told in (("trackers/T1/records", SIGNED), ("trackers/T1/records", SIGNED), ("backups", None)):
        assert (await desk.ask("POST", f"/api/v1/{path}", json=told)).is_success, path
        await desk.forward(1)
    skyline = {"points": [{"azimuth_deg": 135, "elevation_deg": 8}]}
    assert (await desk.ask("PUT", "/api/v1/site/horizon", json=skyline)).is_success


async def test_users_sessions_and_tokens_are_taken_along_without_secrets(office: Office) -> None:
    text = await office.mint(Scope.READ, name="SCADA")
    session, other = await office.session("administrator"), await office.session("operator")
    async with office.browser(session) as browser:
        for page, file, shown in (
            ("/users", "/api/v1/users", "operator-1"),
            ("/users", "/api/v1/sessions", "administrator-1"),
            ("/tokens", "/api/v1/tokens", "SCADA"),
            ("/account", "/api/v1/me/sessions", "administrator-1"),
        ):
            assert file in FILE.findall((await browser.get(page)).text)
            answer = await browser.get(file)
            assert shown in answer.text
            assert not [secret for secret in (PASSWORD, text, session, other) if secret in answer.text]
            assert [name for name in names_in(answer.json()) if SECRETS.search(name)] == []
    async with office.browser(other) as browser:
        own = (await browser.get("/api/v1/me/sessions")).json()["items"]
    assert {one["user"] for one in own} == {"operator-1"}, "own sessions are those of whoever asks"


SEEN = re.compile(r'<table\b|class="list-(?:rows|plain)\b|class="alarm-guide')
TAKEN = re.compile(r"json_key\(|csv_key\(|\bdownload\b|\.csv")
LEFT = {
    "_protection.html": "values of this moment; the trends have them as curves and as a file",
    "tracker.html": "values of this moment; the trends have them as curves and as a file",
    "location.html": "where the sun is at this moment, beside what was entered",
    "components.html": "specimens of the parts that pages are made of",
    "_review.html": "what a form would change, asked before it is saved",
    "machine.html": "fields of a form; the page Settings has all settings of a tracker as a file",
    "network.html": "where to go on while a new address is tried",
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
