"""Limits, speeds and the drive want the password again where a session sets them by a form or the API."""

from collections.abc import AsyncIterator
from datetime import timedelta

import httpx
import pytest

from app.access.roles import Role
from tests.web.office import PASSWORD, Office
from tests.web.test_limit_review import API, FIELDS, HTMX, PAGE

WIDER = {"azimuth": {"maximum_deg": 400}}


@pytest.fixture
async def browser(office: Office) -> AsyncIterator[httpx.AsyncClient]:
    """Give a browser whose engineer typed the password six minutes ago."""
    session = await office.session(Role.ENGINEER)
    office.clock.ahead = timedelta(minutes=6)
    async with office.browser(session) as browser:
        browser.headers["x-csrf-token"] = office.keeper.csrf(session)
        yield browser


def sent(office: Office) -> list[str]:
    return [order.command.kind for order in office.machine.orders]


@pytest.mark.fault(24)
@pytest.mark.parametrize(
    "change", [{"azimuth_maximum_deg": "350"}, {"elevation_speed_dps": "3"}, {"host": "10.0.0.7"}]
)
async def test_the_form_asks_for_the_password_and_keeps_what_was_typed(
    office: Office, browser: httpx.AsyncClient, change: dict[str, str]
) -> None:
    asked = await browser.post(PAGE, data=FIELDS | change, headers=HTMX)
    assert asked.status_code == 403
    assert "they were not saved" in asked.text
    assert 'href="/prove" target="_blank"' in asked.text, "the page with what was typed stays"
    assert sent(office) == []
    await browser.post("/prove", data={"password": PASSWORD})
    assert (await browser.post(PAGE, data=FIELDS | change, headers=HTMX)).status_code == 200
    assert sent(office) == ["configure_tracker"]


@pytest.mark.fault(24)
async def test_more_room_is_reviewed_only_after_the_password(
    office: Office, browser: httpx.AsyncClient
) -> None:
    typed = FIELDS | {"azimuth_maximum_deg": "400"}
    assert (await browser.post(PAGE, data=typed, headers=HTMX)).status_code == 403
    await browser.post("/prove", data={"password": PASSWORD})
    assert "Nothing is saved yet" in (await browser.post(PAGE, data=typed, headers=HTMX)).text
    assert sent(office) == []


async def test_a_name_and_what_is_of_no_weight_need_no_password(
    office: Office, browser: httpx.AsyncClient
) -> None:
    typed = FIELDS | {"name": "East 1", "deadband_deg": "1"}
    assert (await browser.post(PAGE, data=typed, headers=HTMX)).status_code == 200
    assert (await browser.patch(API, json={"name": "East 2"})).status_code == 200
    assert sent(office) == ["configure_tracker", "configure_tracker"]


@pytest.mark.fault(24)
async def test_the_api_asks_a_session_too_and_undo_and_another_mount_do(
    office: Office, browser: httpx.AsyncClient
) -> None:
    refused = await browser.patch(API, json=WIDER)
    assert refused.status_code == 403
    assert refused.json()["reasons"][0]["code"] == "reauthentication_required"
    assert (await browser.post(f"{API}/settings/undo")).status_code == 403
    assert (await browser.post(f"{PAGE}/undo")).headers["location"].startswith("/prove")
    kind = await browser.post("/trackers/T1/mount/kind", data={"kind": "horizontal-single-axis"})
    assert kind.headers["location"].startswith("/prove")
    assert sent(office) == []
    await browser.post("/prove", data={"password": PASSWORD})
    assert (await browser.patch(API, json=WIDER)).status_code == 200
