"""API tokens and the tokens of cabinets' panels, for administrators."""

from datetime import timedelta
from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.access.accounts import TokenWish
from app.access.tokens import Scope
from app.access.users import AccessRefused
from app.base.message import N_
from app.base.permission import Permission
from app.web.features.access.access_contexts import TokensPage
from app.web.http.errors import problem_of
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import CHECKED_ONLY
from app.web.shell.deps import PanelDep, PrincipalDep, panel
from app.web.shell.forms import Typed
from app.web.shell.frame import site_frame
from app.web.shell.render import whole_page

router = page_router(prefix="/tokens")
FIELDS = ("name", "trackers", "days", "pin")
EMPTY = {"name": "", "trackers": "", "days": "90", "pin": ""}


class TokenForm(BaseModel):
    """A new token as it was typed."""

    name: str = ""
    trackers: str = ""
    days: str = ""
    pin: str = ""
    scope: Annotated[list[Scope], CHECKED_ONLY] = []


@router.get("")
@needs(Permission.ADMINISTER)
def tokens(request: Request) -> Response:
    """Show all tokens."""
    return _answer(request, Typed(EMPTY), frozenset({Scope.READ}))


@router.post("")
@needs(Permission.ADMINISTER, proven=True)
async def mint(
    request: Request, built: PanelDep, who: PrincipalDep, typed: Annotated[TokenForm, Form()]
) -> Response:
    """Make a token and show it, once."""
    found, scopes = Typed(typed.model_dump(include=set(FIELDS))), frozenset(typed.scope)
    days = found.whole("days", N_("Days"), 1, 366)
    if found.errors:
        return _answer(request, found, scopes, status=422)
    trackers = frozenset(typed.trackers.replace(",", " ").split()) or None
    wish = TokenWish(typed.name, scopes, trackers, timedelta(days=days), typed.pin.strip())
    try:
        text = await built.keeper.do(lambda: built.keeper.accounts.mint(who, wish, built.clock.system_time()))
    except AccessRefused as error:
        return _answer(request, found, scopes, problem=problem_of(error).detail, status=422)
    return _answer(request, Typed(EMPTY), frozenset({Scope.READ}), made=text)


@router.post("/{token_id}/revoke")
@needs(Permission.ADMINISTER)
async def revoke(request: Request, token_id: str, built: PanelDep, who: PrincipalDep) -> Response:
    """Revoke a token; what it opened ends within a second."""
    await built.keeper.do(lambda: built.keeper.accounts.revoke(who, token_id, built.clock.system_time()))
    return _answer(request, Typed(EMPTY), frozenset({Scope.READ}))


def _answer(
    request: Request,
    typed: Typed,
    chosen: frozenset[Scope],
    *,
    problem: str = "",
    made: str = "",
    status: int = 200,
) -> Response:
    built = panel(request)
    context = TokensPage(
        frame=site_frame(request, N_("Tokens")),
        tokens=tuple(sorted(built.keeper.book.tokens.values(), key=lambda one: one.created_at)),
        form=typed.form(FIELDS),
        chosen=frozenset(scope.value for scope in chosen),
        problem=problem,
        made=made,
        now=built.clock.system_time(),
    )
    return whole_page(request, context, status=status)
