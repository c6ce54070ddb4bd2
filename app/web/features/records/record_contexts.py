"""What the templates about commissioning records are given."""

from dataclasses import dataclass
from datetime import datetime
from typing import ClassVar

from app.store.store import Photo, RecordHead
from app.tracker.memory.memory import StepName
from app.web.features.records.record import CommissioningRecord
from app.web.features.records.record_document import Difference, RecordDocument
from app.web.features.records.signatures import Signature
from app.web.shell.contexts import Form, Frame, ModeChoice


@dataclass(frozen=True, slots=True)
class RecordPage:
    """The record as it stands now, its photos, the fields to sign in, and what was signed before."""

    template: ClassVar[str] = "record.html"

    frame: Frame
    record: CommissioningRecord
    labels: dict[str, str]
    choice: ModeChoice | None
    photos: tuple[Photo, ...]
    form: Form
    signed: tuple[RecordHead, ...]
    most_photos: int
    photo_error: str = ""
    doubts: tuple[str, ...] = ()
    misdated: tuple[StepName, ...] = ()


@dataclass(frozen=True, slots=True)
class RecordsPage:
    """Every signed record of the site, or of one tracker; `error` says why two cannot be compared."""

    template: ClassVar[str] = "records.html"

    frame: Frame
    signed: tuple[RecordHead, ...]
    error: str = ""


@dataclass(frozen=True, slots=True)
class SignedRecordPage:
    """One signed record."""

    template: ClassVar[str] = "signed_record.html"

    frame: Frame
    head: RecordHead
    read: RecordDocument
    photos: tuple[Photo, ...]
    signatures: tuple[Signature, ...]


@dataclass(frozen=True, slots=True)
class ComparePage:
    """Two signed records side by side, in the reader's language, the first the older one."""

    template: ClassVar[str] = "record_compare.html"

    frame: Frame
    first: RecordHead
    second: RecordHead
    lines: tuple[Difference, ...]
    differing: int
    only_differences: bool


@dataclass(frozen=True, slots=True)
class LabelPage:
    """A label to print: the tracker's name and a QR code of its page."""

    template: ClassVar[str] = "label.html"

    frame: Frame
    form: Form
    url: str
    path: str
    size: int
    is_loopback: bool
    printed_at: datetime | None
