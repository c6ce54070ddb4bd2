"""The positions of all simulated drives of a controller, in one file of its data folder."""

import struct
from hashlib import blake2b
from pathlib import Path
from urllib.parse import quote

from app.drives.position_memory import AxisMemory, PositionFile, PositionMemory
from app.logs import get_logger
from app.twins import Twins

FORMAT = struct.Struct("<16sdd?dd?I?")
"""Whose it is; true angle, offset and zero of each axis; how often it started; whether that is trusted."""

log = get_logger()


class KeptPositions:
    """One record a drive, found by a hash of its tracker's id; a record stays when its tracker goes."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file = Twins(folder / "positions", FORMAT.size)
        self._numbers: dict[bytes, int] = {}
        self._found: dict[bytes, PositionMemory] = {}
        records = self._file.read()
        self._room_at = len(records)
        for number, content in enumerate(records):
            if content is not None and len(content) == FORMAT.size:
                key, memory = _decoded(content)
                self._numbers[key] = number
                self._found[key] = memory

    def of(self, tracker_id: str) -> "KeptPosition":
        """Return the memory of one tracker's drive."""
        return KeptPosition(self, blake2b(tracker_id.encode(), digest_size=16).digest(), tracker_id)

    def recall(self, key: bytes, tracker_id: str) -> PositionMemory | None:
        """Return what is kept of a drive, also by an older version in a file of its own."""
        older = PositionFile(self._folder / f"{quote(tracker_id, safe='')}.json")
        return self._found.get(key) or older.recall()

    def keep(self, key: bytes, memory: PositionMemory) -> None:
        """Take the place of what is kept of a drive; a disk that fails loses it, and the drive goes on."""
        if key not in self._numbers:
            self._numbers[key] = self._room_at
            self._room_at += 1
        self._found[key] = memory
        try:
            self._file.write(self._numbers[key], _encoded(key, memory))
        except OSError as error:
            log.warning("simulated_position_not_kept", reason=str(error))


class KeptPosition:
    """The record of one drive, which has power of its own: it outlives the controller, as a real one does."""

    own_power = True

    def __init__(self, positions: KeptPositions, key: bytes, tracker_id: str) -> None:
        self._positions = positions
        self._key = key
        self._tracker_id = tracker_id

    def recall(self) -> PositionMemory | None:
        """Return what is kept, None if nothing is."""
        return self._positions.recall(self._key, self._tracker_id)

    def keep(self, memory: PositionMemory) -> None:
        """Take the place of what was kept."""
        self._positions.keep(self._key, memory)


def _encoded(key: bytes, memory: PositionMemory) -> bytes:
    first, second = memory.azimuth, memory.elevation
    return FORMAT.pack(
        key,
        *(first.true_deg, first.offset_deg, first.homed),
        *(second.true_deg, second.offset_deg, second.homed),
        memory.boot_count,
        memory.trusted,
    )


def _decoded(content: bytes) -> tuple[bytes, PositionMemory]:
    key, *values = FORMAT.unpack(content)
    return key, PositionMemory(AxisMemory(*values[:3]), AxisMemory(*values[3:6]), *values[6:])
