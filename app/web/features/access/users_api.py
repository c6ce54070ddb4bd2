"""Users, sessions and tokens, for administrators."""

from datetime import datetime, timedelta
from typing import Annotated, Self

from fastapi import Path
from pydantic import Field, SecretStr

from app.access.accounts import TokenWish
from app.access.roles import Role
from app.access.sessions import Session
from app.access.tokens import Scope, Token, token_id_of
from app.access.users import User
from app.base.message import N_, say
from app.base.permission import Permission
from app.web.api.base import NOT_FOUND, Clean, Input, Output, Page, api_router, whole
from app.web.http.errors import NotFound
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep, PrincipalDep

router = api_router(tags=["access"])

UserName = Annotated[str, Path(min_length=1, max_length=64, description="Name of the user.")]
Digest = Annotated[str, Path(min_length=1, max_length=64, description="Digest of the session.")]
TokenId = Annotated[str, Path(min_length=1, max_length=16, description="Id of the token.")]


class NewUser(Input):
    """A user to be added."""

    name: str = Field(min_length=1, max_length=64, examples=["anna"])
    roles: tuple[Role, ...] = Field(min_length=1)
    password: SecretStr = Field(min_length=1, max_length=300, description="12 to 128 characters.")


class UserChange(Input):
    """What to change; what is not given stays."""

    roles: tuple[Role, ...] | None = None
    password: SecretStr | None = Field(None, min_length=1, max_length=300)


class Person(Output):
    """A user, without what nobody may read."""

    name: str
    roles: tuple[Role, ...]
    created_at: datetime
    changed_at: datetime


class SignedIn(Output):
    """A session."""

    digest: str = Field(description="Names the session; it opens nothing.")
    user: str = Field(description="Empty for a cabinet's panel.")
    token_id: str
    address: str
    agent: str
    began_at: datetime
    used_at: datetime

    @classmethod
    def of(cls, one: Session) -> Self:
        """Return a session without what opens it."""
        return cls(
            digest=one.digest,
            user=one.user,
            token_id=one.token_id,
            address=one.address,
            agent=one.agent,
            began_at=one.began_at,
            used_at=one.used_at,
        )


class NewToken(Input):
    """A token to be made."""

    name: Annotated[str, Clean] = Field(min_length=1, max_length=64, examples=["SCADA of the plant"])
    scopes: tuple[Scope, ...] = ()
    trackers: tuple[Annotated[str, Field(min_length=1, max_length=64)], ...] | None = None
    days: int = Field(90, ge=1, le=366, description="How long it is good for.")
    pin: SecretStr | None = Field(None, description="6 to 12 digits: the token binds a cabinet's panel.")


class Listed(Output):
    """A token, without its secret."""

    token_id: str
    name: str
    owner: str
    scopes: tuple[Scope, ...]
    trackers: tuple[str, ...] | None
    created_at: datetime
    expires_at: datetime
    kiosk: bool


class Minted(Output):
    """A new token, shown this once."""

    token_id: str = Field(description="By this it is listed and revoked.")
    token: str = Field(description="Send it as `Authorization: Bearer`; it is not kept.")


@router.get("/users", summary="All users")
@needs(Permission.ADMINISTER)
async def list_users(built: PanelDep) -> Page[Person]:
    """Return every user with roles."""
    return whole(_person(user) for user in built.keeper.book.users.values())


@router.post("/users", status_code=201, summary="Add a user")
@needs(Permission.ADMINISTER, proven=True)
async def add_user(typed: NewUser, built: PanelDep, who: PrincipalDep) -> Person:
    """Add a user; the first one must be an administrator, and from then on everybody signs in."""
    now, password = built.clock.system_time(), typed.password.get_secret_value()
    user = await built.keeper.do(
        lambda: built.keeper.accounts.add(who, typed.name, typed.roles, password, now)
    )
    return _person(user)


