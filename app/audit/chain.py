"""The chain of hashes: each record carries the hash of the one before, so that a changed one is seen."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from hmac import compare_digest

FIRST = "0" * 64
"""What the first record of a chain names as the hash before it."""


@dataclass(frozen=True, slots=True)
class Link:
    """A stored record as the chain sees it: its number, its content, and the two hashes beside it."""

    number: int
    fields: Mapping[str, object]
    prev_hash: str
    hash: str


@dataclass(frozen=True, slots=True)
class Break:
    """The first record at which a chain does not hold, and why."""

    number: int
    reason: str


def canonical(value: object) -> str:
    """Return the one JSON text of a value: sorted keys, no spaces, text as it is."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def link(previous: str, fields: Mapping[str, object]) -> str:
    """Return the hash of a record behind the one with the hash `previous`: SHA-256 over canonical JSON."""
    text = canonical({**fields, "prev_hash": previous})
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def first_break(links: Iterable[Link], *, after: Link | None = None) -> Break | None:
    """Return where a chain breaks, None if it holds; `after` is the record before the first of `links`."""
    previous = after
    for one in links:
        reason = _reason(previous, one)
        if reason:
            return Break(one.number, reason)
        previous = one
    return None


def _reason(previous: Link | None, one: Link) -> str:
    expected = FIRST if previous is None else previous.hash
    if not compare_digest(one.hash, link(one.prev_hash, one.fields)):
        return "its content was changed after it was written"
    if not compare_digest(one.prev_hash, expected):
        before = "the beginning" if previous is None else f"record {previous.number}"
        return f"it does not follow {before}: records were removed, added or put in another order"
    return ""
