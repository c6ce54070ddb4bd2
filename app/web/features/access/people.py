"""Users and their sessions, for administrators."""

from collections.abc import Callable
from datetime import datetime
from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.access.roles import Role
from app.access.users import AccessRefused
from app.base.message import N_, say
from app.base.permission import Permission
from app.web.features.access.access_contexts import UsersPage
from app.web.features.access.sign_ins import remember_first
from app.web.http.errors import problem_of
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import CHECKED_ONLY
from app.web.shell.contexts import Field
from app.web.shell.deps import PanelDep, PrincipalDep, panel, principal
from app.web.shell.frame import site_frame
from app.web.shell.render import go, whole_page

router = page_router(prefix="/users")

Text = Annotated[str, Form(max_length=300)]
Roles = Annotated[list[Role] | None, Form(), CHECKED_ONLY]


@router.get("")
@needs(Permission.ADMINISTER)
def users(request: Request) -> Response:
    """Show all users and sessions."""
    return _answer(request)


@router.post("")
@needs(Permission.ADMINISTER, proven=True)
async def add(
    request: Request,
    built: PanelDep,
    who: PrincipalDep,
    name: Text = "",
    password: Text = "",
    role: Roles = None,
) -> Response:
    """Add a user; after the first one everybody signs in."""
    first = not built.keeper.book.users

    def work(now: datetime) -> None:
        built.keeper.accounts.add(who, name, role or [], password, now)

    return await _then(
        request, work, say("{name} is added.", name=name), typed=(name, frozenset(role or [])), first=first
    )


@router.post("/{name}/roles")
@needs(Permission.ADMINISTER, proven=True)
async def set_roles(
    request: Request, name: str, built: PanelDep, who: PrincipalDep, role: Roles = None
) -> Response:
    """Give a user other roles."""

    def work(now: datetime) -> None:
        built.keeper.accounts.set_roles(who, name, role or [], now)

    return await _then(request, work, say("The roles of {name} are changed.", name=name))


@router.post("/{name}/password")
@needs(Permission.ADMINISTER, proven=True)
async def set_password(
    request: Request, name: str, built: PanelDep, who: PrincipalDep, password: Text = ""
) -> Response:
    """Give a user another password and end all sessions of theirs."""

    def work(now: datetime) -> None:
        keep = who.credential if name == who.name else ""
        built.keeper.accounts.set_password(who, name, password, now, keep=keep)

    return await _then(
        request, work, say("The password of {name} is changed; all sessions have ended.", name=name)
    )


@router.post("/{name}/remove")
@needs(Permission.ADMINISTER, proven=True)
async def remove(request: Request, name: str, built: PanelDep, who: PrincipalDep) -> Response:
    """Remove a user with all sessions and tokens."""

    def work(now: datetime) -> None:
        built.keeper.accounts.remove(who, name, now)

    return await _then(request, work, say("{name} is removed, with all sessions and tokens.", name=name))


@router.post("/sessions/{digest}/end")
@needs(Permission.ADMINISTER)
async def end_session(request: Request, digest: str, built: PanelDep, who: PrincipalDep) -> Response:
    """End a session; what it opened ends within a second."""

    def work(now: datetime) -> None:
        built.keeper.accounts.end_session(who, digest, now)

    return await _then(request, work, N_("The session has ended."))


async def _then(
    request: Request,
    work: Callable[[datetime], None],
    done: str,
    typed: tuple[str, frozenset[str]] = ("", frozenset()),
    *,
    first: bool = False,
) -> Response:
    built = panel(request)
    try:
        await built.keeper.do(lambda: work(built.clock.system_time()))
    except AccessRefused as error:
        return _answer(request, typed, error=error)
    if not first:
        return _answer(request, done=done)
    response = go(request, "/login")
    remember_first(request, response, typed[0])
    return response


def _answer(
    request: Request,
    typed: tuple[str, frozenset[str]] = ("", frozenset()),
    *,
    error: Exception | None = None,
    done: str = "",
) -> Response:
    built, problem = panel(request), problem_of(error) if error else None
    book = built.keeper.book
    context = UsersPage(
        frame=site_frame(request, N_("Users")),
        users=tuple(sorted(book.users.values(), key=lambda one: one.name)),
        sessions=tuple(sorted(built.keeper.sessions(), key=lambda one: one.used_at, reverse=True)),
        form={"name": Field("name", typed[0]), "password": Field("password", "")},
        chosen=typed[1] or frozenset({Role.ADMINISTRATOR if not book.users else Role.OPERATOR}),
        problem=problem.detail if problem else "",
        done=done,
        mine=principal(request).credential,
    )
    return whole_page(request, context, status=problem.status if problem else 200)