@router.patch("/users/{name}", summary="Change a user", responses=NOT_FOUND)
@needs(Permission.ADMINISTER, proven=True)
async def change_user(name: UserName, typed: UserChange, built: PanelDep, who: PrincipalDep) -> Person:
    """Give a user other roles or another password, which ends their sessions."""
    _known(built, name)
    now, accounts = built.clock.system_time(), built.keeper.accounts
    roles, secret = typed.roles, typed.password
    if roles is not None:
        await built.keeper.do(lambda: accounts.set_roles(who, name, roles, now))
    if secret is not None:
        await built.keeper.do(lambda: accounts.set_password(who, name, secret.get_secret_value(), now))
    return _person(_known(built, name))


@router.delete("/users/{name}", status_code=204, summary="Remove a user", responses=NOT_FOUND)
@needs(Permission.ADMINISTER, proven=True)
async def remove_user(name: UserName, built: PanelDep, who: PrincipalDep) -> None:
    """Remove a user with all sessions and tokens; one administrator always stays."""
    _known(built, name)
    await built.keeper.do(lambda: built.keeper.accounts.remove(who, name, built.clock.system_time()))


@router.get("/sessions", summary="All sessions")
@needs(Permission.ADMINISTER)
async def list_sessions(built: PanelDep) -> Page[SignedIn]:
    """Return who is signed in, from where, and since when."""
    return whole(SignedIn.of(session) for session in built.keeper.sessions())


@router.delete("/sessions/{digest}", status_code=204, summary="End a session", responses=NOT_FOUND)
@needs(Permission.ADMINISTER)
async def end_session(digest: Digest, built: PanelDep, who: PrincipalDep) -> None:
    """End a session; what it opened ends within a second."""
    if digest not in built.keeper.book.sessions:
        raise NotFound(N_("There is no such session; it may have ended."))
    await built.keeper.do(lambda: built.keeper.accounts.end_session(who, digest, built.clock.system_time()))


@router.get("/tokens", summary="All tokens")
@needs(Permission.ADMINISTER)
async def list_tokens(built: PanelDep) -> Page[Listed]:
    """Return every token without its secret."""
    return whole(_listed(token) for token in built.keeper.book.tokens.values())


@router.post("/tokens", status_code=201, summary="Create a token")
@needs(Permission.ADMINISTER, proven=True)
async def create_token(typed: NewToken, built: PanelDep, who: PrincipalDep) -> Minted:
    """Make a token; its text comes back this once."""
    wish = TokenWish(
        typed.name,
        frozenset(typed.scopes),
        frozenset(typed.trackers) if typed.trackers else None,
        timedelta(days=typed.days),
        typed.pin.get_secret_value() if typed.pin else "",
    )
    now = built.clock.system_time()
    token = await built.keeper.do(lambda: built.keeper.accounts.mint(who, wish, now))
    return Minted(token_id=token_id_of(token) or "", token=token)


@router.delete("/tokens/{token_id}", status_code=204, summary="Revoke a token", responses=NOT_FOUND)
@needs(Permission.ADMINISTER)
async def revoke_token(token_id: TokenId, built: PanelDep, who: PrincipalDep) -> None:
    """Revoke a token; what it opened ends within a second."""
    if token_id not in built.keeper.book.tokens:
        raise NotFound(N_("There is no such token; it may have been revoked."))
    await built.keeper.do(lambda: built.keeper.accounts.revoke(who, token_id, built.clock.system_time()))


def _known(built: PanelDep, name: str) -> User:
    if (user := built.keeper.book.users.get(name.lower())) is None:
        raise NotFound(say("There is no user {name}.", name=name))
    return user


def _person(user: User) -> Person:
    return Person(
        name=user.name,
        roles=tuple(sorted(user.roles)),
        created_at=user.created_at,
        changed_at=user.changed_at,
    )


def _listed(token: Token) -> Listed:
    return Listed(
        token_id=token.token_id,
        name=token.name,
        owner=token.owner,
        scopes=tuple(sorted(token.scopes)),
        trackers=None if token.trackers is None else tuple(sorted(token.trackers)),
        created_at=token.created_at,
        expires_at=token.expires_at,
        kiosk=token.is_kiosk,
    )
