"""The gate by itself, decision by decision: who gets through, what the others are told, what is recorded."""

import asyncio
from datetime import timedelta

import pytest

from app.access.principal import Via, nobody
from app.access.roles import Role
from app.access.tokens import mint
from app.base.permission import Permission
from app.web.http.gate import NOT_SET_UP, OLD_PAGE, TOO_MANY_FIELDS, record_foreign
from tests.fake_data import NOON
from tests.web.gatehouse import (
    FAR,
    UNKNOWN_TOKEN,
    Gatehouse,
    asked_for,
    of_session,
    person,
    program,
    with_stop_ticket,
)

MOVE = "POST /api/v1/trackers/T1/commands"
TOKEN_ID, TOKEN = mint()
NOT_ALLOWED = {"type": "websocket.close", "code": 1008, "reason": "not allowed"}
TOO_OFTEN = "This address sends more than ten stop commands per second; the first ones were executed."


@pytest.fixture
def house() -> Gatehouse:
    return Gatehouse()


def own_page(session: str) -> dict[str, str]:
    """Return what a page of this session sends with a change."""
    return {"cookie": of_session(session), "x_csrf_token": f"csrf of {session}"}


async def test_what_is_no_request_is_passed_on_as_it_is(house: Gatehouse) -> None:
    scope = {"type": "lifespan"}
    await house.gate(scope, house.receive, house.send)
    assert house.behind.heard == [(scope, house.receive, house.send)]
    assert scope == {"type": "lifespan"}


async def test_who_gets_through_is_told_to_what_stands_behind(house: Gatehouse) -> None:
    viewer = person(Role.VIEWER)
    house.knows("s", viewer)
    scope = asked_for("GET /trackers/T1", cookie=of_session("s")) | {"state": {"of": "the server"}}
    assert await house.ask_as(scope)
    assert house.behind.heard == [(scope, house.receive, house.send)]
    assert house.sent == []
    assert scope["app"] is house.panel_app
    assert scope["state"] == {"of": "the server", "principal": viewer, "session_id": "s"}


async def test_files_of_the_panel_are_for_everybody_and_what_no_route_takes_is_not(house: Gatehouse) -> None:
    assert await house.ask("GET /s/panel.css")
    assert not await house.ask("GET /nowhere")
    assert house.headers["location"] == "/login?back=/nowhere"
    house.knows("s", person(Role.VIEWER))
    assert await house.ask("GET /nowhere", cookie=of_session("s")), "the framework says that it is not there"


async def test_what_a_role_may_not_do_is_refused_and_recorded(house: Gatehouse) -> None:
    viewer = person(Role.VIEWER)
    house.knows("s", viewer)
    assert not await house.ask(MOVE, **own_page("s"))
    assert house.status == 403
    why = viewer.refusal(Permission.OPERATE, "T1")
    assert why in house.body
    assert house.keeper.refusals.taken == [("refused", viewer, MOVE, why, NOON)]


async def test_a_token_that_is_no_good_is_recorded_with_its_id_if_it_has_one(house: Gatehouse) -> None:
    for token, known in (("nonsense", ""), (TOKEN, f" Its ID is {TOKEN_ID}.")):
        assert not await house.ask("GET /api/v1/site", authorization=f"Bearer {token}")
        assert house.status == 401
        told = ("refused_token", nobody(FAR), "GET /api/v1/site", f"{UNKNOWN_TOKEN}{known}", NOON)
        assert house.keeper.refusals.taken.pop() == told


async def test_of_a_token_that_is_good_no_id_is_recorded_and_of_who_has_to_sign_in_nothing(
    house: Gatehouse,
) -> None:
    scada = program(Permission.READ)
    house.knows(TOKEN, scada)
    assert not await house.ask(MOVE, authorization=f"Bearer {TOKEN}")
    why = scada.refusal(Permission.OPERATE, "T1")
    assert house.keeper.refusals.taken == [("refused", scada, MOVE, why, NOON)]
    house.keeper.refusals.taken.clear()
    assert not await house.ask("GET /api/v1/site")
    assert house.status == 401
    assert house.keeper.refusals.taken == []


async def test_a_socket_that_may_not_open_is_closed_and_recorded(house: Gatehouse) -> None:
    house.knows("s", person(Role.VIEWER))
    headers = {"cookie": of_session("s"), "x_csrf_token": "of another session"}
    assert not await house.ask("WS /live", **headers)
    assert house.sent == [NOT_ALLOWED]
    assert house.keeper.refusals.taken == [("refused", person(Role.VIEWER), "WS /live", OLD_PAGE, NOON)]
    assert not await house.ask("WS /live")
    assert house.sent == [NOT_ALLOWED]


