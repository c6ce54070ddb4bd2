"""Who gets through, told in stories; `test_gate_table.py` walks every route."""

import re
from collections.abc import AsyncIterator
from datetime import timedelta
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts

from app.access.accounts import TokenWish
from app.access.roles import Role
from app.access.tokens import Scope
from app.web.http import manual
from app.web.http.routes import RouteUnguarded, guarded_routes, walk
from tests.web.office import HERE, PASSWORD, PORT, Office
from tests.web.route_table import ROUTES
from tests.web.sockets import connected


@pytest.fixture
async def office(tmp_path: Path) -> AsyncIterator[Office]:
    office = Office(tmp_path)
    async with office.app.router.lifespan_context(office.app):
        await office.hire(*Role)
        yield office


def is_turned_away(answer: httpx.Response) -> bool:
    """Return whether the gate said no, in one of its ways."""
    to = answer.headers.get("location", "") + answer.headers.get("hx-redirect", "")
    return answer.status_code in (401, 403) or to.startswith(("/login", "/prove"))


def test_every_route_says_what_it_needs(tmp_path: Path) -> None:
    app = Office(tmp_path).app
    told = {
        f"{method} {route.path}"
        for route in iter_route_contexts(app.routes)
        if route.path != "/s"
        for method in route.methods or ({"GET"} if route.path == manual.PATH else {"WS"})
        if method != "HEAD"
    }
    walked = {f"{method} {one.path}" for one in walk(app.routes) for method in one.methods}
    assert walked - {"GET /s"} == told
    assert told == set(ROUTES)


async def test_a_notice_of_use_stands_before_the_log_in_and_nowhere_else(tmp_path: Path) -> None:
    office = Office(tmp_path, notice="For <staff> alone.\nUse is recorded.")
    async with office.app.router.lifespan_context(office.app):
        await office.hire(Role.VIEWER)
        async with office.browser() as stranger:
            assert "For &lt;staff&gt; alone.\nUse is recorded." in (await stranger.get("/login")).text
            assert "alone." in (await stranger.get("/kiosk")).text
        async with office.browser(await office.session("viewer")) as viewer:
            assert "alone." not in (await viewer.get("/prove")).text


async def test_a_live_page_of_a_panel_without_an_administrator_is_closed(tmp_path: Path) -> None:
    office = Office(tmp_path, host="0.0.0.0")
    async with office.app.router.lifespan_context(office.app), connected(office.app) as page:
        await page.ended.wait()
    assert page.closed == 1008


async def test_without_a_notice_the_log_in_has_none(office: Office) -> None:
    async with office.browser() as stranger:
        found = await stranger.get("/login")
    assert found.status_code == 200
    assert "sign-in-notice" not in found.text


async def test_whoever_made_the_first_administrator_is_told_so_before_the_log_in(tmp_path: Path) -> None:
    office = Office(tmp_path)
    told = "The administrator zoe was created. Sign in."
    new = {"name": "Zoe", "password": PASSWORD, "role": "administrator"}
    async with (
        office.app.router.lifespan_context(office.app),
        office.browser() as browser,
        office.browser() as other,
    ):
        answer = await browser.post("/users", data=new)
        assert answer.headers["location"] == "/login"
        page = (await browser.get("/login")).text
        assert told in page
        assert "The STOP button appears here after you sign in." in page
        assert 'id="stop-key"' not in page
        assert "was created" not in (await other.get("/login")).text
        await browser.post("/login", data={"name": "zoe", "password": PASSWORD})
        assert "was created" not in (await browser.get("/login")).text
        assert "STOP is not an emergency stop." in (await browser.get("/")).text


def test_a_route_without_an_entry_keeps_the_panel_from_starting(tmp_path: Path) -> None:
    app: FastAPI = Office(tmp_path).app

    @app.post("/api/v1/open-to-all")
    def open_to_all() -> None:
        """Without its need."""

    with pytest.raises(RouteUnguarded, match="POST /api/v1/open-to-all"):
        guarded_routes(app.routes)


async def made(office: Office, *scopes: Scope, trackers: frozenset[str] | None = None) -> str:
    """Return a new token."""
    wish, now = TokenWish("scada", frozenset(scopes), trackers), office.clock.now()
    return await office.keeper.do(lambda: office.keeper.accounts.mint(HERE, wish, now))


