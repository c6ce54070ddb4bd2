"""The commissioning record for printing: the same sections as HTML and as PDF."""

from base64 import b64encode
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from datetime import datetime, tzinfo
from enum import Enum
from html import escape
from typing import Any

from app.late import late
from app.store.store import JournalEntry
from app.tracker.drive_check import DriveCheck
from app.tracker.proof_states import ProofState
from app.web.record import CommissioningRecord
from app.web.signatures import HEIGHT, WIDTH, Signature, SignatureRole
from app.zones import zone_of

Row = tuple[str, str]
Section = tuple[str, tuple[Row, ...]]
STATUS_WORDS = {"done": "done", "to_do": "to do", "to_be_confirmed": "to be confirmed"}
TO_SIGN = (Signature(SignatureRole.TECHNICIAN, ""), Signature(SignatureRole.CUSTOMER, ""))
UNITS = {
    "deg": "°",
    "dps": "°/s",
    "dps2": "°/s²",
    "m": "m",
    "mps": "m/s",
    "s": "s",
    "kg": "kg",
    "wm2": "W/m²",
}


@dataclass(frozen=True, slots=True)
class PaperPhoto:
    """A photo on paper: what it shows, and the JPEG."""

    caption: str
    content: bytes


@dataclass(frozen=True, slots=True)
class Paper:
    """A record as it is printed; one that nobody has signed has lines to sign on and no hash."""

    title: str
    at: datetime
    sections: tuple[Section, ...]
    signatures: tuple[Signature, ...] = TO_SIGN
    photos: tuple[PaperPhoto, ...] = ()
    mark: str = "not signed"
    digest: str = ""


def draft(record: CommissioningRecord) -> Paper:
    """Return the record as it stands now, for signing on paper."""
    return Paper(title(record), record.written_at, tuple(sections(record)))


def record_html(paper: Paper) -> str:
    """Return the record as one HTML file that needs nothing else."""
    parts = [
        "<!doctype html><html lang='en'><meta charset='utf-8'>",
        f"<title>{escape(paper.title)}</title><h1>{escape(paper.title)}</h1>",
        f"<p>{escape(' '.join(filter(None, (paper.mark, paper.digest and 'SHA-256', paper.digest))))}</p>",
    ]
    for heading, rows in paper.sections:
        lines = (
            f"<tr><th align='left'>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows
        )
        parts.append(f"<h2>{escape(heading)}</h2><table>{''.join(lines)}</table>")
    parts += [_photo_html(one) for one in paper.photos]
    parts += [_signature_html(one) for one in paper.signatures]
    return "\n".join([*parts, "</html>"])


def _photo_html(photo: PaperPhoto) -> str:
    source = f"data:image/jpeg;base64,{b64encode(photo.content).decode()}"
    caption = escape(photo.caption)
    return (
        f"<figure><img src='{source}' width='480' alt='{caption}'><figcaption>{caption}</figcaption></figure>"
    )


def _signature_html(one: Signature) -> str:
    drawn = (
        f"<svg viewBox='0 0 {WIDTH} {HEIGHT}' width='400' role='img'><path d='{one.path}' fill='none' "
        "stroke='#000' stroke-width='5'/></svg>"
        if one.strokes
        else "<br><br>"
    )
    return f"<p>{drawn}<br>________________________<br>{escape(one.words)}: {escape(one.name)}</p>"


def record_pdf(paper: Paper) -> bytes:
    """Return the record as a PDF on A4: every section a table, photos, and signatures or lines to sign on."""
    printed: bytes = late("app.web.record_pdf").printed(paper)
    return printed


def sections(record: CommissioningRecord) -> Iterator[Section]:
    """Yield every section of the record as a heading and rows of name and value."""
    for heading, rows in _sections(record, zone_of(record.time_zone)):
        yield heading, tuple(rows)


