"""Sessions: a random id that only the browser knows, and when it stops being worth something."""

import hashlib
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum

from app.base.clock import SMALL_CORRECTION, is_within, lasts

IDLE = timedelta(minutes=30)
ABSOLUTE = timedelta(hours=12)
PROOF = timedelta(minutes=5)
STEP_UP = timedelta(minutes=5)
USE_WRITTEN_EVERY = timedelta(minutes=1)
AGENT_KEPT = 120


class SessionState(StrEnum):
    """What a session is still good for."""

    LIVE = "live"
    IDLE = "idle"
    ENDED = "ended"


@dataclass(frozen=True, slots=True)
class Session:
    """A browser that somebody signed in with; `token_id` is set for a cabinet's panel instead of `user`."""

    digest: str
    user: str
    token_id: str
    address: str
    agent: str
    began_at: datetime
    used_at: datetime
    proven_at: datetime
    stepped_until: datetime | None = None

    @property
    def is_kiosk(self) -> bool:
        """Return whether this is a cabinet's panel."""
        return self.token_id != ""


def state(session: Session, now: datetime) -> SessionState:
    """Return what a session is good for: after 30 idle minutes it only views, after 12 h it has ended.

    One from the future has ended, too: it was begun or used under a clock that was ahead. A cabinet's panel
    lasts as long as its token, which is judged elsewhere.
    """
    if session.is_kiosk:
        return SessionState.LIVE
    is_future = session.used_at - now > SMALL_CORRECTION
    if is_future or not is_within(session.began_at, now, ABSOLUTE, ahead=SMALL_CORRECTION):
        return SessionState.ENDED
    return SessionState.IDLE if now - session.used_at >= IDLE else SessionState.LIVE


def is_proven(proven_at: datetime | None, now: datetime) -> bool:
    """Return whether the password was typed within the last 5 minutes."""
    return proven_at is not None and is_within(proven_at, now, PROOF)


def is_stepped_up(session: Session, now: datetime) -> bool:
    """Return whether the PIN of a cabinet's panel was typed within the last 5 minutes."""
    return session.stepped_until is not None and lasts(session.stepped_until, now, STEP_UP)


def new_id() -> str:
    """Return a session's id: 256 random bits."""
    return secrets.token_urlsafe(32)


def digest_of(session_id: str) -> str:
    """Return what is stored of a session's id; it cannot be turned back."""
    return hashlib.sha256(session_id.encode()).hexdigest()