async def test_a_token_for_one_tracker_does_not_reach_another(office: Office) -> None:
    headers = {"authorization": f"Bearer {await made(office, Scope.MOTION, trackers=frozenset({'T1'}))}"}
    async with office.browser() as browser:
        assert (await browser.get("/api/v1/trackers/T1/snapshot", headers=headers)).status_code == 200
        refused = await browser.get("/api/v1/trackers/T2/snapshot", headers=headers)
    assert refused.status_code == 403
    assert "T2" in refused.json()["detail"]


@pytest.mark.parametrize(
    "query", ["tracker_id=T2", "tracker=T2", "tracker_id=T1&tracker_id=T2", "tracker=T1&tracker_id=T2"]
)
async def test_a_token_for_one_tracker_reaches_no_other_by_the_fields_of_an_address(
    office: Office, query: str
) -> None:
    headers = {"authorization": f"Bearer {await made(office, Scope.READ, trackers=frozenset({'T1'}))}"}
    async with office.browser() as browser:
        assert (await browser.get("/api/v1/journal?tracker_id=T1", headers=headers)).status_code == 200
        assert (await browser.get(f"/api/v1/journal?{query}", headers=headers)).status_code == 403


async def test_foreign_pages_and_old_pages_change_nothing(office: Office) -> None:
    session = await office.session(Role.OPERATOR)
    csrf = office.keeper.csrf(session)
    async with office.browser(session) as browser:
        for headers in (
            {"origin": "http://elsewhere.example"},
            {"hx-request": "true"},
            {"x-csrf-token": "x"},
        ):
            assert (await browser.post("/trackers/T1/park", headers=headers)).status_code == 403, headers
        browser.headers.pop("origin")
        browser.headers.pop("sec-fetch-site")
        assert (await browser.post("/trackers/T1/park")).status_code == 403
        assert office.machine.orders == []
        right = {"x-csrf-token": csrf, "hx-request": "true"}
        assert (await browser.post("/trackers/T1/park", headers=right)).status_code == 200
    assert [order.actor for order in office.machine.orders] == ["operator-1"]


async def test_a_resting_session_views_and_stops_and_moves_after_the_password(office: Office) -> None:
    session = await office.session(Role.OPERATOR)
    office.clock.ahead = timedelta(minutes=31)
    async with office.browser(session) as browser:
        assert (await browser.get("/trackers/T1")).status_code == 200
        assert (await browser.post("/trackers/T1/stop")).status_code == 303
        asked = await browser.post("/trackers/T1/park")
        assert asked.headers["location"].startswith("/prove")
        assert (await browser.post("/prove", data={"password": "wrong wrong wrong"})).status_code == 401
        await browser.post("/prove", data={"password": "violet-anvil-harbour-9"})
        assert (await browser.post("/trackers/T1/park")).status_code == 303
    assert [order.command.kind for order in office.machine.orders] == ["stop", "park"]


async def test_what_is_of_weight_wants_a_fresh_password(office: Office) -> None:
    session = await office.session(Role.ADMINISTRATOR)
    office.clock.ahead = timedelta(minutes=6)
    new = {"name": "zoe", "password": "violet-anvil-harbour-9", "role": "viewer"}
    async with office.browser(session) as browser:
        asked = await browser.post("/users", data=new)
        assert asked.headers["location"].startswith("/prove")
        assert "zoe" not in office.keeper.book.users
        await browser.post("/prove", data={"password": "violet-anvil-harbour-9"})
        assert (await browser.post("/users", data=new)).status_code == 200
    assert "zoe" in office.keeper.book.users


async def test_a_page_whose_session_ended_still_stops_and_does_nothing_else(office: Office) -> None:
    session = await office.session(Role.VIEWER)
    async with office.browser(session) as browser:
        page = (await browser.get("/trackers/T1")).text
        action = re.search(r'action="(/trackers/T1/stop\?stop_ticket=[^"]+)"', page)
        assert action is not None
        await browser.post("/logout")
    async with office.browser() as later:
        assert (await later.post(action[1], headers={"hx-request": "true"})).status_code == 200
        other = action[1].replace("/stop?", "/park?")
        assert is_turned_away(await later.post(other))
        many = [(await later.post(action[1])).status_code for _ in range(12)]
    assert many.count(429) >= 2
    stopped = office.machine.orders[0]
    assert (stopped.command.kind, stopped.actor) == ("stop", "viewer-1 (stop ticket)")
    assert {order.command.kind for order in office.machine.orders} == {"stop"}


async def test_a_session_is_found_beside_cookies_of_other_programs(office: Office) -> None:
    session = await office.session(Role.OPERATOR)
    cookies = f'layout={{"rows": [1, 2]}}; a b=1; heliopanel-{PORT}={session}'
    async with connected(
        office.app, headers={"cookie": cookies, "origin": f"http://127.0.0.1:{PORT}"}
    ) as socket:
        await socket.next("state")


