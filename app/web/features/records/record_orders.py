"""Signing a record and adding photos to it: what the pages and the API do alike."""

from base64 import b64encode
from collections.abc import Awaitable, Callable, Sequence

from starlette.concurrency import run_in_threadpool

from app.base.message import N_, say, told_by
from app.base.names import clean
from app.link.messages import UnknownTracker
from app.link.record_orders import AddRecordPhoto, RecordOrder, RemoveRecordPhoto, SignRecord
from app.store.store import Photo, Reader, RecordHead, SignedRecord, StoreFailed
from app.web.features.records.photos import PhotoRefused, plain_photo
from app.web.features.records.record import read_record
from app.web.features.records.record_document import document
from app.web.features.records.sign_doubts import sign_doubts
from app.web.features.records.signatures import Signature
from app.web.http.errors import NotFound
from app.web.shell.deps import Panel

Send = Callable[[RecordOrder], Awaitable[object]]


async def add_photo(send: Send, tracker_id: str, upload: bytes, caption: str) -> None:
    """Keep a photo for the next record of a tracker, or raise `PhotoRefused`."""
    try:
        caption = clean(" ".join(caption.split()))
    except ValueError as error:
        raise PhotoRefused(told_by(error)) from error
    photo = await run_in_threadpool(plain_photo, upload)
    encoded = b64encode(photo.content).decode()
    await send(AddRecordPhoto(tracker_id, encoded, photo.width, photo.height, caption))


async def remove_photo(send: Send, reader: Reader, tracker_id: str, number: int) -> None:
    """Remove a photo that waits for the next record, or raise `NotFound`."""
    photo = await run_in_threadpool(photo_of, reader, number)
    if photo.tracker_id != tracker_id or photo.record_number is not None:
        raise NotFound(
            say(
                "There is no photo {number} waiting for the next record of {tracker_id}.",
                number=number,
                tracker_id=tracker_id,
            )
        )
    await send(RemoveRecordPhoto(tracker_id, number))


async def asked_before_signing(built: Panel, tracker_id: str) -> tuple[str, ...]:
    """Return what must be confirmed before the record of a tracker is signed as it stands now."""
    record = await read_record(built.machine, built.reader, tracker_id)
    site = built.machine.latest()
    return sign_doubts(record, () if site is None else site.alarms)


async def sign(
    send: Send, built: Panel, tracker_id: str, kept_by: str, remark: str, signatures: Sequence[Signature]
) -> RecordHead:
    """Keep the record of a tracker as it stands now, with its photos; return its head.

    A second press within the second finds the record of the first.
    """
    record = await read_record(built.machine, built.reader, tracker_id)
    photos = await run_in_threadpool(built.reader.waiting_photos, tracker_id)
    text, digest = document(record, kept_by, remark, signatures, photos)
    if found := await run_in_threadpool(_kept, built.reader, tracker_id, digest):
        return found
    encoded = b64encode(text.encode()).decode()
    await send(SignRecord(tracker_id, encoded, digest, tuple(photo.number for photo in photos)))
    found = await run_in_threadpool(_kept, built.reader, tracker_id, digest)
    if found is None:
        raise StoreFailed(
            N_("The record was submitted but is not in the list yet. Check the list before you sign again.")
        )
    return found


def _kept(reader: Reader, tracker_id: str, digest: str) -> RecordHead | None:
    return next((head for head in reader.signed_records(tracker_id) if head.digest == digest), None)


async def require_tracker(built: Panel, tracker_id: str) -> None:
    """Raise `UnknownTracker` if the machine has no such tracker."""
    if tracker_id not in (await built.machine.detail()).trackers:
        raise UnknownTracker(tracker_id)


def signed_record(reader: Reader, number: int) -> SignedRecord:
    """Return a signed record, or raise `NotFound`."""
    found = reader.signed_record(number)
    if found is None:
        raise NotFound(
            say("There is no commissioning record {number}; see the list of records.", number=number)
        )
    return found


def photo_of(reader: Reader, number: int) -> Photo:
    """Return a photo, or raise `NotFound`."""
    found = reader.photo(number)
    if found is None:
        raise NotFound(say("There is no photo {number}.", number=number))
    return found
