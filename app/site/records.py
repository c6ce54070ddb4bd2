"""Commissioning records: photos wait for the next one; a signed one is kept for good."""

import hashlib
from base64 import b64decode
from typing import assert_never

from app.link.record_orders import AddRecordPhoto, RecordOrder, RemoveRecordPhoto, SignRecord
from app.site.model import SiteModel
from app.store.store import Photo, RecordHead, Writer
from app.tracker.commands import CommandRejected
from app.tracker.reason import Reason
from app.tracker.snapshot import Event, EventKind

MOST_PHOTOS = 12
LARGEST_PHOTO = 2 * 1024 * 1024
LONGEST_CAPTION = 120
KEEPS_NOTHING = Reason("no_store", "This controller runs without a database and keeps no records.")
TOO_MANY = Reason(
    "too_many_photos",
    f"The next record already has {MOST_PHOTOS} photos.",
    "Remove a photo that is not needed, or sign the record.",
)
SIGNED = Reason("already_signed", "This record is already signed.", "See the list of signed records.")


async def carry_out(model: SiteModel, command: RecordOrder, actor: str) -> tuple[Event, ...]:
    """Carry out one order about records, stored before this returns, and return what happened."""
    if model.ledger.writer is None:
        raise CommandRejected(KEEPS_NOTHING)
    match command:
        case AddRecordPhoto():
            return await _add_photo(model, command, actor)
        case RemoveRecordPhoto(number=number):
            await model.ledger.keep(lambda writer: writer.remove_photo(number), 0)
            return ()
        case SignRecord():
            return await _sign(model, command, actor)
        case _:
            assert_never(command)


async def _add_photo(model: SiteModel, command: AddRecordPhoto, actor: str) -> tuple[Event, ...]:
    model.tracker(command.tracker_id)
    content = b64decode(command.chunks, validate=True)
    if len(content) > LARGEST_PHOTO or len(command.caption) > LONGEST_CAPTION:
        raise ValueError("A photo has at most 2 MB, and its caption at most 120 characters.")
    photo = Photo(
        tracker_id=command.tracker_id,
        added_at=model.now(),
        added_by=actor,
        caption=command.caption,
        digest=hashlib.sha256(content).hexdigest(),
        width=command.width,
        height=command.height,
        content=content,
    )
    await model.ledger.keep(lambda writer: _add(writer, photo), 0)
    return ()


def _add(writer: Writer, photo: Photo) -> None:
    if len(writer.waiting_photos(photo.tracker_id)) >= MOST_PHOTOS:
        raise CommandRejected(TOO_MANY)
    writer.add_photo(photo)


async def _sign(model: SiteModel, command: SignRecord, actor: str) -> tuple[Event, ...]:
    loop = model.tracker(command.tracker_id)
    document = b64decode(command.chunks, validate=True)
    if hashlib.sha256(document).hexdigest() != command.digest:
        raise ValueError("The hash does not match this record: nothing was stored. Sign the record again.")
    head = RecordHead(0, command.tracker_id, model.now(), actor, command.digest)
    event = model.event(
        EventKind.RECORD_SIGNED,
        f"The commissioning record of {loop.config.name} was signed; its hash begins with "
        f"{command.digest[:12]}.",
        actor,
        command.tracker_id,
        digest=command.digest,
    )
    await model.ledger.keep(lambda writer: _keep(writer, head, document.decode(), command.photos, event), 1)
    return (event,)


def _keep(writer: Writer, head: RecordHead, document: str, photos: tuple[int, ...], event: Event) -> None:
    if any(one.digest == head.digest for one in writer.signed_records(head.tracker_id)):
        raise CommandRejected(SIGNED)
    writer.sign_record(head, document, photos, (event,))
