"""API tokens: `hp_`, an id, a secret and a checksum, so that lost ones and typing errors are found."""

import hashlib
import hmac
import secrets
import string
import zlib
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum

from app.access.roles import KNOWN
from app.base.clock import SMALL_CORRECTION
from app.base.permission import Permission

ALPHABET = string.digits + string.ascii_uppercase + string.ascii_lowercase
PREFIX = "hp_"
ID_LENGTH, SECRET_LENGTH, CHECK_LENGTH = 8, 32, 6
LIFETIME = timedelta(days=90)
LONGEST_LIFETIME = timedelta(days=366)


class Scope(StrEnum):
    """What a token is for."""

    READ = "read"
    STOP = "stop"
    MOTION = "motion"
    CONFIG = "config"


SCOPES: dict[Scope, frozenset[Permission]] = {
    Scope.READ: frozenset({Permission.READ}),
    Scope.STOP: frozenset({Permission.STOP}),
    Scope.MOTION: frozenset(
        {Permission.READ, Permission.STOP, Permission.OPERATE, Permission.REPORT, Permission.SIMULATE}
    ),
    Scope.CONFIG: frozenset({Permission.READ, Permission.CONFIGURE, Permission.REPORT, Permission.SIMULATE}),
}
"""No scope reaches users, tokens or backups: these need a person."""


@dataclass(frozen=True, slots=True)
class Token:
    """What is stored of a token. With `pin_hash` it is for a cabinet's panel, which is no program."""

    token_id: str
    name: str
    owner: str
    digest: str
    scopes: frozenset[Scope]
    trackers: frozenset[str] | None
    created_at: datetime
    expires_at: datetime
    used_at: datetime | None = None
    pin_hash: str = ""

    @property
    def is_kiosk(self) -> bool:
        """Return whether this token belongs to a cabinet's panel."""
        return self.pin_hash != ""

    def is_misdated(self, now: datetime) -> bool:
        """Return whether it was made in the future: a clock was ahead then, or is behind now."""
        return self.created_at - now > SMALL_CORRECTION


def mint() -> tuple[str, str]:
    """Return a new token's id and its whole text, which is shown once."""
    token_id, secret = _random(ID_LENGTH), _random(SECRET_LENGTH)
    return token_id, f"{PREFIX}{token_id}{secret}{_check(token_id + secret)}"


def token_id_of(text: str) -> str | None:
    """Return the id in a token's text, None where the text cannot be a token."""
    body = text.removeprefix(PREFIX)
    if len(text) - len(body) != len(PREFIX) or len(body) != ID_LENGTH + SECRET_LENGTH + CHECK_LENGTH:
        return None
    if not set(body) <= set(ALPHABET):
        return None
    if not hmac.compare_digest(_check(body[:-CHECK_LENGTH]), body[-CHECK_LENGTH:]):
        return None
    return body[:ID_LENGTH]


def digest_of(text: str) -> str:
    """Return what is stored of a token; 190 random bits need no slow hash."""
    return hashlib.sha256(text.encode()).hexdigest()


def is_valid(token: Token, text: str, now: datetime) -> bool:
    """Return whether this text is the token's and it has not expired."""
    return hmac.compare_digest(token.digest, digest_of(text)) and now < token.expires_at


def permissions_of(scopes: frozenset[Scope]) -> frozenset[Permission]:
    """Return everything that a token with these scopes may do."""
    return KNOWN.union(*(SCOPES[scope] for scope in scopes))


def _random(length: int) -> str:
    return "".join(secrets.choice(ALPHABET) for _ in range(length))


def _check(text: str) -> str:
    number, digits = zlib.crc32(text.encode()), ""
    for _ in range(CHECK_LENGTH):
        number, digit = divmod(number, len(ALPHABET))
        digits = ALPHABET[digit] + digits
    return digits