async def test_a_socket_ends_within_a_second_of_revocation_and_comes_back_only_to_stop(
    office: Office,
) -> None:
    session = await office.session(Role.OPERATOR)
    headers = {"cookie": f"heliopanel-{PORT}={session}", "origin": f"http://127.0.0.1:{PORT}"}
    async with connected(office.app, headers=headers) as socket:
        await socket.next("state")
        async with office.browser(session) as browser:
            await browser.post("/logout")
        began = office.clock.now()
        await socket.ended.wait()
        assert office.clock.now() - began < timedelta(seconds=1)
    assert socket.closed == 1008
    ticket = office.keeper.stop_ticket(HERE)
    async with connected(office.app, f"stop_ticket={ticket}", headers) as again:
        await again.next("signed_out")
        await again.send(
            type="jog",
            rtt_ms=5.0,
            tracker_id="T1",
            press_id="p",
            axis="azimuth",
            direction=1,
            speed="slow",
            sequence=0,
            tc=0,
        )
        assert (await again.next("jog"))["status"] == "refused"
        await again.send(type="stop_all")
        await again.next("stopped")
    assert [order.command.kind for order in office.machine.orders] == ["stop_all"]
    async with connected(office.app, headers=headers) as without:
        await without.ended.wait()
    assert without.closed == 1008


async def test_a_viewer_cannot_jog_over_the_socket(office: Office) -> None:
    session = await office.session(Role.VIEWER)
    headers = {"cookie": f"heliopanel-{PORT}={session}", "origin": f"http://127.0.0.1:{PORT}"}
    async with connected(office.app, "tracker=T1", headers) as socket:
        await socket.send(
            type="jog",
            rtt_ms=5.0,
            tracker_id="T1",
            press_id="p",
            axis="azimuth",
            direction=1,
            speed="slow",
            sequence=0,
            tc=0,
        )
        refused = await socket.next("jog")
    assert "operator or engineer" in refused["reasons"][0]["message"]
    assert office.machine.orders == []


async def test_a_ticket_opens_a_download_once(office: Office) -> None:
    headers = {"authorization": f"Bearer {await made(office, Scope.READ)}"}
    path = "/api/v1/recordings/none/samples"
    async with office.browser() as browser:
        ticket = (await browser.post("/api/v1/tickets", headers=headers)).json()["ticket"]
        assert (await browser.get(f"{path}?ticket={ticket}")).status_code == 404
        assert (await browser.get(f"{path}?ticket={ticket}")).status_code == 401


async def test_pages_show_a_viewer_what_a_role_may_not_do(office: Office) -> None:
    async with office.browser(await office.session(Role.VIEWER)) as browser:
        seen = (await browser.get("/trackers/T1")).text
        homing = (await browser.get("/trackers/T1/commissioning/homing")).text
    park = seen[seen.index('action="/trackers/T1/park"') :]
    assert park[: park.index("</form>")].count('<fieldset class="denied" disabled>') == 1
    assert "Only for operator or engineer." in park
    stop = seen[seen.index('id="stop-form"') :]
    assert "disabled" not in stop[: stop.index("</form>")]
    assert "data-jog=" not in homing
    async with office.browser(await office.session(Role.ENGINEER)) as browser:
        homing = (await browser.get("/trackers/T1/commissioning/homing")).text
    assert "data-jog=" in homing


@pytest.mark.parametrize("page", ["commissioning/homing", "mast", "service"])
async def test_who_may_not_move_a_tracker_reads_which_role_may_and_who_gives_it(
    page: str, office: Office
) -> None:
    said = {}
    for role in (Role.ADMINISTRATOR, Role.VIEWER, Role.OPERATOR):
        async with office.browser(await office.session(role)) as browser:
            said[role] = (await browser.get(f"/trackers/T1/{page}")).text
    why = "Your role cannot move the tracker. An administrator can add the role operator or engineer"
    assert why in said[Role.ADMINISTRATOR]
    assert why in said[Role.VIEWER]
    assert why not in said[Role.OPERATOR]
    assert '<a href="/users">' in said[Role.ADMINISTRATOR].split(why)[1].split("</p>")[0]
    assert '<a href="/users">' not in said[Role.VIEWER].split(why)[1].split("</p>")[0]
    assert [said[role].count("data-jog=") for role in said] == [0, 0, 4]
