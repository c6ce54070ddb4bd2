"""Who may call at all: the guard against foreign pages, and the headers that every answer carries."""

import ipaddress
import re
from collections.abc import Callable
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.middleware.body_limit import RequestBodyLimitMiddleware
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.base.message import N_, plain, say
from app.base.settings import Settings
from app.web.http.problems import MEDIA_TYPE, Problem, ProblemCode

LARGEST_BODY = 1024 * 1024
LARGEST_UPLOAD = 9 * 1024 * 1024
UPLOADS = re.compile(r"/api/v1/weather-files|/studies/weather|(?:/api/v1)?/trackers/[^/]+/record/photos")
"""Where files come in; everywhere else a request has at most `LARGEST_BODY`."""

TOO_LARGE = N_(
    "A request to Heliopanel can have at most one megabyte; an upload of a weather file "
    "or a photo can have eight."
)
TWO_HOSTS = N_("This request names two hosts, so its target is ambiguous. Send one Host header.")
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})
OWN_SITES = frozenset({"same-origin", "none"})

CONTENT_SECURITY_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; font-src 'self'; "
    "connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'; manifest-src 'self'"
)
HEADERS = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "geolocation=(self), screen-wake-lock=(self), camera=(), microphone=(), usb=()",
}


HSTS = "max-age=31536000"
"""Sent with TLS alone: the browser then never opens this name without it."""


class SecurityHeaders:
    """Adds the headers to every answer, and `no-store` where the answer does not say otherwise."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass everything on, with headers added to what comes back."""

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                add_headers(MutableHeaders(scope=message), is_secure=scope["scheme"] == "https")
            await send(message)

        await self._app(scope, receive, send_with_headers if scope["type"] == "http" else send)


def add_headers(headers: MutableHeaders, *, is_secure: bool = False) -> None:
    """Add what every answer carries; with TLS also that nothing else shall be used from now on."""
    if is_secure:
        headers.setdefault("Strict-Transport-Security", HSTS)
    for name, value in HEADERS.items():
        headers.setdefault(name, value)
    headers.setdefault("Cache-Control", "no-store")


class Guard:
    """Turns away requests for foreign host names, and changes and WebSockets that foreign pages ask for."""

    def __init__(
        self,
        app: ASGIApp,
        hosts: frozenset[str] = LOOPBACK_NAMES,
        on_refusal: Callable[[Scope, str], None] | None = None,
    ) -> None:
        self._app = app
        self._hosts = hosts
        self._on_refusal = on_refusal

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer 403 with the sentence that says why."""
        if scope["type"] in ("http", "websocket") and _hosts_told(scope) > 1:
            await _refuse(scope, send, Problem(ProblemCode.HOST_REFUSED, TWO_HOSTS))
            return
        if scope["type"] in ("http", "websocket") and (refusal := self._refusal(scope)):
            if self._on_refusal is not None:
                self._on_refusal(scope, refusal)
            await _refuse(scope, send, Problem(ProblemCode.FOREIGN_REQUEST, plain(refusal)))
            return
        if scope["type"] == "http" and _body_size(scope) > largest_body(scope):
            await _refuse(scope, send, Problem(ProblemCode.TOO_LARGE, TOO_LARGE))
            return
        await self._app(scope, receive, send)

    def _refusal(self, scope: Scope) -> str | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        name = _host_name(host)
        if name not in self._hosts and not _is_own_address(name, scope):
            return N_(
                "Heliopanel does not answer to this host name. Open it by 127.0.0.1 or localhost, "
                "through an SSH tunnel if it runs on another computer, or by a name in "
                "HELIOPANEL_ALLOWED_HOSTS."
            )
        if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
            return None
        return _foreign(headers, host, is_secure=scope["scheme"] in ("https", "wss"))


class Uploads:
    """Lets larger bodies through to the addresses that take files."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._larger = RequestBodyLimitMiddleware(app, max_body_size=LARGEST_UPLOAD)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with the limit of its address."""
        app = self._larger if scope["type"] == "http" and UPLOADS.fullmatch(scope["path"]) else self._app
        await app(scope, receive, send)


def largest_body(scope: Scope) -> int:
    """Return how many bytes a request may bring."""
    return LARGEST_UPLOAD if UPLOADS.fullmatch(scope["path"]) else LARGEST_BODY


def _host_name(host: str) -> str | None:
    try:
        return urlsplit(f"//{host}").hostname
    except ValueError:
        return None


def host_names(settings: Settings) -> frozenset[str]:
    """Return the names by which this panel may be called; an address that it listens on is always right."""
    named = {name.lower() for name in settings.allowed_hosts}
    own = {"heliopanel.local"} if settings.mdns or not settings.is_loopback else set()
    return LOOPBACK_NAMES | named | own


def _is_own_address(name: str | None, scope: Scope) -> bool:
    """Return whether a host is the very address that was connected to: no foreign name can stand for that."""
    server = scope.get("server") or ("",)
    try:
        return ipaddress.ip_address(name or "") == ipaddress.ip_address(server[0])
    except ValueError:
        return False


def _foreign(headers: Headers, host: str, *, is_secure: bool) -> str | None:
    site, origin = headers.get("sec-fetch-site"), headers.get("origin")
    if site is not None and site not in OWN_SITES:
        return N_("Another website sent this request; it must come from a Heliopanel page.")
    if origin is not None and not _is_own_origin(origin, host, is_secure=is_secure):
        return say(
            "A page of {origin} sent this request; it must come from a Heliopanel page.", origin=origin
        )
    return None


def _is_own_origin(origin: str, host: str, *, is_secure: bool) -> bool:
    """Return whether a page of this panel asks; behind a proxy that ends TLS its pages are secure too."""
    try:
        parts = urlsplit(origin)
    except ValueError:
        return False
    return parts.netloc == host and parts.scheme in (("https",) if is_secure else ("http", "https"))


def _hosts_told(scope: Scope) -> int:
    return sum(name == b"host" for name, _ in scope["headers"])


def _body_size(scope: Scope) -> int:
    length = Headers(scope=scope).get("content-length", "")
    return int(length) if length.isdigit() else 0


async def _refuse(scope: Scope, send: Send, problem: Problem) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008, "reason": N_("foreign origin")})
        return
    body = problem.body()
    headers = [(b"content-type", MEDIA_TYPE.encode()), (b"content-length", str(len(body)).encode())]
    if problem.code is ProblemCode.TOO_LARGE:
        headers.append((b"connection", b"close"))
    await send({"type": "http.response.start", "status": problem.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
