"""The gate with a keeper who knows a few people, and with nothing behind it but somebody who listens."""

import asyncio
from typing import Any

from fastapi import FastAPI
from starlette.routing import compile_path
from starlette.types import Message, Receive, Send
from starlette.types import Scope as Asked

from app.access.authenticator import Credentials
from app.access.principal import Principal, SignInNeeded, Via, nobody
from app.access.roles import GRANTS, KNOWN, NOBODY, Role
from app.base.clock import VirtualClock
from app.base.permission import Permission
from app.web.http.gate import Gate
from app.web.http.routes import STATIC_PATH, Guarded
from tests.fake_data import NOON
from tests.web.route_table import NEEDS

FAR = "192.0.2.7"
UNKNOWN_TOKEN = "This token is unknown."  # noqa: S105 - a sentence
TAKEN = (
    "GET /health", "GET /login", "POST /login", "GET /setup", "GET /trackers/{tracker_id}", "POST /stop",
    "POST /trackers/{tracker_id}/park", "POST /users", "GET /network", "WS /live", "GET /api/v1/site",
    "GET /api/v1/stream", "GET /api/v1/journal", "POST /api/v1/stop", "POST /api/v1/users",
    "POST /api/v1/trackers/{tracker_id}/commands", "GET /diagnostics.zip",
)  # fmt: skip


def person(role: Role, **known: Any) -> Principal:
    """Return somebody who signed in and typed the password at noon."""
    about = {"via": Via.SESSION, "credential": "c", "proven_at": NOON, **known}
    return Principal(f"{role}-1", frozenset({role}), GRANTS[role], address=FAR, **about)


def program(*permissions: Permission, trackers: frozenset[str] | None = None) -> Principal:
    """Return whose token allows this."""
    allowed = KNOWN | frozenset(permissions)
    return Principal("scada", frozenset(), allowed, Via.TOKEN, FAR, "t", trackers)


def with_stop_ticket(address: str = FAR) -> Principal:
    """Return whose session ended, and whose page may still stop."""
    return Principal("zoe", frozenset(), NOBODY | {Permission.STOP}, Via.STOP_TICKET, address)


class Notes:
    """What was recorded."""

    def __init__(self) -> None:
        self.taken: list[tuple[Any, ...]] = []

    def note(self, *said: Any) -> None:
        """Take a refusal."""
        self.taken.append(said)


class Doorkeeper:
    """Knows people by what they bring along: by a session, a token or a ticket."""

    def __init__(self) -> None:
        self.is_closed = False
        self.people: dict[str, Principal] = {}
        self.given: list[Credentials] = []
        self.refusals = Notes()
        self.users: list[Principal] = []
        self.awaited: list[Principal] = []
        self.gone = asyncio.Event()
        self.forgotten = False

    def identify(self, given: Credentials) -> Principal:
        """Return who that is."""
        self.given.append(given)
        found = self.people.get(given.bearer or given.session_id or given.ticket or given.stop_ticket)
        if found is None and given.bearer:
            raise SignInNeeded(UNKNOWN_TOKEN)
        return found or nobody(given.address)

    def csrf(self, session_id: str) -> str:
        """Return what pages of a session send along."""
        return f"csrf of {session_id}"

    async def used(self, who: Principal) -> None:
        """Take that somebody is there."""
        self.users.append(who)

    async def until_gone(self, who: Principal) -> None:
        """Wait until everybody must leave."""
        self.awaited.append(who)
        try:
            await self.gone.wait()
        finally:
            await _a_few_turns()
            self.forgotten = True


class Behind:
    """Who gets through is heard here; what lasts does so until it is told to end."""

    def __init__(self) -> None:
        self.heard: list[tuple[Asked, Receive, Send]] = []
        self.ends = asyncio.Event()
        self.ends.set()
        self.broken: Exception | None = None
        self.cancelled = False

    async def __call__(self, scope: Asked, receive: Receive, send: Send) -> None:
        self.heard.append((scope, receive, send))
        try:
            await self.ends.wait()
        except asyncio.CancelledError:
            await _a_few_turns()
            self.cancelled = True
            raise
        if self.broken is not None:
            raise self.broken


class Gatehouse:
    """The gate, who knows people, and what stands behind it."""

    def __init__(self) -> None:
        self.clock = VirtualClock(NOON)
        self.keeper = Doorkeeper()
        self.behind = Behind()
        self.panel_app = FastAPI()
        self.sent: list[Message] = []
        routes = [_guarded(key) for key in TAKEN]
        routes.append(Guarded(STATIC_PATH, frozenset({"GET"}), compile_path("/s/{path:path}")[0], None))
        keeper: Any = self.keeper
        self.gate = Gate(
            self.behind, panel_app=self.panel_app, keeper=keeper, clock=self.clock, routes=tuple(routes)
        )

    async def receive(self) -> Message:
        """Return the whole of a request without a body."""
        return {"type": "http.request", "body": b"", "more_body": False}

    async def send(self, message: Message) -> None:
        """Take what is answered."""
        self.sent.append(message)

    async def ask(self, key: str, query: str = "", **headers: str) -> bool:
        """Ask for something; return whether that got through."""
        return await self.ask_as(asked_for(key, query, **headers))

    async def ask_as(self, scope: dict[str, Any]) -> bool:
        """Ask as it stands in this scope; return whether that got through."""
        before = len(self.behind.heard)
        self.sent.clear()
        await self.gate(scope, self.receive, self.send)
        return len(self.behind.heard) > before

    def knows(self, name: str, who: Principal) -> None:
        """Have the keeper know somebody by a session, a token or a ticket of this name."""
        self.keeper.people[name] = who

    @property
    def status(self) -> int:
        """Return the status that was answered."""
        return int(self.sent[0]["status"])

    @property
    def headers(self) -> dict[str, str]:
        """Return the headers that were answered."""
        return {name.decode(): value.decode() for name, value in self.sent[0]["headers"]}

    @property
    def body(self) -> str:
        """Return the text that was answered."""
        return "".join(message.get("body", b"").decode() for message in self.sent)


def asked_for(key: str, query: str = "", **headers: str) -> dict[str, Any]:
    """Return the scope of a request; in the names of headers _ stands for -."""
    method, path = key.split(" ")
    scope = {
        "type": "websocket" if method == "WS" else "http",
        "path": path,
        "query_string": query.encode(),
        "headers": [(name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()],
        "scheme": "http",
        "server": ("127.0.0.1", 8000),
        "client": (FAR, 50000),
    }
    return scope if method == "WS" else scope | {"method": method}


def of_session(session: str) -> str:
    """Return the cookie of a session at the port of these scopes."""
    return f"heliopanel-8000={session}"


async def _a_few_turns() -> None:
    """Put something away, which takes a while."""
    for _ in range(5):
        await asyncio.sleep(0)


def _guarded(key: str) -> Guarded:
    method, path = key.split(" ")
    return Guarded(path, frozenset({method}), compile_path(path)[0], NEEDS[key])
