"""A commissioning record as it is signed: one canonical JSON text that its hash covers."""

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pydantic import ValidationError
from pydantic_core import to_jsonable_python

from app.audit.chain import canonical
from app.base.adapter import adapter
from app.base.message import NOTHING, Message, data, encoded, join, message_of, say
from app.store.documents import plain
from app.store.store import Photo, SignedRecord, StoreFailed
from app.web.features.records.record import CommissioningRecord
from app.web.features.records.record_files import Paper, PaperPhoto, Section, sections, title
from app.web.features.records.record_words import NUMBERED, PHOTO, own
from app.web.features.records.signatures import Signature

FORMAT = "heliopanel commissioning record 1"
LONGEST_REMARK = 1000
PASSING = ("Written", "Now", "Events")
"""Sections that differ between any two records and say nothing of what was set up."""


@dataclass(frozen=True, slots=True)
class NamedPhoto:
    """A photo as the record names it: SHA-256 of its content, what it shows, its pixels."""

    digest: str
    caption: str
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class RecordDocument:
    """What was signed: for people in `sections`, for programs in `state`.

    `lines` has the title and every text of the sections in their order, with template and values, so that
    they are shown in any language; a record that was signed before has none and is shown in English.
    """

    format: str
    tracker_id: str
    title: Message
    time_zone: str
    written_at: str
    kept_by: str
    remark: str
    sections: tuple[Section, ...]
    signatures: tuple[Signature, ...]
    photos: tuple[NamedPhoto, ...]
    state: dict[str, Any]
    lines: tuple[Any, ...] = ()


@dataclass(frozen=True, slots=True)
class Difference:
    """One line of two records side by side; an empty text stands where a record has no such line."""

    section: Message
    name: Message
    first: Message
    second: Message

    @property
    def differs(self) -> bool:
        """Return whether the records say different things here."""
        return self.first != self.second


def document(
    record: CommissioningRecord,
    kept_by: str,
    remark: str,
    signatures: Sequence[Signature],
    photos: Sequence[Photo],
) -> tuple[str, str]:
    """Return the canonical JSON of a record and its SHA-256, in hexadecimal."""
    made = RecordDocument(
        format=FORMAT,
        tracker_id=record.tracker.tracker_id,
        title=title(record),
        time_zone=record.time_zone,
        written_at=record.written_at.isoformat(),
        kept_by=kept_by,
        remark=plain(remark),
        sections=tuple(sections(record)),
        signatures=tuple(signatures),
        photos=tuple(NamedPhoto(one.digest, one.caption, one.width, one.height) for one in photos),
        state=to_jsonable_python(record),
        lines=tuple(map(encoded, _texts(title(record), tuple(sections(record))))),
    )
    text = plain(canonical(adapter(RecordDocument).dump_python(made, mode="json")))
    return text, hashlib.sha256(text.encode()).hexdigest()


def read_document(signed: SignedRecord) -> RecordDocument:
    """Return a signed record's document, or raise `StoreFailed` where it cannot be read or was changed."""
    if hashlib.sha256(signed.document.encode()).hexdigest() != signed.head.digest:
        raise StoreFailed(
            say(
                "Record {number} differs from what was signed: its hash does not match. Restore a backup.",
                number=signed.head.number,
            )
        )
    try:
        return _with_lines(adapter(RecordDocument).validate_json(signed.document))
    except ValidationError as error:
        raise StoreFailed(
            say(
                "Record {number} cannot be read. Install the version that wrote it.",
                number=signed.head.number,
            )
        ) from error


def _texts(heading: Message, parts: tuple[Section, ...]) -> Iterator[Message]:
    """Return title, headings, names and values in the order in which they are read."""
    yield heading
    for section, rows in parts:
        yield section
        for row in rows:
            yield from row


def _with_lines(read: RecordDocument) -> RecordDocument:
    """Return a document whose texts know their templates and values, as far as they were signed with them."""
    texts = list(_texts(read.title, read.sections))
    if len(texts) != len(read.lines):
        return read
    told = (message_of(line) for line in read.lines)
    known = iter([line if line == text else text for line, text in zip(told, texts, strict=True)])
    heading = next(known)
    parts = tuple((next(known), tuple((next(known), next(known)) for _ in rows)) for _, rows in read.sections)
    return replace(read, title=heading, sections=parts)


def paper(signed: SignedRecord, photos: Sequence[Photo]) -> Paper:
    """Return a signed record as it is printed."""
    read = read_document(signed)
    remark = ((own("Remark"), ((own("remark"), data(read.remark)),)),) if read.remark else ()
    return Paper(
        title=read.title,
        at=signed.head.kept_at,
        sections=(*read.sections, *remark),
        signatures=read.signatures,
        photos=tuple(PaperPhoto(one.caption, one.content) for one in photos),
        mark=own(NUMBERED, number=signed.head.number),
        digest=signed.head.digest,
    )


def differences(first: RecordDocument, second: RecordDocument) -> list[Difference]:
    """Return every line of two records side by side, in their order, without what passes."""
    left, right = dict(_lines(first)), dict(_lines(second))
    keys = [*left, *(key for key in right if key not in left)]
    order = {heading: place for place, heading in enumerate(dict.fromkeys(section for section, _ in keys))}
    keys.sort(key=lambda key: order[key[0]])
    return [Difference(*key, left.get(key, NOTHING), right.get(key, NOTHING)) for key in keys]


def _lines(read: RecordDocument) -> Iterator[tuple[tuple[Message, Message], Message]]:
    for heading, rows in read.sections:
        if heading in PASSING:
            continue
        seen: dict[str, int] = {}
        for name, value in rows:
            seen[name] = seen.get(name, 0) + 1
            again = seen[name] > 1
            yield (heading, join("", (name, f" ({seen[name]})")) if again else name), value
    for one in read.signatures:
        yield (own("Signatures"), one.words), data(one.name)
    for number, photo in enumerate(read.photos, start=1):
        yield (own("Photos"), own(PHOTO, number=number)), data(photo.caption or photo.digest[:12])
