"""The commissioning record for printing: what stands in which section, in English."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from datetime import datetime, tzinfo
from enum import Enum
from typing import Any

from app.store.store import JournalEntry
from app.tracker.commissioning import Step
from app.tracker.drive_check import DriveCheck
from app.tracker.drive_test_states import ProofState
from app.web.record import MISDATED, CommissioningRecord, is_future
from app.web.signatures import Signature, SignatureRole
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
    """A record as it is printed; one that nobody has signed has lines to sign on and no hash.

    `note` says in which language the signed file is where the paper is in another.
    """

    title: str
    at: datetime
    sections: tuple[Section, ...]
    signatures: tuple[Signature, ...] = TO_SIGN
    photos: tuple[PaperPhoto, ...] = ()
    mark: str = "not signed"
    digest: str = ""
    note: str = ""


def draft(record: CommissioningRecord) -> Paper:
    """Return the record as it stands now, for signing on paper."""
    return Paper(title(record), record.written_at, tuple(sections(record)))


def sections(record: CommissioningRecord) -> Iterator[Section]:
    """Yield every section of the record as a heading and rows of name and value."""
    for heading, rows in _sections(record, zone_of(record.time_zone)):
        yield heading, tuple(rows)


def _sections(record: CommissioningRecord, zone: tzinfo) -> Iterator[tuple[str, list[Row]]]:
    yield "Written", [("at", _local(record.written_at, zone)), ("by", record.software)]
    yield "Site", [("name", record.site_name), *_fields("location", record.location, zone)]
    yield "Clock", _fields("", record.clock, zone)
    yield "Steps", [_step(step, record.written_at, zone) for step in record.steps]
    yield "Homing", _fields("", record.home, zone) or [("zero", "not set")]
    yield "Settings as left", [("mode", record.mode or "not selected"), *_fields("", record.tracker, zone)]
    yield "Drive", _fields("", record.drive, zone) or [("drive", "not reached yet")]
    yield "Drive connection test", _checked(record.check, zone)
    yield "Drive tests", [_proof(proof, zone) for proof in record.proofs]
    yield "Mounting correction", _fields("", record.pointing, zone)
    off, error = _degrees(record.off_sun_deg), _degrees(record.following_error_deg)
    yield "Now", [("off the sun", off), ("following error", error)]
    yield "Events", [_event(entry, zone) for entry in record.events]


def _event(entry: JournalEntry, zone: tzinfo) -> Row:
    return _local(entry.event.at, zone), f"{entry.event.message} ({entry.event.actor})"


def _step(step: Step, written_at: datetime, zone: tzinfo) -> tuple[str, str]:
    when = f", {_local(step.confirmed_at, zone)} by {step.confirmed_by}" if step.confirmed_at else ""
    misdated = f" {MISDATED}" if is_future(step.confirmed_at, written_at) else ""
    why = misdated + "".join(f" {reason.message}" for reason in step.reasons)
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
            return f"{value:.6f}".rstrip("0").rstrip(".")
        case Enum():
            return str(value.value)
        case tuple():
            return "; ".join(_entry(one, zone) for one in value)
        case _:
            return str(value)


def _entry(value: Any, zone: tzinfo) -> str:
    """Return one of several: a reason as its sentence, a part of a setting by its fields, a name as it is."""
    match value:
        case {"message": str(message)}:
            return message
        case dict():
            return ", ".join(f"{_label(name)} {_text(inner, zone)}" for name, inner in value.items())
        case _:
            return _text(value, zone)


def _degrees(angle: float | None) -> str:
    return "not known" if angle is None else f"{angle:.3f} degrees"


def _local(at: datetime, zone: tzinfo) -> str:
    return at.astimezone(zone).isoformat(sep=" ", timespec="seconds")


def title(record: CommissioningRecord) -> str:
    """Return the title of a tracker's record."""
    return f"Commissioning record: {record.tracker.name} ({record.tracker.tracker_id})"
