"""Every number that a form asks for says below it from where to where it may lie, and means it."""

import re
from dataclasses import dataclass
from html.parser import HTMLParser

import httpx
import pytest

from tests.fakes import FakeMachine, fake_app, serving

T1 = "/trackers/T1"
PAGES = (
    "/",
    "/accuracy",
    "/network",
    "/simulate",
    "/site",
    "/studies",
    "/studies/program?date=2026-06-21",
    "/tokens",
    T1,
    f"{T1}/commissioning/location",
    f"{T1}/commissioning/mode/orientation",
    f"{T1}/drive",
    f"{T1}/machine",
    f"{T1}/mount",
    f"{T1}/protections",
    f"{T1}/settings",
    f"{T1}/show",
    f"{T1}/strategy",
)
MORE_PAGES = (
    "/site/horizon",
    "/site/notifications",
    "/users",
    f"{T1}/commissioning/clock",
    f"{T1}/record",
    f"{T1}/service",
)
"""They ask for words and choices only."""
NUMBERS = ("numeric", "decimal")
SPAN = re.compile(r"(-?\d[\d.]*\d|-?\d) to (\d[\d.]*\d|\d)\b")
NO_SPAN = ("latitude", "longitude", "pin")
"""An angle that is typed in degrees, minutes and seconds, with its own keys, and the digits of a PIN."""
BESIDE = {
    "port": {"drive": "modbus-tcp", "kind": "modbus-tcp", "host": "127.0.0.1"},
    "unit": {"drive": "modbus-tcp", "kind": "modbus-tcp", "host": "127.0.0.1"},
    "baud_rate": {"kind": "modbus-rtu", "serial_other": "/dev/ttyUSB0"},
    "first_": {"first_actuator": "own"},
    "second_": {"second_actuator": "own"},
    "counts": {"kind": "encoder-deadband"},
    "minutes": {"kind": "interval"},
}
"""What must be chosen for a number to be read at all."""
SETTINGS_PAGES = (
    "/network",
    "/site",
    "/site/horizon",
    "/site/notifications",
    f"{T1}/drive",
    f"{T1}/machine",
    f"{T1}/mount",
    f"{T1}/protections",
    f"{T1}/settings",
    f"{T1}/strategy",
)
DEFAULT = re.compile(r"\b(?:usual|empty)\b", re.IGNORECASE)
"""How a hint names what holds until somebody sets it: a usual value, or what an empty field stands for."""
NO_DEFAULT = {
    "reason": "words about this one time",
    "typed_id": "asked for again before a tracker is removed",
    "name": "a tracker is named when it is added, a person by who they are",
    "host": "a drive is where it was wired",
    "serial_port": "a drive is where it was wired",
    "serial_other": "a drive is where it was wired",
    "allowed_hosts": "names that a network gives",
    "region0_name": "a region is what stands in the way",
    "region0_corners": "a region is what stands in the way",
    "program_name": "belongs to the program beside it",
    "angles": "belongs to the program beside it",
    "base": "belongs to the program beside it",
    "table": "belongs to the program beside it",
    "example": "belongs to the program beside it",
}
"""Fields whose value nobody but the reader can know."""
MEASURED = re.compile(r"(?:first|second)_")
"""The measures of a machine's own actuator."""
TABLE = ("at", "first", "second")
"""The columns of a step program, whose heads say what they hold."""


@dataclass
class AskedField:
    """A field of a form: where the form is sent, what else it sends, and what stands below the field."""

    form: dict[str, str]
    action: str
    method: str
    name: str
    mode: str
    hint: str = ""


