"""What the audit keeps of one command or change of settings."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from typing import Any

from app.audit.chain import Link, canonical, link
from app.base.addresses.masking import without_secrets

DONE = "done"
LONGEST = 8192
"""JSON longer than this is kept as its hash, its length and its beginning."""
BEGINNING = 1024


@dataclass(frozen=True, slots=True)
class Entry:
    """Who asked for what, how and from where, what was before and after, and what came of it.

    `mono_ms` is the computer's monotonic counter, which nobody can set.
    `given`, `before` and `after` are JSON.
    """

    utc: datetime
    mono_ms: int
    boot_id: str
    clock_quality: str
    actor: str
    via: str
    address: str
    action: str
    object: str
    given: str
    before: str = "{}"
    after: str = "{}"
    result: str = DONE

    def fields(self, seq: int) -> Mapping[str, Any]:
        """Return what the hash covers."""
        return {**asdict(self), "utc": self.utc.isoformat(), "seq": seq}


@dataclass(frozen=True, slots=True)
class Sealed:
    """An entry with its place in the chain."""

    seq: int
    entry: Entry
    prev_hash: str
    hash: str

    def link(self) -> Link:
        """Return the entry as the chain sees it."""
        return Link(self.seq, self.entry.fields(self.seq), self.prev_hash, self.hash)


def seal(entry: Entry, seq: int, previous: str) -> Sealed:
    """Return the entry as number `seq`, behind the one with the hash `previous`."""
    return Sealed(seq, entry, previous, link(previous, entry.fields(seq)))


def with_change(entry: Entry, before: str, after: str) -> Entry:
    """Return the entry with what it changed."""
    return replace(entry, before=before, after=after)


def told(value: Any) -> str:
    """Return the JSON of a value in ASCII, which every database can hold, cut short where it is too long.

    Addresses that may hold a secret are masked.
    """
    text = json.dumps(without_secrets(value), sort_keys=True, separators=(",", ":"))
    if len(text) <= LONGEST:
        return text
    digest = hashlib.sha256(text.encode()).hexdigest()
    return canonical({"beginning": text[:BEGINNING], "characters": len(text), "sha256": digest})
