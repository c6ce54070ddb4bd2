"""Day, sun and night: the next theme at one tap, kept in a cookie."""

from typing import Annotated

from fastapi import APIRouter, Form
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.web.ui.frame import THEMES
from app.web.ui.paths import own_path

router = APIRouter()
A_YEAR_S = 31_536_000


@router.post("/theme")
def next_theme(request: Request, back: Annotated[str, Form()] = "/") -> Response:
    """Switch to the next theme and return to the page."""
    now = request.cookies.get("theme", THEMES[0])
    at = THEMES.index(now) if now in THEMES else 0
    response = RedirectResponse(own_path(back), 303)
    response.set_cookie("theme", THEMES[(at + 1) % len(THEMES)], max_age=A_YEAR_S, samesite="lax")
    return response
