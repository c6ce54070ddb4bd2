"""Every way in, held against the table of permissions: with each role and scope, and with what is no good."""

import copy
import json
import re
from collections.abc import AsyncIterator, Iterable
from dataclasses import dataclass, field
from datetime import timedelta

import pytest
import pytest_asyncio
from starlette.types import Message, Receive, Send
from starlette.types import Scope as Asked

from app.access.roles import GRANTS, Role
from app.access.tokens import SCOPES, Scope
from app.base.permission import Permission
from tests.fault_result import FaultResult
from tests.web.asgi import scope_of
from tests.web.office import COOKIE, HERE, ORIGIN, PORT, Office
from tests.web.route_table import ROUTES

pytestmark = pytest.mark.asyncio(loop_scope="module")

OWN = {"host": f"127.0.0.1:{PORT}", "origin": ORIGIN, "sec-fetch-site": "same-origin"}
READING = tuple(key for key in ROUTES if key.startswith("GET "))
CHANGING = tuple(key for key in ROUTES if not key.startswith("GET "))
REFUSED, WITHOUT, PASSED = (401, 403, 1008), (303, 204), 200


@dataclass
class Answer:
    """What came back: a status, or the code with which a WebSocket was closed."""

    status: int = 0
    headers: dict[str, str] = field(default_factory=dict)
    body: bytes = b""

    @property
    def is_refusal(self) -> bool:
        """Return whether the panel said no, in one of its ways."""
        to = self.headers.get("location", "") + self.headers.get("hx-redirect", "")
        return self.status in REFUSED or (self.status in WITHOUT and to.startswith(("/login", "/prove")))


class Inside:
    """Stands behind the gate, in the place of all routes: who reaches it has got through."""

    def __init__(self) -> None:
        self.reached = 0

    async def __call__(self, scope: Asked, receive: Receive, send: Send) -> None:
        self.reached += 1
        if scope["type"] == "websocket":
            await send({"type": "websocket.accept"})
            await send({"type": "websocket.close", "code": 1000})
        else:
            await send({"type": "http.response.start", "status": PASSED, "headers": []})
            await send({"type": "http.response.body", "body": b"passed"})


class Doors:
    """The whole panel with everything that stands before its routes, and nothing behind it."""

    def __init__(self, office: Office) -> None:
        self.office = office
        self.inside = Inside()
        panel = copy.copy(office.app)
        panel.router = self.inside  # type: ignore[assignment] # it is called, and nothing else
        self._stack = panel.build_middleware_stack()

    async def ask(self, key: str, headers: dict[str, str]) -> Answer:
        """Return what the panel answers to one request of a kind."""
        method, path = filled(key)
        answer = Answer()

        async def hear(message: Message) -> None:
            if message["type"] == "http.response.start":
                answer.status = message["status"]
                answer.headers = {name.decode(): value.decode() for name, value in message["headers"]}
            answer.body += message.get("body", b"")
            if message["type"].startswith("websocket."):
                answer.status = message.get("code", PASSED)

        await self._stack(scope_of(method, path, headers=headers), nothing_more, hear)
        return answer

    async def passed(self, headers: dict[str, str], keys: Iterable[str] = ROUTES) -> set[str]:
        """Return which kinds of requests get through; each other must be turned away, and be told nothing."""
        through = set()
        for key in keys:
            before = self.inside.reached
            answer = await self.ask(key, headers)
            if self.inside.reached > before:
                through.add(key)
            else:
                assert answer.is_refusal, (key, answer)
                assert b"North field" not in answer.body, key
        return through


async def nothing_more() -> Message:
    return {"type": "http.request", "body": b"", "more_body": False}


def filled(key: str) -> tuple[str, str]:
    """Return method and address of a route; what its parameters name does not exist."""
    method, path = key.split(" ", 1)
    return method, re.sub(r"{[^}]*}", "none", path)


def with_permission(*permissions: Permission) -> set[str]:
    return {key for key, permission in ROUTES.items() if permission in permissions}


@dataclass
class Keys:
    """What opens the panel, and what did so once."""

    sessions: dict[Role, str]
    tokens: dict[Scope, str]
    bad_sessions: dict[str, str]
    bad_tokens: dict[str, str]


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def doors(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Doors]:
    office = Office(tmp_path_factory.mktemp("office"))
    async with office.app.router.lifespan_context(office.app):
        await office.hire(*Role)
        yield Doors(office)


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def keys(doors: Doors) -> Keys:
    office = doors.office
    sessions = {"never begun": "x" * 43, "expired": await office.session(Role.ENGINEER)}
    tokens = {"nonsense": "hp_nonsense", "none at all": "", "expired": await office.mint(*Scope)}
    office.clock.ahead = timedelta(days=366)
    sessions["signed out"] = await office.session(Role.ENGINEER)
    tokens["revoked"] = await office.mint(*Scope)
    async with office.browser(sessions["signed out"]) as browser:
        await browser.post("/logout")
    now = office.clock.now()
    await office.keeper.do(lambda: office.keeper.accounts.revoke(HERE, tokens["revoked"][3:11], now))
    return Keys(
        {role: await office.session(role) for role in Role},
        {scope: await office.mint(scope) for scope in Scope},
        sessions,
        tokens,
    )


