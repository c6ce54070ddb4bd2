"""Signing in and out, the password again, the first administrator, and a cabinet's panel."""

from collections.abc import Awaitable
from typing import Annotated

from fastapi import Form, Query
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.access.sign_in_errors import Throttled, TooManyAtOnce, WrongPassword
from app.access.users import AccessRefused
from app.base.message import N_
from app.base.permission import Permission
from app.web.features.access.access_contexts import SignInPage
from app.web.features.access.sign_ins import (
    first_made,
    forget_first,
    forget_session,
    remember_first,
    session_held,
    set_session,
    whence,
)
from app.web.http.errors import problem_of
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.paths import own_path
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.contexts import Field
from app.web.shell.deps import PanelDep, PrincipalDep, panel
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router()

TITLES = {
    "login": N_("Sign in"),
    "prove": N_("Confirm your password"),
    "setup": N_("First administrator"),
    "kiosk": N_("Bind this cabinet display"),
}
BEFORE = ("login", "kiosk")
"""Forms before which nobody is known: these show the notice of use."""

REFUSALS = (WrongPassword, Throttled, TooManyAtOnce, AccessRefused)
Secret = Annotated[str, Form(max_length=300), MAY_BE_ABSENT]
Text = Annotated[str, Form(max_length=300), MAY_BE_ABSENT]
Back = Annotated[str, Query(max_length=300)]


@router.get("/login")
@needs(Permission.OPEN)
def login_form(request: Request, built: PanelDep, back: Back = "/") -> Response:
    """Show the form to sign in; where there are no users there is nothing to sign in to."""
    if not built.keeper.book.users:
        return RedirectResponse("/", 303)
    return _form(request, "login", {"name": ""}, back)


@router.post("/login")
@needs(Permission.OPEN)
async def login(
    request: Request,
    built: PanelDep,
    who: PrincipalDep,
    name: Text = "",
    password: Secret = "",
    back: Text = "/",
) -> Response:
    """Begin a session; one that this browser had before ends."""
    try:
        session_id = await built.keeper.log_in(name, password, *whence(request), session_held(request))
    except REFUSALS as error:
        return _form(request, "login", {"name": name}, back, error)
    await built.keeper.log_out(who)
    response = RedirectResponse(own_path(back), 303)
    set_session(request, response, session_id)
    forget_first(request, response)
    return response


@router.post("/logout")
@needs(Permission.OWN)
async def logout(request: Request, built: PanelDep, who: PrincipalDep) -> Response:
    """End the session."""
    await built.keeper.log_out(who)
    response = RedirectResponse("/login", 303)
    forget_session(request, response)
    return response


@router.get("/prove")
@needs(Permission.OWN)
def proof_form(request: Request, back: Back = "/") -> Response:
    """Ask for the password again."""
    return _form(request, "prove", {}, back)


@router.post("/prove")
@needs(Permission.OWN)
async def prove(
    request: Request, built: PanelDep, who: PrincipalDep, password: Secret = "", back: Text = "/"
) -> Response:
    """Open settings of weight for 5 minutes, and end a rest."""
    return await _then(request, "prove", built.keeper.prove(who, password), back)


@router.get("/setup")
@needs(Permission.OPEN)
def setup_form(request: Request, built: PanelDep) -> Response:
    """Ask for the one-time code and the first administrator, where there is none."""
    if not built.keeper.is_closed:
        return RedirectResponse("/", 303)
    return _form(request, "setup", {"code": "", "name": ""}, "/")


@router.post("/setup")
@needs(Permission.OPEN)
async def setup(
    request: Request, built: PanelDep, code: Text = "", name: Text = "", password: Secret = ""
) -> Response:
    """Make the first administrator."""
    if not built.keeper.is_closed:
        return RedirectResponse("/", 303)
    work = built.keeper.set_up(code, name, password, whence(request)[0])
    response = await _then(request, "setup", work, "/login", {"code": code, "name": name})
    if not built.keeper.is_closed:
        remember_first(request, response, name)
    return response


@router.get("/kiosk")
@needs(Permission.OPEN)
def kiosk_form(request: Request) -> Response:
    """Ask for the token of a cabinet's panel."""
    return _form(request, "kiosk", {}, "/")


@router.post("/kiosk")
@needs(Permission.OPEN)
async def kiosk(request: Request, built: PanelDep, token: Secret = "") -> Response:
    """Bind this browser to a cabinet's token: it views and stops for as long as the token lives."""
    try:
        session_id = await built.keeper.log_in_kiosk(token, *whence(request))
    except REFUSALS as error:
        return _form(request, "kiosk", {}, "/", error)
    response = RedirectResponse("/", 303)
    set_session(request, response, session_id, kiosk=True)
    return response


async def _then(
    request: Request, purpose: str, work: Awaitable[None], back: str, typed: dict[str, str] | None = None
) -> Response:
    """Do what a form asks for and go on, or show the form again with what is wrong."""
    try:
        await work
    except REFUSALS as error:
        return _form(request, purpose, typed or {}, back, error)
    return RedirectResponse(own_path(back), 303)


def _form(
    request: Request, purpose: str, typed: dict[str, str], back: str, error: Exception | None = None
) -> Response:
    problem = problem_of(error) if error else None
    context = SignInPage(
        frame=site_frame(request, TITLES[purpose]),
        purpose=purpose,
        form={name: Field(name, text) for name, text in typed.items()},
        back=own_path(back),
        problem=_words(request, problem.detail) if problem else "",
        notice=panel(request).settings.login_banner if purpose in BEFORE else "",
        made=first_made(request) if purpose == "login" else "",
    )
    response = page(request, context, status=problem.status if problem else 200)
    response.headers.update(problem.headers if problem else {})
    return response


def _words(request: Request, detail: str) -> str:
    """Return what is wrong; on this form of the set-up it is the code, not a name, that does not fit."""
    closed = panel(request).keeper.is_closed and request.url.path == "/setup"
    return (
        detail.replace(N_("The name or the password is wrong."), N_("The one-time code is wrong."))
        if closed
        else detail
    )
