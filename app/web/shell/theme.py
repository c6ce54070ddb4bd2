"""Day, sun, night or by the sun: the next theme at one tap, kept in a cookie."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.base.permission import Permission
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.paths import own_path
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.themes import CHOICES, choice_of

router = page_router()
A_YEAR_S = 31_536_000


@router.post("/theme")
@needs(Permission.OPEN)
def next_theme(request: Request, back: Annotated[str, Form(), MAY_BE_ABSENT] = "/") -> Response:
    """Switch to the next theme and return to the page."""
    at = CHOICES.index(choice_of(request.cookies.get("theme")))
    response = RedirectResponse(own_path(back), 303)
    response.set_cookie("theme", CHOICES[(at + 1) % len(CHOICES)], max_age=A_YEAR_S, samesite="lax")
    return response
