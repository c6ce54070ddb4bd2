"""The positions of all simulated drives of a controller: in memory at once, on its disk with the samples.

A change of a file costs a file system 20 KiB, however small it is. Memory that outlives the process keeps
them over a kill, and the file in the data folder over a power cut. Each life of the controller has a name of
its own in memory, which the file tells: what another life, a copied or a removed data folder left there is
never taken for this one's.
"""

import os
import struct
from collections.abc import Callable
from hashlib import blake2b
from pathlib import Path
from threading import Lock
from urllib.parse import quote

from app.base.logs import get_logger
from app.base.outliving import OutlivingTwins
from app.base.twins import Twins
from app.simulation.position_memory import AxisMemory, PositionFile, PositionMemory

FORMAT = struct.Struct("<16sdd?dd?I?")
"""Whose it is; true angle, offset and zero of each axis; how often it started; whether that is trusted."""
LIFE = bytes(16)
"""Whose the record is that names the present life."""
LIFE_BYTES = 16

log = get_logger()


class KeptPositions:
    """One record a drive, found by a hash of its tracker's id; a record stays when its tracker goes.

    Without a place in memory every change goes to the disk at once. Where a zero is set or lost, or a drive
    starts, it always does.
    """

    def __init__(self, folder: Path, memory: Path | None = None) -> None:
        self._folder = folder
        self._place = memory
        self._file = Twins(folder / "positions", FORMAT.size)
        self._writing = Lock()
        self._life = b""
        self._numbers: dict[bytes, int] = {}
        self._on_disk: dict[bytes, PositionMemory] = {}
        self._stale: set[bytes] = set()
        self._when_stale: Callable[[], None] = lambda: None
        self._begun = False
        self._room_at = 0
        self._recall_disk()
        self._found = dict(self._on_disk)
        self._memory = self._in_memory(self._life) if self._life else None
        self._recall_memory()

    def of(self, tracker_id: str) -> "KeptPosition":
        """Return the memory of one tracker's drive."""
        return KeptPosition(self, blake2b(tracker_id.encode(), digest_size=16).digest(), tracker_id)

    def recall(self, key: bytes, tracker_id: str) -> PositionMemory | None:
        """Return what is kept of a drive, also by an older version in a file of its own."""
        older = PositionFile(self._folder / f"{quote(tracker_id, safe='')}.json")
        return self._found.get(key) or older.recall()

    def keep(self, key: bytes, memory: PositionMemory) -> None:
        """Take the place of what is kept of a drive; a disk that fails loses it, and the drive goes on."""
        self._note(key, memory)
        if not self._begun:
            self._begin()
        if not self._remember(key):
            self.flush()
        elif key not in self._on_disk or _zeros(memory) != _zeros(self._on_disk[key]):
            self._write(key)
        else:
            self._when_stale()

    def when_stale(self, call: Callable[[], None]) -> None:
        """Have this called as long as there is something that is not on the disk yet."""
        self._when_stale = call
        if self._stale:
            call()

    def flush(self) -> None:
        """Bring to the disk what is in memory only; any thread may wait for the disk here."""
        for key in tuple(self._stale):
            self._write(key)
        if self._stale:
            self._when_stale()

    def close(self) -> None:
        """Leave everything on the disk, and nothing in memory."""
        if not self._begun and self._memory is None:
            return
        self.flush()
        try:
            self._file.sync()
        except OSError as error:
            log.warning("simulated_position_not_kept", reason=str(error))
            return
        if not self._stale:
            self._begun = False
            self._forget()

    def _recall_disk(self) -> None:
        for content in self._file.read():
            if content is not None and len(content) == FORMAT.size:
                key, memory = _decoded(content)
                self._numbers[key] = self._room_at
                if key == LIFE:
                    self._life = content[len(LIFE) :][:LIFE_BYTES]
                else:
                    self._on_disk[key] = memory
            self._room_at += 1

    def _recall_memory(self) -> None:
        """Take what the last life left in memory: all that it kept went there first."""
        for content in () if self._memory is None else self._memory.read():
            if content is not None and len(content) == FORMAT.size:
                key, memory = _decoded(content)
                if memory != self._on_disk.get(key):
                    self._note(key, memory)

    def _note(self, key: bytes, memory: PositionMemory) -> None:
        if key not in self._numbers:
            self._numbers[key] = self._room_at
            self._room_at += 1
        self._found[key] = memory
        self._stale.add(key)

    def _begin(self) -> None:
        """Give this life a name; the last one's counts until it is on the disk."""
        self._begun = True
        last, life = self._memory, os.urandom(LIFE_BYTES)
        if LIFE not in self._numbers:
            self._numbers[LIFE] = self._room_at
            self._room_at += 1
        self._memory = None
        self._fill(life)
        with self._writing:
            told = self._put(LIFE, (LIFE + life).ljust(FORMAT.size, b"\0"))
        if not told:
            self._forget()
        self.flush()
        if last is not None:
            last.drop()

    def _fill(self, life: bytes) -> None:
        """Write everything that is known to the memory of a new life."""
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._memory = self._in_memory(life)
            if self._memory is not None:
                self._memory.make()
                for key, memory in self._found.items():
                    self._memory.write(self._numbers[key], _encoded(key, memory))
        except OSError as error:
            self._give_up(error)

    def _remember(self, key: bytes) -> bool:
        """Return whether what is kept of a drive is in memory."""
        if self._memory is not None:
            try:
                self._memory.write(self._numbers[key], _encoded(key, self._found[key]))
            except OSError as error:
                self._give_up(error)
        return self._memory is not None

    def _give_up(self, error: OSError) -> None:
        log.warning("simulated_positions_go_to_the_disk", reason=str(error))
        self._forget()

    def _forget(self) -> None:
        if self._memory is not None:
            self._memory.drop()
            self._memory = None

    def _in_memory(self, life: bytes) -> OutlivingTwins | None:
        """Return the records of a life of this very folder, not of a copy."""
        if self._place is None:
            return None
        found = self._folder.stat()
        whose = blake2b(struct.pack("<QQ", found.st_dev, found.st_ino) + life, digest_size=16)
        return OutlivingTwins(self._place, whose.hexdigest(), FORMAT.size)

    def _write(self, key: bytes) -> None:
        with self._writing:
            self._stale.discard(key)
            memory = self._found[key]
            if self._put(key, _encoded(key, memory)):
                self._on_disk[key] = memory
            else:
                self._stale.add(key)

    def _put(self, key: bytes, content: bytes) -> bool:
        try:
            self._file.write(self._numbers[key], content)
        except OSError as error:
            log.warning("simulated_position_not_kept", reason=str(error))
            return False
        return True


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


def _zeros(memory: PositionMemory) -> tuple[object, ...]:
    """Return what a drive cannot do without: it changes seldom."""
    first, second = memory.azimuth, memory.elevation
    return memory.boot_count, first.homed, first.offset_deg, second.homed, second.offset_deg


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
