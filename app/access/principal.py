"""Who is asking: one value for people, programs, cabinets' panels and bare stop tickets."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from app.access.roles import DOES, NOBODY, RANKS, Role, permissions_of, who_may
from app.base.message import N_, Message, Word, join, say
from app.base.permission import Permission
from app.tracker.values.order_spec import OrderSpec


class Via(StrEnum):
    """How somebody proved who they are."""

    NOBODY = "nobody"
    LOOPBACK = "loopback"
    SESSION = "session"
    TOKEN = "token"  # noqa: S105 - a kind of credential, not one
    KIOSK = "kiosk"
    STOP_TICKET = "stop_ticket"


class NotAllowed(Exception):
    """Who asks is known and may not do this; the text says who may."""


class SignInNeeded(Exception):
    """Nobody has signed in, or what they signed in with has ended; the text says what to do."""


class ProofNeeded(Exception):
    """The password is to be typed again; the text says why."""


@dataclass(frozen=True, slots=True)
class Principal:
    """Who asks, with what right, and from where.

    `trackers` limits a token to some trackers (None: all). `credential` names the session (its digest) or the
    token (its id) so that it can be seen to end. `proven_at` is when the password was typed last. `misdated`
    says that the token was made in the future.
    """

    name: str
    roles: frozenset[Role]
    permissions: frozenset[Permission]
    via: Via
    address: str
    credential: str = ""
    trackers: frozenset[str] | None = None
    proven_at: datetime | None = None
    rests: bool = False
    misdated: bool = False

    @property
    def actor(self) -> str:
        """Return the name for journals; programs and tickets are told apart from people."""
        match self.via:
            case Via.TOKEN:
                return say("{name} (token)", name=self.name)
            case Via.KIOSK:
                return say("{name} (kiosk)", name=self.name)
            case Via.STOP_TICKET:
                return say("{name} (stop ticket)", name=self.name)
            case _:
                return self.name

    @property
    def rank(self) -> int:
        """Return whose word counts more at a tracker: 2 engineer, 1 operator, 0 all others."""
        return max((RANKS[role] for role in self.roles), default=0)

    @property
    def is_known(self) -> bool:
        """Return whether somebody stands behind this."""
        return self.via not in (Via.NOBODY, Via.STOP_TICKET)

    def may(self, permission: Permission, tracker_id: str | None = None) -> bool:
        """Return whether this is allowed, at one tracker where one is named; to stop is, at every tracker."""
        within = (
            permission is Permission.STOP
            or self.trackers is None
            or tracker_id is None
            or tracker_id in self.trackers
        )
        return permission in self.permissions and within

    def may_order(self, order: OrderSpec, tracker_id: str | None = None) -> bool:
        """Return whether such an order is allowed.

        What concerns the whole site is not allowed to a token that is limited to some trackers; Stop is.
        """
        everywhere = tracker_id is None and self.trackers is not None and order.needs is not Permission.STOP
        return self.may(order.needs, tracker_id) and not everywhere

    def require(self, permission: Permission, tracker_id: str | None = None) -> None:
        """Raise the error that says why this is not allowed, if it is not."""
        if self.may(permission, tracker_id):
            return
        if not self.is_known:
            raise SignInNeeded(N_("Sign in first: Heliopanel shows and moves nothing for unknown users."))
        if self.rests and permission in permissions_of(self.roles):
            raise ProofNeeded(N_("There was no activity for 30 minutes. Enter your password to continue."))
        if self.misdated:
            raise SignInNeeded(
                N_("This token is dated in the future. Correct the system clock, or create a new token.")
            )
        raise NotAllowed(self.refusal(permission, tracker_id))

    def require_order(self, kind: str, order: OrderSpec, tracker_id: str | None = None) -> None:
        """Raise the error that says why an order is not allowed, if it is not; it names its kind."""
        if not self.may_order(order, tracker_id):
            self.require(order.needs, tracker_id)
            raise NotAllowed(say("{name} may not send the command {kind} here.", name=self.name, kind=kind))

    def refusal(self, permission: Permission, tracker_id: str | None = None) -> Message:
        """Return the sentence that says why this is not allowed and who may do it."""
        if permission in self.permissions and tracker_id is not None:
            return say(
                "{name} may not access tracker {tracker_id}; the token is for other trackers.",
                name=self.name,
                tracker_id=tracker_id,
            )
        who = join(" and ", map(Word, sorted(role.value for role in self.roles))) or Word(
            self.via.value.replace("_", " ")
        )
        return say(
            "{name} ({who}) may not {does}. Ask a user whose role is {permission}.",
            name=self.name,
            who=who,
            does=DOES[permission],
            permission=who_may(permission),
        )


def nobody(address: str) -> Principal:
    """Return who asks where nothing is known but an address."""
    return Principal("nobody", frozenset(), NOBODY, Via.NOBODY, address)


def this_computer(address: str) -> Principal:
    """Return whoever sits at the computer while there are no users."""
    roles = frozenset({Role.ENGINEER, Role.ADMINISTRATOR})
    return Principal(N_("local user"), roles, permissions_of(roles), Via.LOOPBACK, address)
