"""Signing in and out as HTTP has it: the cookie of a session."""

from starlette.requests import Request
from starlette.responses import Response

from app.access.sessions import ABSOLUTE
from app.web.http.gate import cookie_name
from app.web.shell.deps import panel, principal

KIOSK_AGE_S = 366 * 24 * 3600
FIRST = "first_administrator"
FIRST_AGE_S = 300


def set_session(request: Request, response: Response, session_id: str, *, kiosk: bool = False) -> None:
    """Give the browser its session: no script sees it, no other site sends it."""
    age = KIOSK_AGE_S if kiosk else int(ABSOLUTE.total_seconds())
    secure = request.url.scheme == "https"
    response.set_cookie(
        cookie_name(request.scope),
        session_id,
        max_age=age,
        path="/",
        httponly=True,
        samesite="strict",
        secure=secure,
    )


def forget_session(request: Request, response: Response) -> None:
    """Take the session away from the browser, and what it has kept of the pages."""
    secure = request.url.scheme == "https"
    response.delete_cookie(
        cookie_name(request.scope), path="/", httponly=True, samesite="strict", secure=secure
    )
    response.headers["Clear-Site-Data"] = '"cache"'


def remember_first(request: Request, response: Response, name: str) -> None:
    """Let this browser's page to sign in say, for a while, that the first administrator was made."""
    response.set_cookie(
        FIRST,
        name.lower(),
        max_age=FIRST_AGE_S,
        path="/login",
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
    )


def forget_first(request: Request, response: Response) -> None:
    """Say no more that the first administrator was made."""
    if FIRST in request.cookies:
        response.delete_cookie(FIRST, path="/login")


def first_made(request: Request) -> str:
    """Return the first administrator's name if this browser has just made that user, otherwise nothing."""
    name = request.cookies.get(FIRST, "")
    return name if name in panel(request).keeper.book.users else ""


def whence(request: Request) -> tuple[str, str]:
    """Return from which address and with which browser somebody asks."""
    return principal(request).address, request.headers.get("user-agent", "")


def session_held(request: Request) -> str:
    """Return the session id that a browser still has from before, empty where it has none."""
    held: str = request.scope.get("state", {}).get("session_id", "")
    return held
