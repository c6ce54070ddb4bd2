"""Signing in and what it is worth after a clock was ahead, at the entrances of the web process.

Each row is one story: something is noted under a clock, the process begins anew under another one, some time
passes, and somebody asks.
"""

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from app.access.tokens import Scope
from app.base.clock import VirtualClock
from tests.fault_result import BY_ITSELF, FaultResult
from tests.golden.table import ClockRow, clocks
from tests.web.office import PASSWORD, Office

NOON = datetime(2026, 11, 28, 12, tzinfo=UTC)
PIN = "270441"
NEW = {"name": "zoe", "password": PASSWORD, "roles": ["viewer"]}
WRONG_TRIES = 4


@asynccontextmanager
async def life(folder: Path, ahead: timedelta) -> AsyncIterator[Office]:
    """Give the web process in one of its lives; its clock stands until it is moved."""
    office = Office(folder, clock=VirtualClock(NOON + ahead))
    async with office.app.router.lifespan_context(office.app):
        yield office
    office.keeper.close()


@asynccontextmanager
async def asked(folder: Path, row: ClockRow) -> AsyncIterator[Office]:
    """Give the web process under the clock of a row, once its time has passed."""
    async with life(folder, row.asked) as office:
        clock = office.clock
        assert isinstance(clock, VirtualClock)
        clock.advance(row.later)
        yield office


def rows(guard: str) -> pytest.MarkDecorator:
    """Return the rows of one guard, each a test."""
    return pytest.mark.parametrize(
        "row", clocks(guard), ids=lambda row: f"{row.stored} {row.asked} {row.later}".replace(",", "")
    )


async def sign_in(browser: httpx.AsyncClient, name: str, password: str = PASSWORD) -> httpx.Response:
    return await browser.post("/api/v1/session", json={"name": name, "password": password})


@pytest.mark.fault(100)
@rows("sign_in")
async def test_nobody_waits_for_more_than_thirty_seconds(
    tmp_path: Path, row: ClockRow, fault: FaultResult
) -> None:
    async with life(tmp_path, row.stored) as office, office.browser() as browser:
        await office.hire(Role.VIEWER)
        for _ in range(WRONG_TRIES):
            assert (await sign_in(browser, "viewer-1", "wrong wrong wrong")).status_code in (401, 429)
    async with asked(tmp_path, row) as office, office.browser() as browser:
        answers = [await sign_in(browser, name) for name in ("viewer-1", "administrator-1")]
        answers.append(await browser.post("/login", data={"name": "viewer-1", "password": PASSWORD}))
        waits = [answer.status_code == 429 for answer in answers]
        assert waits == [row.expected == "waits"] * 3
        assert all(0 < int(answer.headers["retry-after"]) <= 30 for answer in answers if answer.is_error)
        fault.prevented("a failure that lies in the future adds no wait")
        fault.shows_nothing("with the right password the user signs in")
        fault.recovers(BY_ITSELF)
        office.clock.advance(timedelta(seconds=30))  # type: ignore[attr-defined]
        assert [(await sign_in(browser, name)).status_code for name in ("viewer-1", "administrator-1")] == [
            204,
            204,
        ]


@pytest.mark.fault(103)
@rows("session")
async def test_a_session_of_the_future_has_ended(tmp_path: Path, row: ClockRow, fault: FaultResult) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire(Role.OPERATOR)
        session = await office.session(Role.OPERATOR)
    async with asked(tmp_path, row) as office, office.browser(session) as browser:
        me, page = await browser.get("/api/v1/me"), await browser.get("/trackers/T1")
        assert {200: "in", 401: "out"}[me.status_code] == row.expected
        assert {200: "in", 303: "out"}[page.status_code] == row.expected
        if row.expected == "out":
            fault.prevented("what lies in the future has ended")
            fault.shows(me.json()["detail"])
            fault.recovers("the user signs in")


@rows("proof")
async def test_a_password_that_was_typed_in_the_future_is_asked_for_again(
    tmp_path: Path, row: ClockRow
) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire()
        session = await office.session(Role.ADMINISTRATOR)
    async with asked(tmp_path, row) as office, office.browser(session) as browser:
        answer = await browser.post("/api/v1/users", json=NEW)
        if answer.status_code == 201:
            assert row.expected == "proven"
        else:
            found = "out" if "Sign in" in answer.json()["detail"] else "asked"
            assert (answer.status_code, found) == (401 if found == "out" else 403, row.expected)


async def bound(office: Office) -> str:
    """Return the session of a cabinet's display."""
    return await office.keeper.log_in_kiosk(await office.mint(pin=PIN), "127.0.0.1", "panel")


@rows("step_up")
async def test_a_pin_that_was_typed_in_the_future_is_asked_for_again(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, timedelta(minutes=-1)) as office:
        await office.hire()
        session = await bound(office)
    async with life(tmp_path, row.stored) as office, office.browser(session) as browser:
        assert (await browser.post("/kiosk/pin", data={"pin": PIN})).status_code == 303
    async with asked(tmp_path, row) as office, office.browser(session) as browser:
        parked = (await browser.post("/trackers/T1/park")).status_code
        assert {303: "operates", 403: "views"}[parked] == row.expected


@rows("cabinet")
async def test_a_cabinet_bound_in_the_future_is_bound_again(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire()
        session = await bound(office)
    async with asked(tmp_path, row) as office, office.browser(session) as browser:
        me = await browser.get("/api/v1/me")
        assert {200: "in", 401: "out"}[me.status_code] == row.expected


@rows("token")
async def test_a_token_of_the_future_does_no_more_than_stop(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire()
        headers = await office.bearer(Scope.MOTION)
    async with asked(tmp_path, row) as office, office.browser() as browser:
        reads = await browser.get("/api/v1/site", headers=headers)
        parks = await browser.post("/api/v1/trackers/T1/commands", headers=headers, json={"type": "park"})
        stops = await browser.post("/api/v1/stop", headers=headers)
        answers = (reads.status_code, parks.status_code, stops.status_code)
        found = {(200, 202, 202): "valid", (401, 401, 202): "stops", (401, 401, 401): "unknown"}
        assert found[answers] == row.expected
        misdated = row.expected == "stops"
        assert ("dated in the future" in reads.text) == misdated
    async with (
        life(tmp_path, row.asked + row.later) as office,
        office.browser(await office.session(Role.ADMINISTRATOR)) as browser,
    ):
        assert ("dated in the future" in (await browser.get("/tokens")).text) == misdated


@rows("stop_ticket")
async def test_no_clock_keeps_an_open_page_from_stopping(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire(Role.VIEWER)
        async with office.browser(await office.session(Role.VIEWER)) as browser:
            page = (await browser.get("/trackers/T1")).text
    action = re.search(r'action="(/trackers/T1/stop\?stop_ticket=[^"]+)"', page)
    assert action is not None
    async with asked(tmp_path, row) as office, office.browser() as browser:
        await browser.post(action[1], headers={"hx-request": "true"})
        assert ("stops" if office.machine.orders else "out") == row.expected
        await browser.post(action[1].replace("/stop?", "/park?"))
        assert {order.command.kind for order in office.machine.orders} <= {"stop"}
