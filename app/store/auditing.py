"""Audit entries in the database: appended in the transaction of the change, read in their order."""

import json
from dataclasses import asdict, dataclass, field
from typing import Any

from sqlalchemy import Connection, RowMapping, Select, insert, select

from app.audit.chain import FIRST
from app.audit.difference import difference
from app.audit.entry import Entry, Sealed, seal, told, with_change
from app.base.message import parts_of, with_parts
from app.store.documents import plain
from app.store.store import AuditFilter
from app.store.tables import audit

TEXTS = ("actor", "via", "address", "action", "object", "result")
LONGEST_VIA = 50
KEPT_FOR_UNDO = {"former", "former_site"}
"""What the site keeps beside a change so that it can be undone; nobody decided that."""


@dataclass(slots=True)
class Change:
    """A transaction that goes into the audit: whose it is, and what it changed so far."""

    entry: Entry
    only_changes: bool
    before: dict[str, object] = field(default_factory=dict)
    after: dict[str, object] = field(default_factory=dict)

    def note(self, document: str | None, becomes: str | None) -> None:
        """Note that a document was replaced."""
        old, new = difference(_loaded(document), _loaded(becomes))
        self.before |= old
        self.after |= new

    def finished(self) -> Entry | None:
        """Return what is to be written, None if nothing is worth it."""
        if self.only_changes and not (self.before or self.after):
            return None
        return with_change(self.entry, told(self.before), told(self.after))


def append(connection: Connection, entry: Entry) -> Sealed:
    """Append an entry behind the last one; of two writers at the same moment one fails."""
    columns = audit.c
    last = connection.execute(
        select(columns.seq, columns.hash).order_by(columns.seq.desc()).limit(1)
    ).one_or_none()
    sealed = seal(_storable(entry), 1 if last is None else last.seq + 1, FIRST if last is None else last.hash)
    row = {"seq": sealed.seq, **asdict(sealed.entry), "prev_hash": sealed.prev_hash, "hash": sealed.hash}
    row["result_parts"] = parts_of(entry.result)
    connection.execute(insert(audit), row)
    return sealed


def query(wanted: AuditFilter) -> Select[tuple[Any, ...]]:
    """Return the statement that finds the wanted entries."""
    columns = audit.c
    conditions = [
        columns.seq < wanted.before if wanted.before is not None else None,
        columns.seq > wanted.after if wanted.after is not None else None,
        columns.actor == wanted.actor if wanted.actor is not None else None,
        columns.object == wanted.object if wanted.object is not None else None,
        columns.utc >= wanted.start if wanted.start is not None else None,
        columns.utc < wanted.end if wanted.end is not None else None,
    ]
    found = select(audit).where(*(one for one in conditions if one is not None)).limit(wanted.limit)
    return found.order_by(columns.seq if wanted.after is not None else columns.seq.desc())


def sealed(row: RowMapping) -> Sealed:
    """Return an entry from its row."""
    values = dict(row)
    seq, previous, own, parts = (values.pop(name) for name in ("seq", "prev_hash", "hash", "result_parts"))
    values["result"] = with_parts(values["result"], parts)
    return Sealed(seq, Entry(**values), previous, own)


def _storable(entry: Entry) -> Entry:
    values = asdict(entry) | {name: plain(getattr(entry, name)) for name in TEXTS}
    return Entry(**values | {"via": values["via"][:LONGEST_VIA]})


def _loaded(document: str | None) -> dict[str, Any]:
    if document is None:
        return {}
    found = json.loads(document)
    return {name: value for name, value in found.items() if name not in KEPT_FOR_UNDO}
