"""What ended in a 500: the ends of the calendar, a PIN where there is none; a 500 says that it hangs up."""

import asyncio
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.access.roles import Role
from tests.fakes import FakeMachine, fake_app, serving
from tests.fault_result import FaultResult
from tests.patience import PATIENCE_S
from tests.web.office import Office

DAYS = ["0001-01-01", "1900-12-31", "2100-01-01", "9999-12-31"]
INSTANTS = [
    "0001-01-01T00:00:00+14:00",
    "1969-12-31T23:59:59Z",
    "2100-01-01T00:00:00Z",
    "2206-06-01T00:00:00Z",
    "9999-12-31T23:59:59-12:00",
]
T1 = "/api/v1/trackers/T1"


@pytest.mark.fault(96)
@pytest.mark.parametrize("day", DAYS)
@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("GET", "/api/v1/sun/day?step_s=3600&date={day}", None),
        ("POST", f"{T1}/shows", {"date": "{day}", "duration_s": 600}),
        ("POST", "/api/v1/simulations", {"tracker_id": "T1", "date": "{day}"}),
    ],
)
async def test_a_day_outside_the_years_of_the_sun_is_refused_with_a_sentence(
    client: httpx.AsyncClient,
    day: str,
    method: str,
    path: str,
    body: dict[str, Any] | None,
    fault: FaultResult,
) -> None:
    given = None if body is None else body | {"date": day}
    answer = await client.request(method, path.format(day=day), json=given)
    assert answer.status_code == 422
    assert (
        answer.json()["detail"] == f"Sun positions are available for the years 1901 to 2099, not for {day}."
    )
    fault.prevented("refused before it is used")
    fault.shows(answer.json()["detail"])
    fault.recovers("with values within their range")


@pytest.mark.fault(102)
@pytest.mark.parametrize("at", INSTANTS)
@pytest.mark.parametrize(
    "path",
    [
        "/api/v1/sun?at={at}",
        "/api/v1/journal?start={at}",
        "/api/v1/telemetry?tracker_id=T1&start={at}&end={at}",
    ],
)
async def test_an_instant_at_the_ends_of_the_calendar_is_refused(
    client: httpx.AsyncClient, at: str, path: str
) -> None:
    answer = await client.get(path.format(at=at.replace("+", "%2B")))
    assert answer.status_code == 422
    assert "Enter a year from 1970 to 2099." in answer.text


@pytest.mark.fault(96)
@pytest.mark.parametrize("role", list(Role))
async def test_a_pin_is_of_a_cabinets_page_alone(tmp_path: Path, role: Role) -> None:
    office = Office(tmp_path)
    await office.hire(role)
    async with office.browser(await office.session(role)) as browser:
        answer = await browser.post("/kiosk/pin", data={"pin": "1234"})
    assert 400 <= answer.status_code < 500 or answer.status_code == 303


async def test_a_mistake_of_the_panel_says_that_it_hangs_up(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The server ends the connection after it; a client that was not told lost its next request."""

    async def broken() -> None:
        raise RuntimeError

    monkeypatch.setattr(machine, "detail", broken)
    app = fake_app(machine)
    async with serving(app):
        transport = httpx.ASGITransport(app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1:8010") as browser:
            answer = await asyncio.wait_for(browser.get("/api/v1/site/notifications"), PATIENCE_S)
    assert answer.status_code == 500
    assert answer.headers["connection"] == "close"
