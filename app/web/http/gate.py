"""The gate: every request is somebody's, and gets through only if its route says that they may."""

import asyncio
from collections import OrderedDict, deque
from collections.abc import Callable
from datetime import datetime, timedelta
from hmac import compare_digest

from fastapi import FastAPI
from starlette.datastructures import Headers, QueryParams
from starlette.requests import Request, cookie_parser
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.access.authenticator import Credentials, Keeper
from app.access.principal import NotAllowed, Principal, ProofNeeded, SignInNeeded, Via, nobody
from app.access.sessions import is_proven
from app.access.tokens import token_id_of
from app.base.clock import Clock, is_within
from app.base.message import N_, say, told_by
from app.base.permission import Permission
from app.web.http.errors import FOR_PROGRAMS, Busy, NotAcceptable, NotSetUp, answer_to
from app.web.http.needs import Need
from app.web.http.paths import login_path, proof_path
from app.web.http.routes import STATIC, Asked, Guarded, asked_of
from app.web.http.security import SAFE_METHODS

WHILE_CLOSED = frozenset(
    {
        STATIC,
        "GET /setup",
        "POST /setup",
        "GET /certificate",
        "GET /certificate/ca.crt",
        "GET /health",
        "GET /ready",
        "POST /theme",
        "POST /language",
    }
)
STOPS_WINDOW, MOST_STOPS = timedelta(seconds=1), 10
MOST_ADDRESSES = 1000
REFUSED = {NotAllowed: "refused", Busy: "refused_stops"}
"""What a refusal is called in the record of access."""

NOT_SET_UP = N_(
    "Heliopanel has no administrator yet and shows only its setup page. Open /setup with the code "
    "from its console, or run: heliopanel users add NAME --role administrator"
)
LONGEST_BACK = 300
"""As long as the way back may be in the address of the pages that ask for a password."""

MOST_FIELDS = 50
TOO_MANY_FIELDS = say(
    "The address of a request has at most {most_fields} fields: leave out the others.",
    most_fields=MOST_FIELDS,
)
OLD_PAGE = N_("This page is outdated and cannot change anything. Reload the page, then repeat the action.")


