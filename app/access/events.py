"""What happened to users, sessions and tokens: each entry is chained to the one before by its hash."""

import hashlib
import json
from dataclasses import asdict, dataclass
from datetime import datetime

FIRST = "0" * 64


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


def chained(previous: str, event: AccessEvent) -> str:
    """Return the hash of an event after the one with the hash `previous`: SHA-256 over canonical JSON."""
    fields = asdict(event) | {"at": event.at.isoformat(), "prev_hash": previous}
    text = json.dumps(fields, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()
