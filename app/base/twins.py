"""Records in one small file, each in two copies overwritten in turn: nothing grows, nothing is half written.

What was written is there after the program was killed; once synced also after a power cut.
"""

import os
import struct
import weakref
import zlib
from pathlib import Path

from app.base.logs import get_logger

HEAD = struct.Struct("<IIH")
"""Checksum of all that follows, sequence number, length of the content."""

log = get_logger()


class Twins:
    """Records of at most `room` bytes each, by their number; the newest copy that is whole counts."""

    def __init__(self, path: Path, room: int) -> None:
        self._path = path
        self._size = HEAD.size + room
        self._sequences: dict[int, int] = {}
        self._file: int | None = None

    def read(self) -> list[bytes | None]:
        """Return the content of every record, None for one of which no copy is whole.

        A file that cannot be read counts as none: no controller fails to start because of it.
        """
        try:
            stored = self._path.read_bytes()
        except FileNotFoundError:
            return []
        except OSError as error:
            log.warning("not_read", path=str(self._path), reason=str(error))
            return []
        found: list[bytes | None] = []
        for number in range(-(-len(stored) // (2 * self._size))):
            copies = filter(None, (self._copy(stored, 2 * number + which) for which in (0, 1)))
            sequence, content = max(copies, default=(0, None), key=lambda copy: copy[0])
            self._sequences[number] = sequence
            found.append(content)
        return found

    def write(self, number: int, content: bytes) -> None:
        """Overwrite the older copy of a record, or raise `OSError`."""
        if len(content) > self._size - HEAD.size:
            raise ValueError(f"A record holds {self._size - HEAD.size} bytes, not {len(content)}.")
        sequence = self._sequences.get(number, 0) + 1
        body = HEAD.pack(0, sequence, len(content))[4:] + content
        file, place = self._opened(), (2 * number + sequence % 2) * self._size
        os.pwrite(file, zlib.crc32(body).to_bytes(4, "little") + body, place)
        self._sequences[number] = sequence

    def sync(self) -> None:
        """Have all that was written outlive a power cut, or raise `OSError`; this waits for the disk."""
        os.fdatasync(self._opened())

    def _copy(self, stored: bytes, place: int) -> tuple[int, bytes] | None:
        """Return sequence number and content of one copy, None if it is not whole."""
        one = stored[place * self._size : (place + 1) * self._size]
        if len(one) < HEAD.size:
            return None
        checksum, sequence, length = HEAD.unpack_from(one)
        body = one[4 : HEAD.size + length]
        return (sequence, body[HEAD.size - 4 :]) if sequence and zlib.crc32(body) == checksum else None

    def _opened(self) -> int:
        if self._file is None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o600)
            weakref.finalize(self, os.close, self._file)
            _keep_name(self._path.parent)
        return self._file


def _keep_name(folder: Path) -> None:
    """Have the names in a folder outlive a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
