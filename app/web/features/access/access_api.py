"""Who asks, their session, and tickets for what cannot send a header."""

from datetime import datetime

from pydantic import Field, SecretStr
from starlette.requests import Request
from starlette.responses import Response

from app.access.principal import NotAllowed, Via
from app.access.roles import Role
from app.base.message import N_
from app.base.permission import Permission
from app.web.api.base import TOO_MANY, Input, Output, Page, api_router, whole
from app.web.features.access.sign_ins import forget_session, session_held, set_session, whence
from app.web.features.access.users_api import SignedIn
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep, PrincipalDep

router = api_router(tags=["access"])


class SignIn(Input):
    """A name and its password."""

    name: str = Field(min_length=1, max_length=64, examples=["anna"])
    password: SecretStr = Field(min_length=1, max_length=300)


class Proof(Input):
    """The password, once more."""

    password: SecretStr = Field(min_length=1, max_length=300)


class NewPassword(Input):
    """The present password and the new one."""

    old: SecretStr = Field(min_length=1, max_length=300)
    new: SecretStr = Field(min_length=1, max_length=300, description="12 to 128 characters.")


class Myself(Output):
    """Who asks and what they may do."""

    name: str
    roles: tuple[Role, ...] = Field(description="Roles of a person; a token has none.")
    permissions: tuple[Permission, ...]
    via: Via = Field(description="How it was proven who asks.")
    trackers: tuple[str, ...] | None = Field(description="The only trackers that a token reaches; null: all.")
    proven_at: datetime | None = Field(description="When the password was typed last.")
    csrf_token: str | None = Field(description="What a session sends as X-CSRF-Token with every change.")


class Ticket(Output):
    """A one-time ticket."""

    ticket: str = Field(description="Give it as `?ticket=` of a stream or a download, once, within 5 s.")


@router.get("/me", summary="Who asks")
@needs(Permission.KNOWN)
async def read_me(request: Request, built: PanelDep, who: PrincipalDep) -> Myself:
    """Return who asks, how that was proven, and what they may do."""
    session_id = request.scope["state"]["session_id"]
    return Myself(
        name=who.name,
        roles=tuple(sorted(who.roles)),
        permissions=tuple(sorted(who.permissions)),
        via=who.via,
        trackers=None if who.trackers is None else tuple(sorted(who.trackers)),
        proven_at=who.proven_at and built.clock.system_time(who.proven_at),
        csrf_token=built.keeper.csrf(session_id) if who.via in (Via.SESSION, Via.KIOSK) else None,
    )


@router.get("/me/sessions", summary="Own sessions")
@needs(Permission.OWN)
async def list_own_sessions(built: PanelDep, who: PrincipalDep) -> Page[SignedIn]:
    """Return where who asks is signed in, the newest first; a program is signed in nowhere."""
    return whole(SignedIn.of(session) for session in built.keeper.own_sessions(who))


@router.post("/session", status_code=204, summary="Sign in", responses=TOO_MANY)
@needs(Permission.OPEN)
async def sign_in(request: Request, typed: SignIn, built: PanelDep) -> Response:
    """Begin a session, whose cookie comes back; wrong passwords make the next try wait, up to 30 s."""
    password, held = typed.password.get_secret_value(), session_held(request)
    session_id = await built.keeper.log_in(typed.name, password, *whence(request), held)
    response = Response(status_code=204)
    set_session(request, response, session_id)
    return response


@router.delete("/session", status_code=204, summary="Sign out")
@needs(Permission.OWN)
async def sign_out(request: Request, built: PanelDep, who: PrincipalDep) -> Response:
    """End the session."""
    await built.keeper.log_out(who)
    response = Response(status_code=204)
    forget_session(request, response)
    return response


@router.post("/session/reauthentication", status_code=204, summary="Password again", responses=TOO_MANY)
@needs(Permission.OWN)
async def confirm_password(typed: Proof, built: PanelDep, who: PrincipalDep) -> None:
    """Open what needs a fresh password for 5 minutes: users, tokens, drives, backups."""
    await built.keeper.prove(who, typed.password.get_secret_value())


@router.put("/me/password", status_code=204, summary="Change the own password", responses=TOO_MANY)
@needs(Permission.OWN)
async def change_password(typed: NewPassword, built: PanelDep, who: PrincipalDep) -> None:
    """Change the password of who asks; all other sessions of theirs end."""
    if who.via is not Via.SESSION:
        raise NotAllowed(N_("Only a signed-in user has a password to change."))
    await built.keeper.change_own_password(who, typed.old.get_secret_value(), typed.new.get_secret_value())


@router.post("/tickets", status_code=201, summary="Make a ticket")
@needs(Permission.READ)
async def create_ticket(built: PanelDep, who: PrincipalDep) -> Ticket:
    """Return a ticket that opens one stream or download as who asks, once, within 5 s."""
    return Ticket(ticket=built.keeper.ticket(who))
