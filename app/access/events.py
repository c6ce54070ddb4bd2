"""What happened to users, sessions and tokens: each entry is chained to the one before by its hash."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime

from app.audit.chain import link


@dataclass(frozen=True, slots=True)
class AccessEvent:
    """Something that was done, or tried, with who, how and from where."""

    at: datetime
    actor: str
    via: str
    address: str
    action: str
    object: str
    result: str = "done"


@dataclass(frozen=True, slots=True)
class Recorded:
    """An event with its place in the record."""

    number: int
    event: AccessEvent


def covered(event: AccessEvent) -> Mapping[str, str]:
    """Return what the hash of an event covers."""
    return asdict(event) | {"at": event.at.isoformat()}


def chained(previous: str, event: AccessEvent) -> str:
    """Return the hash of an event after the one with the hash `previous`."""
    return link(previous, covered(event))
