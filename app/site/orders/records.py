"""Commissioning records: photos wait for the next one; a signed one is kept for good."""

import hashlib
from base64 import b64decode

from app.base.message import N_, say
from app.link.record_orders import AddRecordPhoto, RemoveRecordPhoto, SignRecord
from app.site.state.model import SiteModel
from app.store.store import Photo, RecordHead, Writer
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason

MOST_PHOTOS = 12
LARGEST_PHOTO = 2 * 1024 * 1024
LONGEST_CAPTION = 120
KEEPS_NOTHING = Reason("no_store", N_("This controller runs without a database and keeps no records."))
TOO_MANY = Reason(
    "too_many_photos",
    say("The next record already has {most_photos} photos.", most_photos=MOST_PHOTOS),
    N_("Remove a photo that is not needed, or sign the record."),
)
SIGNED = Reason("already_signed", N_("This record is already signed."), N_("See the list of signed records."))


async def remove_photo(model: SiteModel, command: RemoveRecordPhoto, actor: str) -> tuple[Event, ...]:
    """Remove a photo that waits for the next record."""
    _refuse_without_store(model)
    await model.ledger.keep(lambda writer: writer.remove_photo(command.number), 0)
    return ()


async def add_photo(model: SiteModel, command: AddRecordPhoto, actor: str) -> tuple[Event, ...]:
    """Keep a photo for the next record."""
    _refuse_without_store(model)
    model.tracker(command.tracker_id)
    content = b64decode(command.chunks, validate=True)
    if len(content) > LARGEST_PHOTO or len(command.caption) > LONGEST_CAPTION:
        raise ValueError(N_("A photo has at most 2 MB, and its caption at most 120 characters."))
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


async def sign(model: SiteModel, command: SignRecord, actor: str) -> tuple[Event, ...]:
    """Keep a commissioning record for good."""
    _refuse_without_store(model)
    loop = model.tracker(command.tracker_id)
    document = b64decode(command.chunks, validate=True)
    if hashlib.sha256(document).hexdigest() != command.digest:
        raise ValueError(
            N_("The hash does not match this record: nothing was stored. Sign the record again.")
        )
    head = RecordHead(0, command.tracker_id, model.now(), actor, command.digest)
    event = model.event(
        EventKind.RECORD_SIGNED,
        say(
            "The commissioning record of {name} was signed; its hash begins with {digest}.",
            name=loop.config.name,
            digest=command.digest[:12],
        ),
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


def _refuse_without_store(model: SiteModel) -> None:
    if model.ledger.writer is None:
        raise CommandRejected(KEEPS_NOTHING)
