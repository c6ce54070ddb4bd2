"""Orders about commissioning records: photos for the next one, and signing it."""

from dataclasses import dataclass
from typing import ClassVar, Literal

from app.tracker.values.order_spec import LONG_S, setting


@dataclass(frozen=True, slots=True)
class AddRecordPhoto:
    """Keep a photo for the next record of a tracker: base64 of a JPEG, its pixels, and what it shows."""

    tracker_id: str
    chunks: str
    width: int
    height: int
    caption: str
    kind: Literal["add_record_photo"] = "add_record_photo"
    spec: ClassVar = setting(within_s=LONG_S)


@dataclass(frozen=True, slots=True)
class RemoveRecordPhoto:
    """Remove a photo that waits for the next record of a tracker."""

    tracker_id: str
    number: int
    kind: Literal["remove_record_photo"] = "remove_record_photo"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class SignRecord:
    """Keep a commissioning record for good: its canonical JSON, its SHA-256, and the photos it names."""

    tracker_id: str
    chunks: str
    digest: str
    photos: tuple[int, ...] = ()
    kind: Literal["sign_record"] = "sign_record"
    spec: ClassVar = setting(within_s=LONG_S)


RecordOrder = AddRecordPhoto | RemoveRecordPhoto | SignRecord
"""What concerns commissioning records. `chunks`, as with recordings, stays out of the audit."""
