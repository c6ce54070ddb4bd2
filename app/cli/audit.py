"""`heliopanel audit`: check that nobody changed what was recorded, and take it along."""

import csv
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, fields
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import IO, Annotated, assert_never

import typer

from app.access.events import AccessEvent, covered
from app.access.opening import open_store
from app.audit.chain import Break, Link, first_break
from app.audit.entry import Entry, Sealed
from app.base.instants import read_instant
from app.base.settings import Settings, read_settings
from app.store.engine import open_reader
from app.store.files import private_opener
from app.store.store import AuditFilter, Reader

audit = typer.Typer(name="audit", help="Who did what: check it, take it along.", no_args_is_help=True)

Row = Mapping[str, object]

AT_ONCE = 500
BROKEN = 1
COLUMNS = ("seq", *(field.name for field in fields(Entry)), "prev_hash", "hash")

Since = Annotated[str, typer.Option(help="Only entries from this day or instant on, ISO 8601, UTC.")]


ACCESS_COLUMNS = ("number", *(field.name for field in fields(AccessEvent)), "prev_hash", "hash")


class Kept(StrEnum):
    """The two records: what was ordered, and who came through the door or was turned away."""

    ORDERS = "orders"
    ACCESS = "access"


class Format(StrEnum):
    """What the audit can be written as."""

    CSV = "csv"
    JSON = "json"


@audit.command()
def verify(
    since: Since = "",
    head: Annotated[
        str, typer.Option(help="A SEQ:HASH that a log or a backup told; it must be in the chain.")
    ] = "",
    access_head: Annotated[
        str, typer.Option(help="The same for the record of users, sessions and tokens.")
    ] = "",
) -> None:
    """Check the chain of hashes; name the first entry that was changed, removed or added since."""
    settings, begin = read_settings(), _instant(since)
    reader = open_reader(settings.url)
    try:
        found = _verify_orders(reader, begin, head)
    finally:
        reader.close()
    found = _verify_access(settings, access_head) or found
    if found:
        raise typer.Exit(BROKEN)


@audit.command()
def export(
    out: Annotated[Path, typer.Argument(help="File to write.")],
    as_format: Annotated[Format, typer.Option("--format", help="How to write it.")] = Format.CSV,
    kept: Annotated[
        Kept, typer.Option("--of", help="Orders and settings, or log-ins, users, tokens and refusals.")
    ] = Kept.ORDERS,
    since: Since = "",
) -> None:
    """Write one of the two records into a file: CSV with a byte order mark and a head line, or JSON lines."""
    settings, begin = read_settings(), _instant(since)
    match kept:
        case Kept.ORDERS:
            _export_orders(settings, out, as_format, begin)
        case Kept.ACCESS:
            _export_access(settings, out, as_format, begin)
        case _:
            assert_never(kept)


def _export_orders(settings: Settings, out: Path, as_format: Format, begin: datetime | None) -> None:
    reader = open_reader(settings.url)
    try:
        count = _write(out, as_format, COLUMNS, map(row, entries(reader, begin)))
    finally:
        reader.close()
    typer.echo(f"{count} entries of the audit are in {out}.")


def _export_access(settings: Settings, out: Path, as_format: Format, begin: datetime | None) -> None:
    store = open_store(settings)
    try:
        events = store.events()
    finally:
        store.close()
    rows = (
        {"number": number, **covered(event), "prev_hash": previous, "hash": own}
        for number, (event, previous, own) in enumerate(events, start=1)
        if begin is None or event.at >= begin
    )
    count = _write(out, as_format, ACCESS_COLUMNS, rows)
    typer.echo(f"{count} entries of the record of users and tokens are in {out}.")


def entries(reader: Reader, since: datetime | None = None, *, after: int = 0) -> Iterator[Sealed]:
    """Yield the entries behind number `after`, oldest first."""
    while found := reader.audit(AuditFilter(after=after, limit=AT_ONCE, start=since)):
        yield from found
        after = found[-1].seq


def row(one: Sealed) -> Row:
    """Return an entry as one flat row."""
    return {
        "seq": one.seq,
        **asdict(one.entry),
        "utc": one.entry.utc.isoformat(),
        "prev_hash": one.prev_hash,
        "hash": one.hash,
    }


def _verify_orders(reader: Reader, since: datetime | None, head: str) -> bool:
    """Print what holds of the machine's audit and return whether it is broken."""
    first = next(iter(reader.audit(AuditFilter(after=0, limit=1, start=since))), None)
    if first is None:
        typer.echo("The audit has no entry since then." if since else "The audit has no entry yet.")
        return bool(head) and _is_missing(head, {})
    before = reader.audit(AuditFilter(before=first.seq, limit=1))
    seen: dict[int, str] = {}

    def links() -> Iterator[Link]:
        for one in entries(reader, after=first.seq - 1):
            seen[one.seq] = one.hash
            yield one.link()

    broken = first_break(links(), after=before[0].link() if before else None)
    if broken is not None:
        return _tell("audit", broken)
    last = max(seen)
    typer.echo(f"The audit holds: {len(seen)} entries, the last is {last}:{seen[last]}.")
    return bool(head) and _is_missing(head, seen)


def _is_missing(head: str, seen: dict[int, str]) -> bool:
    """Print and return whether a head that was told before is not in the chain any more."""
    number, _, digest = head.partition(":")
    if number.isdigit() and digest and seen.get(int(number)) == digest:
        typer.echo(f"{head} is in the chain.")
        return False
    typer.echo(f"{head} is not in the chain: entries were removed, or the audit is another one.", err=True)
    return True


def _verify_access(settings: Settings, head: str) -> bool:
    """Print what holds of the record of users, sessions and tokens, and return whether it is broken."""
    store = open_store(settings)
    try:
        links = store.links()
    finally:
        store.close()
    broken = first_break(links)
    if broken is not None:
        return _tell("record of users and tokens", broken)
    last = f", the last is {links[-1].number}:{links[-1].hash}" if links else ""
    typer.echo(f"The record of users and tokens holds: {len(links)} entries{last}.")
    return bool(head) and _is_missing(head, {one.number: one.hash for one in links})


def _tell(what: str, broken: Break) -> bool:
    typer.echo(f"The {what} is broken at entry {broken.number}: {broken.reason}.", err=True)
    return True


def _write(out: Path, as_format: Format, columns: Sequence[str], rows: Iterable[Row]) -> int:
    """Write rows and return how many there were."""
    count = 0
    # Without the byte order mark, Excel reads UTF-8 as the computer's own encoding.
    encoding = "utf-8-sig" if as_format is Format.CSV else "utf-8"
    with open(out, "w", newline="", encoding=encoding, opener=private_opener) as file:
        put = _put_csv(file, columns) if as_format is Format.CSV else _put_json(file)
        for count, one in enumerate(rows, start=1):  # noqa: B007 - the last number is the count
            put(one)
    return count


def _put_csv(file: IO[str], columns: Sequence[str]) -> Callable[[Row], object]:
    writer = csv.DictWriter(file, columns)
    writer.writeheader()
    return lambda values: writer.writerow({name: _harmless(value) for name, value in values.items()})


def _put_json(file: IO[str]) -> Callable[[Row], object]:
    return lambda values: file.write(json.dumps(values, ensure_ascii=False) + "\n")


def _harmless(value: object) -> object:
    """Return a value that no spreadsheet takes for a formula."""
    return f"'{value}" if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t") else value


def _instant(text: str) -> datetime | None:
    if not text:
        return None
    found = read_instant(text)
    return found if found.tzinfo is not None else found.replace(tzinfo=UTC)
