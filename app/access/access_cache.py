"""Everything about access as it was read last: one immutable value that a request is judged by."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime

from app.access.principal import Principal, Via
from app.access.roles import NOBODY, Role, permissions_of
from app.access.sessions import Session, SessionState, is_stepped_up, state
from app.access.tokens import Token, is_valid, token_id_of
from app.access.tokens import permissions_of as permissions_of_scopes
from app.access.users import User
from app.base.permission import Permission

RESTING = frozenset({Permission.OPEN, Permission.KNOWN, Permission.READ, Permission.STOP, Permission.OWN})
MISDATED = NOBODY | {Permission.STOP}


@dataclass(frozen=True, slots=True)
class Book:
    """Users by name, sessions by digest, tokens by id; `changes` grows with everything written."""

    key: bytes
    users: Mapping[str, User] = field(default_factory=dict)
    sessions: Mapping[str, Session] = field(default_factory=dict)
    tokens: Mapping[str, Token] = field(default_factory=dict)
    changes: int = 0

    @property
    def has_administrator(self) -> bool:
        """Return whether somebody may manage users."""
        return any(user.is_administrator for user in self.users.values())

    def by_session(self, digest: str, now: datetime, shown: datetime, address: str) -> Principal | None:
        """Return who a session stands for, None if it is unknown or has ended.

        Spans count by the steady clock (`now`), tokens expire by what the system's clock shows.
        """
        session = self.sessions.get(digest)
        if session is None or state(session, now) is SessionState.ENDED:
            return None
        if session.is_kiosk:
            return self._kiosk(session, now, shown, address)
        user = self.users.get(session.user)
        return None if user is None else _person(user, session, now, address)

    def by_token(self, text: str, shown: datetime, address: str) -> Principal | None:
        """Return the program that a token stands for; a cabinet's token is good for its own page only.

        One made in the future does no more than stop: how long it may still be used cannot be known.
        """
        token = self.tokens.get(token_id_of(text) or "")
        if token is None or token.is_kiosk or not is_valid(token, text, shown):
            return None
        return self._program(token, shown, address)

    def still(self, principal: Principal, now: datetime, shown: datetime) -> bool:
        """Return whether somebody who was let in may stay; what they may do is judged anew each time."""
        match principal.via:
            case Via.SESSION | Via.KIOSK:
                return self.by_session(principal.credential, now, shown, principal.address) is not None
            case Via.TOKEN:
                token = self.tokens.get(principal.credential)
                return token is not None and shown < token.expires_at
            case Via.LOOPBACK:
                return not self.users
            case _:
                return True

    def _program(self, token: Token, shown: datetime, address: str) -> Principal:
        allowed, misdated = permissions_of_scopes(token.scopes), token.is_misdated(shown)
        return Principal(
            token.name,
            frozenset(),
            allowed & MISDATED if misdated else allowed,
            Via.TOKEN,
            address,
            token.token_id,
            token.trackers,
            misdated=misdated,
        )

    def _kiosk(self, session: Session, now: datetime, shown: datetime, address: str) -> Principal | None:
        token = self.tokens.get(session.token_id)
        if token is None or shown >= token.expires_at or token.is_misdated(shown):
            return None
        roles = frozenset({Role.OPERATOR if is_stepped_up(session, now) else Role.VIEWER})
        allowed = permissions_of(roles)
        return Principal(token.name, roles, allowed, Via.KIOSK, address, session.digest, token.trackers)


def _person(user: User, session: Session, now: datetime, address: str) -> Principal:
    rests = state(session, now) is SessionState.IDLE
    allowed = permissions_of(user.roles)
    return Principal(
        user.name,
        user.roles,
        allowed & RESTING if rests else allowed,
        Via.SESSION,
        address,
        session.digest,
        proven_at=session.proven_at,
        rests=rests,
    )
