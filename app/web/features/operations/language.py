"""The language of the pages: chosen from a list in the header, kept in a cookie."""

from typing import Annotated

from fastapi import Form
from starlette.responses import RedirectResponse, Response

from app.base.message import N_
from app.base.permission import Permission
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.paths import own_path
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.languages.catalogue import offered
from app.web.languages.choice import COOKIE
from app.web.shell.theme import A_YEAR_S

router = page_router()
Text = Annotated[str, Form(), MAY_BE_ABSENT]
UNKNOWN_LANGUAGE = N_(
    "Heliopanel does not support this language. Choose a language from the list at the top of a page."
)


@router.post("/language")
@needs(Permission.OPEN)
def choose_language(language: Text = "", back: Text = "/") -> Response:
    """Keep the language for a year and return to the page."""
    if language not in {one.code for one in offered()}:
        raise NotAcceptable(UNKNOWN_LANGUAGE)
    response = RedirectResponse(own_path(back), 303)
    response.set_cookie(COOKIE, language, max_age=A_YEAR_S, samesite="lax")
    return response
