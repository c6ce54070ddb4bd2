"""The system's clock is set while the web process runs: by NTP after a start with a wrong time, or by hand.

Each row is one story: something is noted under a clock, the clock is set in the same life, some time passes,
and somebody asks. What is shown, stamped and compared is right; what guards something counts on.
"""

from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import cast

import httpx
import pytest

from app.access.roles import Role
from app.access.tokens import Scope
from app.base.clock import VirtualClock
from app.link.messages import SetClock
from app.store.store import StoreFailed
from app.web.features.operations import backups_api
from tests.golden.table import ClockRow, clocks
from tests.web.office import Office
from tests.web.test_clocks import NEW, NOON, WRONG_TRIES, life, rows, sign_in

CLOCK_PAGE = "/trackers/T1/commissioning/clock"


def set_clock(office: Office, row: ClockRow) -> None:
    """Set the system's clock to what the row asks for, and let its time pass."""
    clock = cast(VirtualClock, office.clock)
    clock.set_system(NOON + row.asked)
    clock.advance(row.later)


@rows("set_session")
async def test_a_session_counts_on_when_the_clock_is_set(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire()
        async with office.browser(await office.session(Role.ADMINISTRATOR)) as browser:
            set_clock(office, row)
            me, tokens = await browser.get("/api/v1/me"), await browser.post("/api/v1/users", json=NEW)
    found = "out" if me.status_code == 401 else "idle" if tokens.status_code == 403 else "in"
    assert found == row.expected


@rows("set_proof")
async def test_a_proof_counts_on_when_the_clock_is_set(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire()
        async with office.browser(await office.session(Role.ADMINISTRATOR)) as browser:
            set_clock(office, row)
            answer = await browser.post("/api/v1/users", json=NEW)
    assert {201: "proven", 403: "asked"}[answer.status_code] == row.expected


@rows("set_wait")
async def test_a_wait_counts_on_when_the_clock_is_set(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office, office.browser() as browser:
        await office.hire(Role.VIEWER)
        for _ in range(WRONG_TRIES):
            await sign_in(browser, "viewer-1", "wrong wrong wrong")
        set_clock(office, row)
        answer = await sign_in(browser, "viewer-1")
    assert {204: "in", 429: "waits"}[answer.status_code] == row.expected


@rows("set_token")
async def test_a_token_expires_by_the_clock_that_is_set(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office, office.browser() as browser:
        await office.hire()
        headers = await office.bearer(Scope.MOTION)
        set_clock(office, row)
        reads = await browser.get("/api/v1/site", headers=headers)
        stops = await browser.post("/api/v1/stop", headers=headers)
    found = {(200, 202): "valid", (401, 202): "stops", (401, 401): "unknown"}
    assert found[reads.status_code, stops.status_code] == row.expected


@rows("set_shown")
async def test_everything_shown_and_stamped_follows_the_clock(tmp_path: Path, row: ClockRow) -> None:
    async with life(tmp_path, row.stored) as office:
        await office.hire(Role.ENGINEER)
        async with office.browser(await office.session(Role.ADMINISTRATOR)) as browser:
            set_clock(office, row)
            right = NOON + row.asked + row.later
            office.machine.clock = VirtualClock(right)
            minted = await browser.post("/api/v1/tokens", json={"name": "scada", "scopes": ["read"]})
            assert minted.status_code == 201, minted.text
            tokens = (await browser.get("/api/v1/tokens")).json()["items"]
            events = (await browser.get("/api/v1/audit/access")).json()["items"]
            listed = [(await browser.get(f"/api/v1/{path}")).json() for path in ("sessions", "me/sessions")]
            me = (await browser.get("/api/v1/me")).json()
            pages = [(await browser.get(path)).text for path in ("/users", "/account")]
        async with office.browser(await office.session(Role.ENGINEER)) as browser:
            asked = await asked_of_the_clock(browser, right)
    stamps = [tokens[0]["created_at"], events[0]["at"], me["proven_at"]]
    sessions = [one for told in listed for one in told["items"]]
    stamps += [one[name] for one in sessions for name in ("began_at", "used_at")]
    assert {datetime.fromisoformat(one) for one in stamps} == {right}
    assert all(f"{right:%Y-%m-%d}" in page for page in pages)
    assert asked == {0: [303, 200], 70: [422, 422], -3600: [422, 422]}
    assert len([one for one in office.machine.orders if isinstance(one.command, SetClock)]) == 2


async def asked_of_the_clock(browser: httpx.AsyncClient, right: datetime) -> dict[int, list[int]]:
    """Ask the page and the API to keep the system's clock, from devices that are so many seconds ahead."""
    found = {}
    for ahead_s in (0, 70, -3600):
        at = (right + timedelta(seconds=ahead_s)).isoformat()
        page = await browser.post(CLOCK_PAGE, data={"source": "keep", "at": at})
        call = await browser.put("/api/v1/site/clock", json={"source": "system", "device_at": at})
        found[ahead_s] = [page.status_code, call.status_code]
        if ahead_s:
            side = "behind" if ahead_s > 0 else "ahead of"
            assert side in page.text
            assert side in call.json()["detail"]
    return found


async def test_a_backup_is_named_by_the_clock_that_is_set(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []
    row = clocks("set_shown")[-1]

    def backup(_: str, path: Path) -> None:
        made.append(path.name)
        raise StoreFailed("no more is needed")

    monkeypatch.setattr(backups_api, "backup", backup)
    async with life(tmp_path, row.stored) as office, office.browser() as browser:
        set_clock(office, row)
        await browser.post("/api/v1/backups")
    assert made[0].startswith(f"heliopanel-{NOON + row.asked:%Y%m%d-%H%M%S}-")


def test_what_is_older_than_the_clock_stays_as_it_was_stamped() -> None:
    clock = VirtualClock(NOON)
    clock.set_system(NOON + timedelta(days=60))
    before = NOON - timedelta(seconds=1)
    assert clock.system_time(before) == before
    assert clock.system_time(NOON) == datetime(2027, 1, 27, 12, tzinfo=UTC)
