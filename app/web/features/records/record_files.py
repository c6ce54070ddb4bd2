"""The commissioning record for printing: what stands in which section, in English."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from datetime import datetime, tzinfo
from typing import Any

from app.base.message import Message, data, join, made, with_format
from app.base.zones import zone_of
from app.store.store import JournalEntry
from app.tracker.commissioning.drive_test_states import ProofState
from app.tracker.commissioning.steps import Step
from app.tracker.memory.drive_check import DriveCheck
from app.web.features.records.record import MISDATED, CommissioningRecord, is_future
from app.web.features.records.record_words import (
    TITLE,
    UNSIGNED,
    instant,
    label,
    own,
    own_template,
    person,
    value_of,
)
from app.web.features.records.signatures import Signature, SignatureRole

Row = tuple[Message, Message]
Section = tuple[Message, tuple[Row, ...]]
STATUS_WORDS = {"done": "done", "to_do": "to do", "to_be_confirmed": "to be confirmed"}
NOT_SIGNED = own(UNSIGNED)
TO_SIGN = (Signature(SignatureRole.TECHNICIAN, ""), Signature(SignatureRole.CUSTOMER, ""))


@dataclass(frozen=True, slots=True)
class PaperPhoto:
    """A photo on paper: what it shows, and the JPEG."""

    caption: str
    content: bytes


@dataclass(frozen=True, slots=True)
class Paper:
    """A record as it is printed; one that nobody has signed has lines to sign on and no hash."""

    title: Message
    at: datetime
    sections: tuple[Section, ...]
    signatures: tuple[Signature, ...] = TO_SIGN
    photos: tuple[PaperPhoto, ...] = ()
    mark: Message = NOT_SIGNED
    digest: str = ""


def draft(record: CommissioningRecord) -> Paper:
    """Return the record as it stands now, for signing on paper."""
    return Paper(title(record), record.written_at, tuple(sections(record)))


def sections(record: CommissioningRecord) -> Iterator[Section]:
    """Yield every section of the record as a heading and rows of name and value."""
    for heading, rows in _sections(record, zone_of(record.time_zone)):
        yield own(heading), tuple(rows)


def _sections(record: CommissioningRecord, zone: tzinfo) -> Iterator[tuple[str, list[Row]]]:
    yield "Written", [(own("at"), instant(record.written_at, zone)), (own("by"), data(record.software))]
    yield "Site", [(own("name"), data(record.site_name)), *_fields(("location",), record.location, zone)]
    yield "Clock", _fields((), record.clock, zone)
    yield "Steps", [_step(step, record.written_at, zone) for step in record.steps]
    yield "Homing", _fields((), record.home, zone) or [(own("zero"), own("not set"))]
    mode = value_of("mode", record.mode, zone) if record.mode else own("not selected")
    yield "Settings as left", [(own("mode"), mode), *_fields((), record.tracker, zone)]
    yield "Drive", _fields((), record.drive, zone) or [(own("drive"), own("not reached yet"))]
    yield "Drive connection test", _checked(record.check, zone)
    yield "Drive tests", [_proof(proof, zone) for proof in record.proofs]
    yield "Mounting correction", _fields((), record.pointing, zone)
    off, error = _degrees(record.off_sun_deg), _degrees(record.following_error_deg)
    yield "Now", [(own("off the sun"), off), (own("following error"), error)]
    yield "Events", [_event(entry, zone) for entry in record.events]


def _event(entry: JournalEntry, zone: tzinfo) -> Row:
    values = {"message": entry.event.message, "who": person(entry.event.actor)}
    text = f"{entry.event.message} ({entry.event.actor})"
    return instant(entry.event.at, zone), made(text, "{message} ({who})", values)


def _status(status: str, at: datetime | None, by: str, zone: tzinfo) -> Message:
    """Return how something stands, when that was, and by whom."""
    word = own(STATUS_WORDS[status])
    if at is None:
        return made(f"{word}.", "{word}.", {"word": word})
    values = {"status": word, "at": instant(at, zone), "name": person(by)}
    told = made(f"{word}, {values['at']} by {by}", own_template("{status}, {at}, by {name}"), values)
    return made(f"{told}.", "{told}.", {"told": told})


def _step(step: Step, written_at: datetime, zone: tzinfo) -> Row:
    why = [MISDATED] if is_future(step.confirmed_at, written_at) else []
    told = _status(step.status, step.confirmed_at, step.confirmed_by or "", zone)
    return own(step.name), join(" ", (told, *why, *(reason.message for reason in step.reasons)))


def _proof(proof: ProofState, zone: tzinfo) -> Row:
    """Return what was proven, how it stands now, when, by whom and with which result."""
    name = label(tuple(filter(None, (proof.axis or "drive", proof.kind, proof.speed))))
    told = _status(proof.status, proof.at, proof.by, zone)
    return name, join(" ", (told, proof.result, *(reason.message for reason in proof.reasons)))


def _checked(check: DriveCheck | None, zone: tzinfo) -> list[Row]:
    connection = own("connection")
    if check is None:
        return [(connection, own("not tested since the controller was started"))]
    seen = check.readings
    unsure = sorted({one.name for one in seen.registers if not one.verified})
    when = {"at": instant(check.at, zone), "name": person(check.by)}
    by = made(f"{when['at']} by {check.by}", own_template("{at}, by {name}"), when)
    is_read = seen.watchdog_s is not None
    watchdog = own("{number} s, read back", number=with_format(seen.watchdog_s, "g")) if is_read else None
    action = seen.watchdog_action
    return [
        (connection, join(" ", (seen.message, by))),
        (own("watchdog"), watchdog or own("not read back")),
        (own("without commands"), value_of("action", action, zone) if action else own("not described")),
        (own("unverified registers"), data(", ".join(unsure)) if unsure else own("none")),
    ]


def _fields(path: tuple[str, ...], value: Any, zone: tzinfo) -> list[Row]:
    return [] if value is None else list(_flat(path, asdict(value), zone))


def _flat(path: tuple[str, ...], values: dict[str, Any], zone: tzinfo) -> Iterator[Row]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat((*path, name), value, zone)
        elif value != ():
            yield label((*path, name)), value_of(name, value, zone)


def _degrees(angle: float | None) -> Message:
    return own("not known") if angle is None else own("{number} degrees", number=with_format(angle, ".3f"))


def title(record: CommissioningRecord) -> Message:
    """Return the title of a tracker's record."""
    return own(TITLE, name=f"{record.tracker.name} ({record.tracker.tracker_id})")