async def test_an_address_with_too_many_fields_is_refused_and_not_recorded(house: Gatehouse) -> None:
    house.knows("s", person(Role.VIEWER))
    allowed = "&".join(f"f{number}=1" for number in range(50))
    assert await house.ask("GET /api/v1/site", allowed, cookie=of_session("s"))
    assert not await house.ask("GET /api/v1/site", allowed + "&f=1", cookie=of_session("s"))
    assert (house.status, TOO_MANY_FIELDS in house.body) == (422, True)
    assert not await house.ask("WS /live", allowed + "&f=1", **own_page("s"))
    assert house.sent == [NOT_ALLOWED]
    assert house.keeper.refusals.taken == []


@pytest.mark.parametrize("open_to_all", ["GET /s/panel.css", "GET /setup", "GET /health"])
async def test_without_an_administrator_there_is_the_way_to_the_first(
    house: Gatehouse, open_to_all: str
) -> None:
    house.keeper.is_closed = True
    assert await house.ask(open_to_all)
    assert not await house.ask("GET /login")
    assert (house.status, house.headers["location"]) == (303, "/setup")
    assert not await house.ask("GET /api/v1/site")
    assert house.status == 503
    assert NOT_SET_UP in house.body
    assert not await house.ask("WS /live")
    assert house.sent == [NOT_ALLOWED]
    assert house.keeper.refusals.taken == []


async def test_people_are_noted_to_be_there_by_what_they_do_and_not_by_what_a_page_asks(
    house: Gatehouse,
) -> None:
    operator = person(Role.OPERATOR)
    house.knows("s", operator)
    assert await house.ask("GET /trackers/T1", cookie=of_session("s"), hx_request="true")
    assert await house.ask("GET /s/panel.css", cookie=of_session("s"))
    assert house.keeper.users == []
    assert await house.ask(MOVE, **own_page("s"), hx_request="true")
    assert await house.ask("GET /trackers/T1", cookie=of_session("s"))
    assert house.keeper.users == [operator, operator]


@pytest.mark.parametrize(
    ("key", "query", "passes"),
    [
        (MOVE, "", True),
        ("POST /api/v1/trackers/T2/commands", "", False),
        ("POST /api/v1/trackers/T2/commands", "tracker=T1", False),
        (MOVE, "tracker_id=T2", False),
        (MOVE, "tracker=T2", False),
        ("GET /api/v1/journal", "tracker_id=T1&tracker=T1", True),
        ("GET /api/v1/journal", "tracker_id=T2", False),
        ("GET /api/v1/journal", "tracker=T2", False),
        ("GET /api/v1/journal", "tracker_id=T1&tracker=T2", False),
        ("GET /api/v1/journal", "tracker_id=T1&tracker_id=T2", False),
        ("GET /api/v1/journal", "tracker_id=T2&tracker_id=T1", True),
        ("GET /api/v1/journal", "tracker_id=", True),
        ("GET /api/v1/journal", "", True),
    ],
)
async def test_a_token_for_one_tracker_reaches_no_other(
    house: Gatehouse, key: str, query: str, passes: bool
) -> None:
    house.knows("t", program(Permission.READ, Permission.OPERATE, trackers=frozenset({"T1"})))
    assert await house.ask(key, query, authorization="Bearer t") is passes
    assert house.status == 403 if not passes else not house.sent


async def test_a_change_needs_the_page_of_its_own_session(house: Gatehouse) -> None:
    house.knows("s", person(Role.OPERATOR))
    cookie = of_session("s")
    assert not await house.ask("POST /trackers/T1/park", cookie=cookie)
    assert (house.status, OLD_PAGE in house.body) == (403, True)
    assert not await house.ask("POST /trackers/T1/park", **own_page("x") | {"cookie": cookie})
    assert await house.ask("POST /trackers/T1/park", **own_page("s"))


async def test_to_stop_and_what_is_open_need_no_page_but_the_live_socket_does(house: Gatehouse) -> None:
    house.knows("s", person(Role.VIEWER))
    assert await house.ask("POST /stop", cookie=of_session("s"))
    assert await house.ask("POST /login", cookie=of_session("s"))
    assert not await house.ask("WS /live", cookie=of_session("s"))
    assert await house.ask("WS /live", **own_page("s"))


async def test_a_cabinet_needs_its_own_page_and_no_fresh_password(house: Gatehouse) -> None:
    house.knows("s", person(Role.ADMINISTRATOR, via=Via.KIOSK, proven_at=None))
    assert not await house.ask("POST /users", cookie=of_session("s"))
    assert house.status == 403
    assert await house.ask("POST /users", **own_page("s"))


