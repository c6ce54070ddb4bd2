"""Signing in and out as HTTP has it: the cookie of a session."""

from starlette.requests import Request
from starlette.responses import Response

from app.access.sessions import ABSOLUTE
from app.web.deps import principal
from app.web.gate import cookie_name

KIOSK_AGE_S = 366 * 24 * 3600


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


def whence(request: Request) -> tuple[str, str]:
    """Return from which address and with which browser somebody asks."""
    return principal(request).address, request.headers.get("user-agent", "")
