"""What a machine in memory does with orders about commissioning records."""

import hashlib
from base64 import b64decode
from dataclasses import replace
from datetime import datetime

from app.link.record_orders import AddRecordPhoto, RecordOrder, RemoveRecordPhoto, SignRecord
from app.store.store import Photo, RecordHead, SignedRecord
from tests.fake_store import FakeReader


def keep_record(store: FakeReader, command: RecordOrder, now: datetime, actor: str) -> None:
    """Keep a photo or a signed record in memory."""
    match command:
        case AddRecordPhoto():
            content = b64decode(command.chunks)
            number, digest = len(store.photos) + 1, hashlib.sha256(content).hexdigest()
            store.photos.append(
                Photo(
                    command.tracker_id, now, actor, command.caption, digest,
                    command.width, command.height, content, number,
                )
            )  # fmt: skip
        case RemoveRecordPhoto():
            store.photos = [one for one in store.photos if one.number != command.number]
        case SignRecord():
            number = len(store.signed) + 1
            head = RecordHead(number, command.tracker_id, now, actor, command.digest)
            store.signed.append(SignedRecord(head, b64decode(command.chunks).decode()))
            store.photos = [
                replace(one, record_number=number) if one.number in command.photos else one
                for one in store.photos
            ]