def _sections(record: CommissioningRecord, zone: tzinfo) -> Iterator[tuple[str, list[Row]]]:
    yield "Written", [("at", _local(record.written_at, zone)), ("by", record.software)]
    yield "Site", [("name", record.site_name), *_fields("location", record.location, zone)]
    yield "Clock", _fields("", record.clock, zone)
    yield "Steps", [_step(step, zone) for step in record.steps]
    yield "Homing", _fields("", record.home, zone) or [("zero", "not set")]
    yield "Settings as left", [("mode", record.mode or "not selected"), *_fields("", record.tracker, zone)]
    yield "Drive", _fields("", record.drive, zone) or [("drive", "not reached yet")]
    yield "Drive, as it was read", _checked(record.check, zone)
    yield "Drive, as it was proven", [_proof(proof, zone) for proof in record.proofs]
    yield "Pointing correction", _fields("", record.pointing, zone)
    off, error = _degrees(record.off_sun_deg), _degrees(record.following_error_deg)
    yield "Now", [("off the sun", off), ("following error", error)]
    yield "Events", [_event(entry, zone) for entry in record.events]


def _event(entry: JournalEntry, zone: tzinfo) -> Row:
    return _local(entry.event.at, zone), f"{entry.event.message} ({entry.event.actor})"


def _step(step: Any, zone: tzinfo) -> tuple[str, str]:
    when = f", {_local(step.confirmed_at, zone)} by {step.confirmed_by}" if step.confirmed_at else ""
    why = "".join(f" {reason.message}" for reason in step.reasons)
    return step.name, f"{STATUS_WORDS[step.status]}{when}.{why}"


def _proof(proof: ProofState, zone: tzinfo) -> tuple[str, str]:
    """Return what was proven, how it stands now, when, by whom and with which result."""
    name = " ".join(filter(None, (proof.axis or "drive", proof.kind.replace("_", " "), proof.speed)))
    when = f", {_local(proof.at, zone)} by {proof.by}" if proof.at else ""
    why = "".join(f" {reason.message}" for reason in proof.reasons)
    return name, f"{STATUS_WORDS[proof.status]}{when}. {proof.result}{why}"


def _checked(check: DriveCheck | None, zone: tzinfo) -> list[tuple[str, str]]:
    if check is None:
        return [("connection", "not tested since the controller was started")]
    seen = check.readings
    unsure = sorted({one.name for one in seen.registers if not one.verified})
    watchdog = "not read back" if seen.watchdog_s is None else f"{seen.watchdog_s:g} s, read back"
    return [
        ("connection", f"{seen.message} {_local(check.at, zone)} by {check.by}"),
        ("watchdog", watchdog),
        ("without commands", seen.watchdog_action or "not described"),
        ("unverified registers", ", ".join(unsure) or "none"),
    ]


def _fields(prefix: str, value: Any, zone: tzinfo) -> list[tuple[str, str]]:
    return [] if value is None else list(_flat(prefix, asdict(value), zone))


def _flat(prefix: str, values: dict[str, Any], zone: tzinfo) -> Iterator[tuple[str, str]]:
    for name, value in values.items():
        label = f"{prefix} {name}".strip()
        if isinstance(value, dict):
            yield from _flat(label, value, zone)
        elif value != ():
            yield _label(label), _text(value, zone)


def _label(name: str) -> str:
    """Return a field's name with its unit in brackets instead of behind an underscore."""
    words, _, unit = name.rpartition("_")
    named = f"{words} ({UNITS[unit]})" if words and unit in UNITS else name
    return named.replace("_", " ")


def _text(value: Any, zone: tzinfo) -> str:
    match value:
        case None:
            return "none"
        case bool():
            return "yes" if value else "no"
        case datetime():
            return _local(value, zone)
        case float():
            return f"{value:.6g}"
        case Enum():
            return str(value.value)
        case _:
            return str(value)


def _degrees(angle: float | None) -> str:
    return "not known" if angle is None else f"{angle:.3f} degrees"


def _local(at: datetime, zone: tzinfo) -> str:
    return at.astimezone(zone).isoformat(sep=" ", timespec="seconds")


def title(record: CommissioningRecord) -> str:
    """Return the title of a tracker's record."""
    return f"Commissioning record: {record.tracker.name} ({record.tracker.tracker_id})"
