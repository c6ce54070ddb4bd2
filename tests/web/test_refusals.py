"""Whoever is turned away at the door is in the record of access, and a flood of them does not fill it."""

from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

from app.access.roles import Role
from app.access.tokens import Scope
from app.base.clock import Clock
from tests.web.office import HERE, Office
from tests.web.test_gate import made


async def recorded(office: Office, is_there: Callable[[dict[str, str]], bool]) -> dict[str, str]:
    """Return the newest event that is so, once it is written."""
    clock: Clock = office.clock
    session = await office.session(Role.ADMINISTRATOR)
    async with office.browser(session) as browser:
        for _ in range(60):
            entries = (await browser.get("/api/v1/audit/access")).json()["items"]
            if found := [one for one in entries if is_there(one)]:
                page = (await browser.get("/audit/access")).text
                assert found[0]["object"] in page
                return dict(found[0])
            await clock.sleep_until(clock.now() + timedelta(milliseconds=50))
    raise AssertionError("It was not recorded.")


async def test_a_role_that_may_not_is_recorded(office: Office) -> None:
    async with office.browser(await office.session(Role.VIEWER)) as browser:
        for _ in range(5):
            assert (await browser.post("/trackers/T1/park")).status_code == 403
    event = await recorded(office, lambda one: one["action"] == "refused")
    assert (event["actor"], event["via"], event["object"]) == (
        "viewer-1",
        "session",
        "POST /trackers/T1/park",
    )
    assert "may not move trackers" in event["result"]


async def test_a_revoked_token_is_recorded_by_its_id_and_never_in_full(office: Office) -> None:
    token = await made(office, Scope.READ)
    now = office.clock.now()
    await office.keeper.do(lambda: office.keeper.accounts.revoke(HERE, token[3:11], now))
    async with office.browser() as browser:
        headers = {"authorization": f"Bearer {token}"}
        assert (await browser.get("/api/v1/site", headers=headers)).status_code == 401
        other = {"authorization": "Bearer a-secret-of-something-else"}
        assert (await browser.get("/api/v1/trackers", headers=other)).status_code == 401
    event = await recorded(office, lambda one: one["object"] == "GET /api/v1/site")
    assert (event["action"], token[3:11] in event["result"]) == ("refused_token", True)
    assert token[11:] not in event["result"]
    other_event = await recorded(office, lambda one: one["object"] == "GET /api/v1/trackers")
    assert "secret" not in other_event["result"]


async def test_a_foreign_page_is_recorded(office: Office) -> None:
    async with office.browser(await office.session(Role.OPERATOR)) as browser:
        answer = await browser.post("/trackers/T1/park", headers={"origin": "http://elsewhere.example"})
        assert answer.status_code == 403
    event = await recorded(office, lambda one: one["action"] == "refused_foreign")
    assert "http://elsewhere.example" in event["result"]
    assert event["address"] == "127.0.0.1"


async def test_a_panel_that_is_not_set_up_tells_programs_so(tmp_path: Path) -> None:
    office = Office(tmp_path, host="0.0.0.0")
    async with office.app.router.lifespan_context(office.app), office.browser() as browser:
        for path in ("/api/v1/site", "/metrics", "/api/v1/nothing"):
            answer = await browser.get(path)
            assert answer.status_code == 503, path
            assert answer.headers["content-type"] == "application/problem+json"
            assert "heliopanel users add NAME" in answer.json()["detail"]
        stop = await browser.post("/api/v1/stop")
        assert stop.status_code == 503
        assert (await browser.get("/health")).status_code == 200
        page = await browser.get("/trackers/T1")
        assert (page.status_code, page.headers["location"]) == (303, "/setup")
