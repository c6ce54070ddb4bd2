"""Who is signed in: own password, own sessions, the PIN of a cabinet's panel."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.access.principal import NotAllowed, Via
from app.access.sign_in_errors import Throttled, TooManyAtOnce, WrongPassword
from app.access.users import AccessRefused
from app.base.message import N_
from app.base.permission import Permission
from app.web.features.access.access_contexts import AccountPage
from app.web.http.errors import problem_of
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Field
from app.web.shell.deps import PanelDep, PrincipalDep, panel, principal
from app.web.shell.frame import site_frame
from app.web.shell.render import whole_page

router = page_router()

Secret = Annotated[str, Form(max_length=300)]
REFUSALS = (WrongPassword, Throttled, TooManyAtOnce, AccessRefused)


@router.get("/account")
@needs(Permission.OWN)
def account(request: Request) -> Response:
    """Show who is signed in."""
    return _answer(request)


@router.post("/account/password")
@needs(Permission.OWN)
async def change_password(
    request: Request, built: PanelDep, who: PrincipalDep, old: Secret = "", new: Secret = ""
) -> Response:
    """Change one's own password, which takes the old one; all other sessions of this user end."""
    if who.via is not Via.SESSION:
        raise NotAllowed(N_("Only a signed-in user has a password to change."))
    try:
        await built.keeper.change_own_password(who, old, new)
    except REFUSALS as error:
        return _answer(request, error=error)
    return _answer(request, done=N_("Password changed. All your other sessions have ended."))


@router.post("/account/sessions/{digest}/end")
@needs(Permission.OWN)
async def end_session(request: Request, digest: str, built: PanelDep, who: PrincipalDep) -> Response:
    """End one of one's own sessions."""
    await built.keeper.end_own_session(who, digest)
    return _answer(request, done=N_("The session has ended."))


@router.post("/kiosk/pin")
@needs(Permission.OWN)
async def step_up(request: Request, built: PanelDep, who: PrincipalDep, pin: Secret = "") -> Response:
    """Let a cabinet's panel operate for 5 minutes."""
    try:
        await built.keeper.step_up(who, pin)
    except WrongPassword:
        return _answer(request, error=WrongPassword(N_("The PIN is wrong.")))
    except REFUSALS as error:
        return _answer(request, error=error)
    return RedirectResponse("/", 303)


def _answer(request: Request, *, error: Exception | None = None, done: str = "") -> Response:
    built, who = panel(request), principal(request)
    problem = problem_of(error) if error else None
    context = AccountPage(
        frame=site_frame(request, N_("Account")),
        form={name: Field(name, "") for name in ("old", "new", "pin")},
        problem=problem.detail if problem else "",
        done=done,
        sessions=built.keeper.own_sessions(who),
        mine=who.credential,
        now=built.clock.system_time(),
    )
    return whole_page(request, context, status=problem.status if problem else 200)
