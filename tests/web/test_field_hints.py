"""Every number that a form asks for says below it from where to where it may lie, and means it."""

import re
from dataclasses import dataclass

import httpx
import pytest

from tests.web.filled import value_of
from tests.web.tree import Tag, tree

T1 = "/trackers/T1"
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
PAGES = (
    *SETTINGS_PAGES,
    "/",
    "/accuracy",
    "/simulate",
    "/studies",
    "/studies/program?date=2026-06-21",
    "/tokens",
    "/users",
    T1,
    f"{T1}/commissioning/clock/shadow",
    f"{T1}/commissioning/location",
    f"{T1}/commissioning/mode/orientation",
    f"{T1}/record",
    f"{T1}/service",
    f"{T1}/show",
)
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
    """A field of a form: the form, what else it sends, and what stands below the field."""

    form: Tag
    values: dict[str, str]
    name: str
    mode: str
    hint: str = ""


def asked_fields(page: str) -> list[AskedField]:
    """Return the fields that are typed into, each with the hints that follow it."""
    found: list[AskedField] = []
    form, values = Tag("", {}), dict[str, str]()
    for one in tree(page).all:
        if one.name == "form":
            form, values = one, {}
        elif one.name == "p" and one.is_a("hint") and found:
            found[-1].hint += " ".join([one.text, *(inner.text for inner in one.all)])
        elif (value := value_of(one)) is not None:
            name = one.given["name"]
            values.setdefault(name, value)
            if one.name == "select" or one.given.get("type", "text") == "text":
                mode = one.given.get("inputmode", "") if one.name == "input" else one.name
                found.append(AskedField(form, values, name, mode))
    return found


async def fields_of(client: httpx.AsyncClient, page: str) -> list[AskedField]:
    answer = await client.get(page)
    assert answer.status_code == 200, page
    return [one for one in asked_fields(answer.text) if one.name not in TABLE]


@pytest.mark.parametrize("page", PAGES)
async def test_every_field_says_what_it_is_for_its_range_and_its_default(
    page: str, client: httpx.AsyncClient
) -> None:
    fields = await fields_of(client, page)
    assert fields
    assert [one.name for one in fields if not one.hint.strip()] == []
    numbers = [one for one in fields if one.mode in NUMBERS and one.name not in NO_SPAN]
    assert [one.name for one in numbers if not SPAN.search(one.hint)] == [], "no range"
    if page in SETTINGS_PAGES:
        asked = [one for one in fields if not MEASURED.match(one.name) and one.name not in NO_DEFAULT]
        assert [one.name for one in asked if not DEFAULT.search(one.hint)] == [], "no default"


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
async def test_a_range_is_the_one_that_is_kept(page: str, client: httpx.AsyncClient) -> None:
    for one in await fields_of(client, page):
        span = SPAN.search(one.hint)
        if one.mode not in NUMBERS or one.name in NO_SPAN or span is None:
            continue
        beside = next((more for start, more in BESIDE.items() if one.name.startswith(start)), {})
        answer = await send(client, one, {**one.values, **beside, one.name: "-999999999"})
        assert f"between {span[1]} and {span[2]}" in answer.text, (one.name, one.hint, answer.text[:300])


async def send(client: httpx.AsyncClient, one: AskedField, values: dict[str, str]) -> httpx.Response:
    action = one.form.given.get("action", "")
    if one.form.given.get("method", "get") == "get":
        return await client.get(action.split("?")[0], params=values)
    return await client.post(action, data=values)
