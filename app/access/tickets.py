"""Tickets: one-shot ones for streams and downloads, and the stop-only one that every page carries."""

import base64
import hashlib
import hmac
import secrets
from collections import OrderedDict
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from app.access.principal import Principal
from app.base.clock import lasts

ONE_SHOT = timedelta(seconds=5)
STOP_LIFETIME = timedelta(hours=24)
MOST_OPEN = 1000
LONGEST_NAME = 64


@dataclass(frozen=True, slots=True)
class StopTicket:
    """What a stop-only ticket says: whose page it was on, and until when it stops."""

    name: str
    until: datetime


class OneShots:
    """Tickets that open one stream or download within 5 s of being issued, once."""

    def __init__(self) -> None:
        self._open: OrderedDict[str, tuple[datetime, Principal]] = OrderedDict()

    def issue(self, principal: Principal, now: datetime) -> str:
        """Return a ticket that stands for this principal; beyond 1,000 open ones the oldest is forgotten."""
        ticket = secrets.token_urlsafe(32)
        self._open[ticket] = (now + ONE_SHOT, principal)
        if len(self._open) > MOST_OPEN:
            self._open.popitem(last=False)
        return ticket

    def redeem(self, ticket: str, now: datetime) -> Principal | None:
        """Return whom a ticket stands for and forget it; None if it is unknown, used or too old."""
        until, principal = self._open.pop(ticket, (now, None))
        return principal if lasts(until, now, ONE_SHOT) else None


def stop_ticket(key: bytes, name: str, now: datetime) -> str:
    """Return a ticket that can do nothing but stop, for 24 h, whatever becomes of the session."""
    body = f"{int((now + STOP_LIFETIME).timestamp())}.{name[:LONGEST_NAME]}".encode()
    return f"{_text(body)}.{_text(_mac(key, b'stop', body))}"


def read_stop_ticket(key: bytes, ticket: str, now: datetime) -> StopTicket | None:
    """Return what a stop ticket says, None if it was not made here or is too old.

    One from the future counts, as it only stops: no clock that was set keeps a page from stopping.
    """
    try:
        body, mac = (_bytes(part) for part in ticket.split("."))
        if not hmac.compare_digest(mac, _mac(key, b"stop", body)):
            return None
        until, name = body.decode().split(".", 1)
    except ValueError:
        return None
    found = StopTicket(name, datetime.fromtimestamp(int(until), UTC))
    return found if now < found.until else None


def csrf_token(key: bytes, session_id: str) -> str:
    """Return what pages of a session must send along with every change."""
    return _text(_mac(key, b"csrf", session_id.encode()))


def _mac(key: bytes, purpose: bytes, body: bytes) -> bytes:
    return hmac.digest(key, purpose + b":" + body, hashlib.sha256)


def _text(raw: bytes) -> str:
    return base64.urlsafe_b64encode(raw).rstrip(b"=").decode()


def _bytes(text: str) -> bytes:
    return base64.b64decode(text + "=" * (-len(text) % 4), altchars=b"-_", validate=True)