class Gate:
    """Finds out who asks, turns away who may not, and lets lasting answers end when somebody must leave."""

    def __init__(
        self, app: ASGIApp, *, panel_app: FastAPI, keeper: Keeper, clock: Clock, routes: tuple[Guarded, ...]
    ) -> None:
        self._app = app
        self._panel_app = panel_app
        self._keeper = keeper
        self._clock = clock
        self._routes = routes
        self._stops = StopLimit()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on as somebody's, or answer why not."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        scope["app"] = self._panel_app
        try:
            found = asked_of(self._routes, scope)
            who = self._admit(scope, found)
        except (NotAcceptable, NotSetUp) as error:
            await _turn_away(scope, receive, send, error)
            return
        except (NotAllowed, ProofNeeded, SignInNeeded, Busy) as error:
            self._record(scope, error)
            await _turn_away(scope, receive, send, error)
            return
        if is_activity(scope, found.key):
            await self._keeper.used(who)
        if found.need.lasts:
            await self._while_allowed(scope, receive, send, who)
        else:
            await self._app(scope, receive, send)

    def _record(self, scope: Scope, error: Exception) -> None:
        """Have it recorded that somebody was turned away; who has only to sign in was not."""
        action = REFUSED.get(type(error))
        bearer = credentials(scope).bearer
        if action is None and not bearer:
            return
        who = scope.get("state", {}).get("principal") or nobody(_address(scope))
        why = told_by(error)
        if (found := token_id_of(bearer)) and action is None:
            why = say("{why} Its ID is {token_id}.", why=why, token_id=found)
        refusals, now = self._keeper.refusals, self._clock.now()
        refusals.note(action or "refused_token", who, asked(scope), why, now)

    def _admit(self, scope: Scope, found: Asked) -> Principal:
        given = credentials(scope, ticketed=found.need.ticketed)
        who = self._keeper.identify(given)
        scope.setdefault("state", {})["principal"] = who
        scope["state"]["session_id"] = given.session_id
        if self._keeper.is_closed:
            if found.key not in WHILE_CLOSED:
                raise NotSetUp(NOT_SET_UP)
            return who
        if found.key == STATIC:
            return who
        query = _query(scope)
        told = (found.path_parameters.get("tracker_id"), query.get("tracker_id"), query.get("tracker"))
        named: set[str | None] = {name for name in told if name}
        for tracker_id in named or {None}:
            who.require(found.need.permission, tracker_id)
        if who.via in (Via.SESSION, Via.KIOSK):
            self._check_session(scope, found.need, who, given)
        if who.via is Via.STOP_TICKET and not self._stops.admit(who.address, self._clock.now()):
            raise Busy(
                N_("This address sends more than ten stop commands per second; the first ones were executed.")
            )
        return who

    def _check_session(self, scope: Scope, need: Need, who: Principal, given: Credentials) -> None:
        if need.permission in (Permission.OPEN, Permission.STOP) and scope["type"] == "http":
            return
        check_origin(scope, self._keeper.csrf(given.session_id))
        if need.proven and who.via is Via.SESSION and not is_proven(who.proven_at, self._clock.now()):
            raise ProofNeeded(
                N_("This is a sensitive change: confirm your password, then repeat the action.")
            )

    async def _while_allowed(self, scope: Scope, receive: Receive, send: Send, who: Principal) -> None:
        serving = asyncio.ensure_future(self._app(scope, receive, send))
        leaving = asyncio.create_task(self._keeper.until_gone(who))
        try:
            await asyncio.wait({serving, leaving}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            ended_by_itself = serving.done()
            serving.cancel()
            leaving.cancel()
            await asyncio.gather(serving, leaving, return_exceptions=True)
        if ended_by_itself:
            serving.result()
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": N_("signed out")})
        else:
            await send({"type": "http.response.body", "body": b"", "more_body": False})


class StopLimit:
    """At most ten stops a second of an address that has nothing but a stop ticket."""

    def __init__(self) -> None:
        self._recent: OrderedDict[str, deque[datetime]] = OrderedDict()

    def admit(self, address: str, now: datetime) -> bool:
        """Count one more stop, unless that would be too many."""
        recent = self._recent.setdefault(address, deque())
        self._recent.move_to_end(address)
        if len(self._recent) > MOST_ADDRESSES:
            self._recent.popitem(last=False)
        while recent and not is_within(recent[0], now, STOPS_WINDOW):
            recent.popleft()
        if len(recent) >= MOST_STOPS:
            return False
        recent.append(now)
        return True


def asked(scope: Scope) -> str:
    """Return what was asked for, for the record: method and path."""
    return f"{scope.get('method', 'WS')} {scope['path']}"


def record_foreign(keeper: Keeper, clock: Clock) -> Callable[[Scope, str], None]:
    """Return what records that the guard turned a request away, before anybody knew whose it is."""

    def record(scope: Scope, why: str) -> None:
        keeper.refusals.note("refused_foreign", nobody(_address(scope)), asked(scope), why, clock.now())

    return record


def _address(scope: Scope) -> str:
    client = scope.get("client")
    return client[0] if client else ""


def credentials(scope: Scope, *, ticketed: bool = False) -> Credentials:
    """Return what a request brings along; one with a bearer token is judged by nothing else."""
    headers, query, address = Headers(scope=scope), _query(scope), _address(scope)
    scheme, _, bearer = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        return Credentials(address, bearer=bearer.strip() or "none")
    return Credentials(
        address,
        session_id=cookie_parser(headers.get("cookie", "")).get(cookie_name(scope), ""),
        ticket=query.get("ticket", "") if ticketed else "",
        stop_ticket=query.get("stop_ticket", ""),
    )


def cookie_name(scope: Scope) -> str:
    """Return the name of the session's cookie: bound to this host with TLS, to this port without."""
    if scope.get("scheme") in ("https", "wss"):
        return "__Host-heliopanel"
    server = scope.get("server")
    return f"heliopanel-{server[1] if server else 0}"


def _query(scope: Scope) -> QueryParams:
    """Return the fields of the address as the routes read them; of one that is repeated the last counts."""
    given: bytes = scope.get("query_string", b"")
    if given.count(b"&") >= MOST_FIELDS:
        raise NotAcceptable(TOO_MANY_FIELDS)
    return QueryParams(given)


def check_origin(scope: Scope, csrf: str) -> None:
    """Raise `NotAllowed` unless a change comes from a page of this panel.

    Foreign origins are turned away before; one's own is told by the browser or by the page's token.
    """
    headers = Headers(scope=scope)
    if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
        return
    token = headers.get("x-csrf-token")
    told = "origin" in headers or "sec-fetch-site" in headers
    by_script = headers.get("hx-request") == "true"
    if token is None and told and not by_script:
        return
    if token is None or not compare_digest(token.encode(), csrf.encode()):
        raise NotAllowed(OLD_PAGE)


def is_activity(scope: Scope, route: str) -> bool:
    """Return whether a request shows that a person is there: a change, or a page that was opened."""
    if scope["type"] != "http" or route == STATIC:
        return False
    return scope["method"] not in SAFE_METHODS or "hx-request" not in Headers(scope=scope)


async def _turn_away(scope: Scope, receive: Receive, send: Send, error: Exception) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008, "reason": N_("not allowed")})
        return
    request = Request(scope)
    answer = way_in(request, error) or answer_to(request, error)
    await answer(scope, receive, send)


def way_in(request: Request, error: Exception) -> Response | None:
    """Return the way to the page where one signs in, proves who one is or begins; None for programs."""
    if request.url.path.startswith(FOR_PROGRAMS) or isinstance(error, NotAllowed | Busy | NotAcceptable):
        return None
    if isinstance(error, NotSetUp):
        return RedirectResponse("/setup", 303)
    back = request.url.path if request.method in SAFE_METHODS else _page_of(request)
    path = login_path(back) if isinstance(error, SignInNeeded) else proof_path(back)
    if "hx-request" in request.headers:
        return Response(status_code=204, headers={"HX-Redirect": path})
    return RedirectResponse(path, 303)


def _page_of(request: Request) -> str:
    """Return the page that a form was on, by the address that the browser tells."""
    current = request.headers.get("hx-current-url") or request.headers.get("referer", "")
    page = "/" + current.partition("//")[2].partition("/")[2]
    return page if len(page) <= LONGEST_BACK else page.partition("?")[0]
