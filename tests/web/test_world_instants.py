"""Instants as the world brings them: taken as they are meant, or refused with a sentence, everywhere."""

import json
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import httpx
import pytest
from starlette.routing import BaseRoute

from app.base.addresses.sqlite_url import sqlite_url
from app.base.own import own_folder
from app.link.messages import SetClock
from app.store.engine import open_reader
from app.store.migrations import upgrade
from app.web.http.late_routes import LateRoute
from tests.amount import amount
from tests.fakes import FakeMachine, fake_app, serving
from tests.fault_result import FaultResult
from tests.golden.table import rows
from tests.web.filled import filled

ROWS = rows("world/instants.csv")
CLOCK = "/trackers/T1/commissioning/clock"
DAYS = ["0001-01-01", "1900-12-31", "2100-01-01", "9999-12-31"]
REFUSED = "Date: choose a day in the years 1901 to 2099."


@pytest.mark.fault(102)
@pytest.mark.parametrize("row", ROWS, ids=[row["text"] for row in ROWS])
async def test_an_instant_is_taken_or_refused_with_a_sentence(
    row: dict[str, str], client: httpx.AsyncClient, fault: FaultResult
) -> None:
    taken = row["taken"] == "yes"
    answer = await client.get("/api/v1/sun", params={"at": row["text"]})
    assert answer.status_code == (200 if taken else 422), answer.text
    if not taken:
        fault.shows(answer.json()["detail"])
        fault.recovers("with an instant of 1970 to 2099")


@pytest.mark.fault(102)
@pytest.mark.parametrize("row", [ROWS[0], ROWS[-1]], ids=lambda row: row["text"])
async def test_no_clock_is_set_to_an_instant_that_is_refused(
    row: dict[str, str], machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    taken = row["taken"] == "yes"
    machine.rest()
    asked = {"source": "manual", "at": row["text"], "confirmed": True}
    by_api = await client.put("/api/v1/site/clock", json=asked)
    device = {"source": "device", "at": row["text"], "confirmed": "yes"}
    by_device = await client.post(CLOCK, data=device)
    assert (by_api.status_code, by_device.status_code) == ((200, 303) if taken else (422, 422))
    orders = [order for order in machine.orders if isinstance(order.command, SetClock)]
    assert len(orders) == (2 if taken else 0)


@pytest.mark.parametrize(
    ("day", "zone"),
    [("1900-12-31", "Etc/GMT+12"), ("2100-01-01", "Pacific/Kiritimati"), ("2099-12-31", "UTC")],
)
async def test_a_typed_day_outside_the_years_of_the_sun_is_refused_at_its_field(
    day: str, zone: str, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    site = machine.latest()
    assert site is not None
    asked = {"asked_for": f"{day}T12:00:00+00:00", "asked_at": site.at.isoformat()}
    typed = {"date": day, "time": "12:00:00", "time_zone": zone, "confirmed": "yes"} | asked
    answer = await client.post(f"{CLOCK}/shadow", data=typed)
    assert answer.status_code == (303 if day == "2099-12-31" else 422), answer.text
    assert day == "2099-12-31" or REFUSED in answer.text


DOCUMENT = json.loads((own_folder("docs") / "openapi.json").read_bytes())
NEVER_ENDS = ("/api/v1/stream",)
NAMED = {"tracker_id": "T1", "step": "clock", "name": "home", "language": "en"}
NUMBERS = ["-1", "9223372036854775808", "-9223372036854775809", "99999999999999999999", "1e999"]


def address(path: str) -> str:
    return re.sub(r"\{(\w+)(?::\w+)?\}", lambda found: NAMED.get(found[1], "1"), path)


INSTANTS = [
    (method, address(path), one["name"])
    for path, calls in DOCUMENT["paths"].items()
    for method, call in calls.items()
    for one in call.get("parameters", ())
    if one["in"] == "query" and "date-time" in json.dumps(one["schema"])
]


@pytest.mark.parametrize("row", [ROWS[0], ROWS[-1]], ids=lambda row: row["text"])
async def test_no_call_takes_an_instant_that_is_refused_elsewhere(
    row: dict[str, str], client: httpx.AsyncClient
) -> None:
    assert len(INSTANTS) > 50
    for method, path, name in INSTANTS:
        answer = await client.request(method, path, params={name: row["text"]})
        wrong = answer.json().get("errors", ()) if answer.status_code == 422 else ()
        assert answer.status_code < 500, (method, path, name)
        assert (name in json.dumps(wrong)) == (row["taken"] == "no"), (method, path, name, answer.text)


def of_pages(routes: Iterable[BaseRoute], prefix: str = "") -> Iterator[tuple[str, set[str]]]:
    """Yield every address that is read, with the names of the fields that its query takes."""
    for route in routes:
        if isinstance(route, LateRoute):
            if "GET" in route.methods and prefix + route.path not in NEVER_ENDS:
                asked = [route.dependant]
                for one in asked:
                    asked.extend(one.dependencies)
                yield address(prefix + route.path), {name.alias for one in asked for name in one.query_params}
        elif inner := getattr(route, "original_router", None):
            yield from of_pages(inner.routes, prefix + getattr(route, "include_context").prefix)  # noqa: B009


async def test_no_field_of_any_address_ends_in_an_error_of_ours(tmp_path: Path) -> None:
    url = sqlite_url(tmp_path / "heliopanel.db")
    upgrade(url)
    app = fake_app(FakeMachine(), open_reader(url))  # type: ignore[arg-type]
    texts = ["9999-12-31T23:59:59-12:00", "9223372036854775808", *NUMBERS, *DAYS]
    texts += [row["text"] for row in ROWS if row["taken"] == "no"]
    async with serving(app) as client:
        tried = 0
        for path, names in of_pages(app.router.routes):
            for name in names:
                for text in texts[tried % 2 :][: amount(1, len(texts))]:
                    answer = await client.get(path, params={name: text})
                    assert answer.status_code < 500, (path, name, text)
                    tried += 1
    assert tried > 60


DATED = ("at", "start", "end", "issued_at", "measured_at", "begun_at", "device_at")
ENDS = ("0001-01-01T00:00:00+14:00", "9999-12-31T23:59:59-12:00")


def bodies() -> Iterator[tuple[str, str, dict[str, object]]]:
    """Yield every example of a body in the document, with method and address."""
    for path, calls in DOCUMENT["paths"].items():
        for method, call in calls.items():
            content = call.get("requestBody", {}).get("content", {}).get("application/json", {})
            for one in content.get("examples", {"": {"value": content.get("example")}}).values():
                if isinstance(one["value"], dict):
                    yield method, address(path), one["value"]


async def test_no_body_with_an_end_of_the_calendar_ends_in_an_error_of_ours(
    client: httpx.AsyncClient,
) -> None:
    wrong = [{name: ENDS[number % 2]} for number, name in enumerate(DATED)]
    wrong += [{"date": day} for day in (DAYS[0], DAYS[-1])]
    asked = [(method, path, body | one) for method, path, body in bodies() for one in wrong]
    assert len(asked) > 300
    for method, path, body in asked:
        answer = await client.request(method, path, json=body)
        assert answer.status_code < 500, (method, path, body, answer.text)
    for day in DAYS:
        form = await filled(client, "/simulate", {"tracker": "T1", "date": day})
        answer = await client.post("/simulate", data=form)
        assert (answer.status_code, REFUSED in answer.text) == (422, True), day