async def test_what_is_of_weight_needs_a_fresh_password_of_a_person(house: Gatehouse) -> None:
    house.knows("s", person(Role.ADMINISTRATOR))
    house.clock.advance(timedelta(minutes=5))
    assert not await house.ask("POST /api/v1/users", **own_page("s"))
    assert (house.status, house.headers["proof-needed"]) == (403, "1")
    assert not await house.ask("POST /users", **own_page("s"), referer="http://here/users?new=1")
    assert (house.status, house.headers["location"]) == (303, "/prove?back=/users%3Fnew%3D1")
    assert not await house.ask("GET /network", cookie=of_session("s"))
    assert house.headers["location"] == "/prove?back=/network"
    assert await house.ask("GET /trackers/T1", cookie=of_session("s"))
    assert house.keeper.refusals.taken == []
    house.knows("s", person(Role.ADMINISTRATOR, proven_at=NOON + timedelta(seconds=1)))
    assert await house.ask("POST /users", **own_page("s"))


@pytest.mark.parametrize("key", ["GET /diagnostics.zip", "WS /live", "GET /api/v1/stream"])
async def test_a_ticket_opens_a_download_or_a_stream_and_nothing_else(house: Gatehouse, key: str) -> None:
    house.knows("k", program(*Permission))
    assert await house.ask(key, "ticket=k")
    assert not await house.ask("GET /api/v1/site", "ticket=k")


async def test_a_program_is_asked_for_neither_page_nor_password(house: Gatehouse) -> None:
    house.knows("t", program(Permission.ADMINISTER))
    assert await house.ask("POST /api/v1/users", authorization="Bearer t")


async def test_an_address_with_nothing_but_a_ticket_stops_ten_times_a_second(house: Gatehouse) -> None:
    house.knows("k", with_stop_ticket())
    house.knows("other", with_stop_ticket("192.0.2.8"))
    house.knows("t", program(Permission.STOP))
    for _ in range(10):
        assert await house.ask("POST /stop", "stop_ticket=k")
    assert not await house.ask("POST /api/v1/stop", "stop_ticket=k")
    assert (house.status, TOO_OFTEN in house.body) == (429, True)
    told = ("refused_stops", with_stop_ticket(), "POST /api/v1/stop", TOO_OFTEN, NOON)
    assert house.keeper.refusals.taken == [told]
    assert await house.ask("POST /stop", "stop_ticket=other")
    assert await house.ask("POST /api/v1/stop", authorization="Bearer t")
    house.clock.advance(timedelta(seconds=1))
    assert await house.ask("POST /stop", "stop_ticket=k")


@pytest.mark.parametrize("key", ["WS /live", "GET /api/v1/stream"])
async def test_what_lasts_ends_by_itself_or_breaks_as_it_would_without_the_gate(
    house: Gatehouse, key: str
) -> None:
    viewer = person(Role.VIEWER)
    house.knows("s", viewer)
    assert await house.ask(key, **own_page("s"))
    (scope, receive, send) = house.behind.heard.pop()
    assert (scope["path"], receive, send) == (key.split(" ")[1], house.receive, house.send)
    assert house.sent == []
    assert house.keeper.awaited == [viewer]
    assert house.keeper.forgotten
    house.behind.broken = KeyError("a mistake")
    with pytest.raises(KeyError, match="a mistake"):
        await house.ask(key, **own_page("s"))


@pytest.mark.parametrize(
    ("key", "farewell"),
    [
        ("WS /live", {"type": "websocket.close", "code": 1008, "reason": "signed out"}),
        ("GET /api/v1/stream", {"type": "http.response.body", "body": b"", "more_body": False}),
    ],
)
async def test_what_lasts_ends_once_somebody_must_leave(
    house: Gatehouse, key: str, farewell: dict[str, object]
) -> None:
    house.knows("s", person(Role.VIEWER))
    house.behind.ends.clear()
    asking = asyncio.create_task(house.ask(key, **own_page("s")))
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    assert not house.behind.cancelled
    house.keeper.gone.set()
    await asking
    assert house.behind.cancelled
    assert house.sent == [farewell]


async def test_what_lasts_is_ended_with_the_connection(house: Gatehouse) -> None:
    house.knows("s", person(Role.VIEWER))
    house.behind.ends.clear()
    asking = asyncio.create_task(house.ask("WS /live", **own_page("s")))
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    asking.cancel()
    with pytest.raises(asyncio.CancelledError):
        await asking
    assert house.behind.cancelled
    assert house.keeper.forgotten
    assert house.sent == []


def test_what_the_guard_turned_away_is_recorded_too(house: Gatehouse) -> None:
    record = record_foreign(house.keeper, house.clock)  # type: ignore[arg-type] # who knows people
    record(asked_for("POST /stop"), "Heliopanel does not answer to this host name.")
    record(asked_for("WS /live") | {"client": None}, "Not from here.")
    assert house.keeper.refusals.taken == [
        ("refused_foreign", nobody(FAR), "POST /stop", "Heliopanel does not answer to this host name.", NOON),
        ("refused_foreign", nobody(""), "WS /live", "Not from here.", NOON),
    ]