class Fields(HTMLParser):
    """Collects the fields that are typed into, each with the hint below it."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[AskedField] = []
        self.values: dict[str, str] = {}
        self.action = self.method = ""
        self.is_hint = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if tag == "form":
            self.values, self.action, self.method = {}, given.get("action", ""), given.get("method", "get")
        elif tag == "p":
            self.is_hint = "hint" in given.get("class", "").split()
        elif tag in ("input", "select", "textarea") and given.get("name"):
            self._take(tag, given)
        elif tag == "option" and "selected" in given and self.found:
            self.values[self.found[-1].name] = given.get("value", "")

    def _take(self, tag: str, given: dict[str, str]) -> None:
        name = given["name"]
        if given.get("type") in ("checkbox", "radio") and "checked" not in given:
            return
        self.values.setdefault(name, given.get("value", ""))
        is_typed = tag == "select" or given.get("type", "text") == "text"
        if is_typed:
            mode = given.get("inputmode", "") if tag == "input" else tag
            self.found.append(AskedField(self.values, self.action, self.method, name, mode))

    def handle_endtag(self, tag: str) -> None:
        self.is_hint = self.is_hint and tag != "p"

    def handle_data(self, data: str) -> None:
        if self.is_hint and self.found:
            self.found[-1].hint += data


async def fields_of(client: httpx.AsyncClient, page: str) -> list[AskedField]:
    reading = Fields()
    answer = await client.get(page)
    assert answer.status_code == 200, page
    reading.feed(answer.text)
    return [one for one in reading.found if one.name not in TABLE]


@pytest.mark.parametrize("page", PAGES)
async def test_every_number_says_its_range(page: str, client: httpx.AsyncClient) -> None:
    numbers = [
        one for one in await fields_of(client, page) if one.mode in NUMBERS and one.name not in NO_SPAN
    ]
    assert [one.name for one in numbers if not SPAN.search(one.hint)] == []


@pytest.mark.parametrize("page", [*PAGES, *MORE_PAGES])
async def test_every_field_says_what_it_is_for(page: str, client: httpx.AsyncClient) -> None:
    fields = await fields_of(client, page)
    assert fields
    assert [one.name for one in fields if not one.hint.strip()] == []


@pytest.mark.parametrize("page", SETTINGS_PAGES)
async def test_every_setting_says_its_default(page: str, client: httpx.AsyncClient) -> None:
    asked = [one for one in await fields_of(client, page) if not MEASURED.match(one.name)]
    silent = [one.name for one in asked if not DEFAULT.search(one.hint) and one.name not in NO_DEFAULT]
    assert silent == []


@pytest.mark.parametrize("page", [page for page in SETTINGS_PAGES if not page.endswith(("network", "drive"))])
async def test_every_settings_page_can_undo_its_last_saving(page: str, client: httpx.AsyncClient) -> None:
    """A drive's page has its own key once it was changed, the network's a trial that ends by itself."""
    way = f"{T1}/settings/undo" if page.startswith(T1) else "/site/undo"
    assert f'action="{way}"' in (await client.get(page)).text


async def test_an_undo_leads_back_to_the_page_where_it_was_pressed(client: httpx.AsyncClient) -> None:
    for back, to in ((f"{T1}/mount", f"{T1}/mount"), ("/", f"{T1}/settings"), ("", f"{T1}/settings")):
        answer = await client.post(f"{T1}/settings/undo", data={"back": back})
        assert (answer.status_code, answer.headers["location"]) == (303, to)


@pytest.mark.parametrize("page", PAGES)
async def test_a_range_is_the_one_that_is_kept(page: str, machine: FakeMachine) -> None:
    async with serving(fake_app(machine)) as client:
        for one in await fields_of(client, page):
            span = SPAN.search(one.hint)
            if one.mode not in NUMBERS or one.name in NO_SPAN or span is None:
                continue
            beside = next((more for start, more in BESIDE.items() if one.name.startswith(start)), {})
            answer = await send(client, one, {**one.form, **beside, one.name: "-999999999"})
            assert f"between {span[1]} and {span[2]}" in answer.text, (one.name, one.hint, answer.text[:300])


async def send(client: httpx.AsyncClient, one: AskedField, values: dict[str, str]) -> httpx.Response:
    if one.method == "get":
        return await client.get(one.action.split("?")[0], params=values)
    return await client.post(one.action, data=values)
