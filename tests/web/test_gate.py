"""Who gets through, told in stories; `test_gate_table.py` walks every route."""

import re
from datetime import timedelta
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts

from app.access.roles import Role
from app.access.tokens import Scope
from app.web.http import manual
from app.web.http.routes import RouteUnguarded, guarded_routes, walk
from tests.web.office import HERE, PASSWORD, PORT, Office
from tests.web.route_table import ROUTES
from tests.web.sockets import connected


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
    return await office.mint(*scopes, trackers=trackers)


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
        assert (await later.post(other)).headers["location"].startswith("/login")
    stopped = office.machine.orders[0]
    assert (stopped.command.kind, stopped.actor) == ("stop", "viewer-1 (stop ticket)")
    assert {order.command.kind for order in office.machine.orders} == {"stop"}


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
        await again.beat("p", 0, 0)
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
        await socket.beat("p", 0, 0)
        refused = await socket.next("jog")
    assert "operator or engineer" in refused["reasons"][0]["message"]
    assert office.machine.orders == []


async def test_pages_show_a_viewer_what_a_role_may_not_do(office: Office) -> None:
    async with office.browser(await office.session(Role.VIEWER)) as browser:
        seen = (await browser.get("/trackers/T1")).text
    park = seen[seen.index('action="/trackers/T1/park"') :]
    assert park[: park.index("</form>")].count('<fieldset class="denied" disabled>') == 1
    assert "Only for operator or engineer." in park
    control = seen[seen.index('action="/trackers/T1/control"') :]
    assert control[: control.index("</form>")].count('<fieldset class="denied" disabled>') == 1
    stop = seen[seen.index('id="stop-form"') :]
    assert "disabled" not in stop[: stop.index("</form>")]


async def test_who_may_not_move_a_tracker_reads_which_role_may_and_who_gives_it(office: Office) -> None:
    for path in ("/trackers/T1/commissioning/homing", "/trackers/T1/mast"):
        said = {}
        for role in (Role.ADMINISTRATOR, Role.VIEWER, Role.OPERATOR):
            async with office.browser(await office.session(role)) as browser:
                said[role] = (await browser.get(path)).text
        assert [said[role].count("data-jog=") for role in said] == [4, 4, 4]
        assert [said[role].count("data-denied") for role in said] == [4, 4, 0]
        assert ['data-action="jog"' in said[role] for role in said] == [False, False, True]
        assert ["Jogging needs the role operator." in said[role] for role in said] == [True, True, False]
        words = {role: said[role].split('id="no-jog-words">')[-1].split("</template>")[0] for role in said}
        assert 'href="/users"' in words[Role.ADMINISTRATOR]
        assert 'href="/users"' not in words[Role.VIEWER]