def signed_in(doors: Doors, session: str) -> dict[str, str]:
    """Return what a page of this session sends."""
    return OWN | {"cookie": f"{COOKIE}={session}", "x-csrf-token": doors.office.keeper.csrf(session)}


@pytest.mark.parametrize("role", Role)
async def test_every_role_gets_through_where_the_table_says_so(doors: Doors, keys: Keys, role: Role) -> None:
    assert await doors.passed(signed_in(doors, keys.sessions[role])) == with_permission(*GRANTS[role])


@pytest.mark.parametrize("scope", Scope)
async def test_every_scope_gets_through_where_the_table_says_so(
    doors: Doors, keys: Keys, scope: Scope
) -> None:
    bearer = {"host": OWN["host"], "authorization": f"Bearer {keys.tokens[scope]}"}
    assert await doors.passed(bearer) == with_permission(Permission.OPEN, Permission.KNOWN, *SCOPES[scope])


@pytest.mark.parametrize("why", ["none", "never begun", "expired", "signed out"])
async def test_without_a_session_that_is_good_only_what_is_open_is_answered(
    doors: Doors, keys: Keys, why: str
) -> None:
    headers = OWN if why == "none" else signed_in(doors, keys.bad_sessions[why])
    assert await doors.passed(headers) == with_permission(Permission.OPEN)


@pytest.mark.fault(63)
@pytest.mark.parametrize("why", ["nonsense", "none at all", "expired", "revoked"])
async def test_a_token_that_is_no_good_opens_nothing_even_beside_a_session(
    doors: Doors, keys: Keys, why: str, fault: FaultResult
) -> None:
    best = signed_in(doors, keys.sessions[Role.ENGINEER])
    best |= {"authorization": f"Bearer {keys.bad_tokens[why]}"}
    assert await doors.passed(best) == set()
    refused = await doors.ask("GET /api/v1/site", best)
    assert refused.status == 401
    fault.shows(json.loads(refused.body)["detail"])


FOREIGN = (
    {"origin": "http://elsewhere.example"},
    {"origin": "null"},
    {"origin": f"http://127.0.0.1:{PORT + 1}"},
    {"sec-fetch-site": "cross-site"},
    {"sec-fetch-site": "same-site"},
)


@pytest.mark.fault(70)
@pytest.mark.parametrize("foreign", FOREIGN, ids=str)
async def test_a_foreign_page_changes_nothing_whoever_is_signed_in(
    doors: Doors, keys: Keys, foreign: dict[str, str], fault: FaultResult
) -> None:
    for role in (Role.ENGINEER, Role.ADMINISTRATOR):
        headers = signed_in(doors, keys.sessions[role]) | foreign
        assert await doors.passed(headers, CHANGING) == set()
    fault.prevented("a request of a foreign page is refused, also of a user who is signed in")
    refused = await doors.ask("POST /api/v1/stop", signed_in(doors, keys.sessions[Role.ENGINEER]) | foreign)
    assert refused.status == 403
    fault.shows(json.loads(refused.body)["detail"])
    fault.recovers("nothing was lost")


@pytest.mark.fault(70)
async def test_a_foreign_page_cannot_read_what_it_asks_for(doors: Doors, keys: Keys) -> None:
    headers = signed_in(doors, keys.sessions[Role.ENGINEER]) | FOREIGN[0]
    for key in READING:
        answer = await doors.ask(key, headers)
        assert "access-control-allow-origin" not in answer.headers, key
        assert answer.headers["cross-origin-resource-policy"] == "same-origin", key


@pytest.mark.fault(70)
async def test_another_name_of_the_panel_opens_nothing(doors: Doors, keys: Keys) -> None:
    headers = signed_in(doors, keys.sessions[Role.ENGINEER]) | {"host": "rebound.example"}
    assert await doors.passed(headers) == set()


@pytest.mark.fault(70)
async def test_an_old_page_of_htmx_changes_nothing(doors: Doors, keys: Keys) -> None:
    headers = signed_in(doors, keys.sessions[Role.ENGINEER])
    headers |= {"x-csrf-token": "of another session", "hx-request": "true"}
    free = with_permission(Permission.OPEN, Permission.STOP) & set(CHANGING) - {"WS /live"}
    assert await doors.passed(headers, CHANGING) == free
