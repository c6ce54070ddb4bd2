"""Power cuts: what a process did to its files is recorded, and the disk is rebuilt as a cut would leave it.

`record` runs a process under strace and keeps every call that changes a file. `Disk` plays the calls back up
to a cut: what was synced is there; of what was not, any part may be there, in any order, torn at sectors.
That is all that a file system and a disk that tell the truth about a sync promise (POSIX `fsync`; SQLite's
own crash tests assume the same: https://www.sqlite.org/atomiccommit.html). A name is on the disk once its
folder was synced. The index file (`-shm`) is rebuilt by SQLite and does not survive.
"""

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

from tests.patience import PATIENCE_S

SECTOR = 512
NAMING = {"openat": "create", "unlink": "unlink", "unlinkat": "unlink"}
SYNCS = ("fsync", "fdatasync")
CALLS = "openat,write,pwrite64,fsync,fdatasync,ftruncate,unlink,unlinkat,rename"
LINE = re.compile(r"^\d+\s+(\w+)\((.*)\)\s+=\s+(-?\d+)")
TARGET = re.compile(r"^\d+<([^>]+)>")
QUOTED = re.compile(r'"((?:\\x[0-9a-f]{2})*)"')


@dataclass(frozen=True, slots=True)
class Call:
    """One call that changes a file of the folder: `name` says what, `file` of what name."""

    name: str
    file: str
    offset: int = 0
    data: bytes = b""


@dataclass(slots=True)
class Recording:
    """What the folder held before, and everything that was done to it."""

    before: dict[str, bytes]
    calls: list[Call]


def record(command: list[str], folder: Path, log: Path) -> Recording:
    """Run a command and return what it did to the files of a folder."""
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    tracing = ["strace", "-f", "-y", "-xx", "-s", "1000000", "-e", f"trace={CALLS}", "-e", "signal=none"]
    subprocess.run([*tracing, "-o", str(log), *command], check=True, timeout=PATIENCE_S)
    return Recording(before, list(_calls(log, folder)))


def _calls(log: Path, folder: Path) -> Iterator[Call]:
    sizes: dict[str, int] = {}
    with log.open(errors="replace") as lines:
        for line in lines:
            assert "<unfinished" not in line or str(folder) not in line, "calls of two threads overlap"
            found = LINE.match(line)
            if found is None or int(found[3]) < 0:
                continue
            call = _call(found[1], found[2], folder, sizes)
            if call is not None:
                yield call


def _call(name: str, told: str, folder: Path, sizes: dict[str, int]) -> Call | None:
    """Return what a line of strace tells; plain writes are appended to what was written before."""
    if name in NAMING:
        path = Path(_quoted(told).decode())
        if not _in(path, folder) or (name == "openat" and "O_CREAT" not in told):
            return None
        return Call(NAMING[name], path.name)
    path = _target(told)
    if path == folder and name in SYNCS:
        return Call("sync_folder", "")
    return _change(name, told, path.name, sizes) if _in(path, folder) else None


def _change(name: str, told: str, file: str, sizes: dict[str, int]) -> Call:
    match name:
        case "pwrite64":
            return Call("write", file, int(told.rpartition(", ")[2]), _quoted(told))
        case "write":
            begin, data = sizes.get(file, 0), _quoted(told)
            sizes[file] = begin + len(data)
            return Call("write", file, begin, data)
        case "ftruncate":
            return Call("truncate", file, int(told.rpartition(", ")[2]))
        case "fsync" | "fdatasync":
            return Call("sync", file)
        case _:
            raise AssertionError(f"{name} is not understood: {told[:200]}")


def _in(path: Path, folder: Path) -> bool:
    return path.parent == folder and not path.name.endswith("-shm")


def _target(told: str) -> Path:
    """Return the file of the descriptor that is a call's first argument."""
    found = TARGET.match(told)
    if found is None:
        return Path("/")
    return Path(_plain(found[1]).decode() if found[1].startswith("\\x") else found[1])


def _quoted(told: str) -> bytes:
    found = QUOTED.search(told)
    assert found is not None, told[:200]
    return _plain(found[1])


def _plain(escaped: str) -> bytes:
    return bytes.fromhex(escaped.replace("\\x", ""))


@dataclass(slots=True)
class Stored:
    """A file as the disk holds it for certain, and what was done since it was last synced."""

    data: bytearray
    pending: list[Call] = field(default_factory=list)


class Disk:
    """Files, names, and what of both is not yet safe."""

    def __init__(self, before: dict[str, bytes]) -> None:
        self._files = {name: Stored(bytearray(data)) for name, data in before.items()}
        self._names_pending: list[Call] = []
        self._named = set(self._files)

    def do(self, call: Call) -> None:
        """Have a call done."""
        match call.name:
            case "create":
                if call.file not in self._files:
                    self._files[call.file] = Stored(bytearray())
                    self._names_pending.append(call)
            case "unlink":
                self._names_pending.append(call)
            case "sync_folder":
                for pending in self._names_pending:
                    self._rename(self._named, pending)
                self._names_pending.clear()
            case "sync":
                stored = self._files[call.file]
                for pending in stored.pending:
                    _apply(stored.data, pending)
                stored.pending.clear()
            case _:
                self._files[call.file].pending.append(call)

    def cut(self, chance: Random) -> dict[str, bytes]:
        """Return the files that are there when the power is back."""
        named = set(self._named)
        for pending in self._names_pending:
            if chance.random() < 0.5:
                self._rename(named, pending)
        share = chance.choice((0.0, 0.1, 0.5, 0.9, 1.0))
        return {name: self._left(self._files[name], share, chance) for name in sorted(named)}

    def _left(self, stored: Stored, share: float, chance: Random) -> bytes:
        data = bytearray(stored.data)
        for call in stored.pending:
            if call.name != "write":
                if chance.random() < share:
                    _apply(data, call)
                continue
            for begin in range(0, len(call.data), SECTOR):
                if chance.random() < share:
                    part = call.data[begin : begin + SECTOR]
                    _apply(data, Call("write", call.file, call.offset + begin, part))
        return bytes(data)

    @staticmethod
    def _rename(named: set[str], call: Call) -> None:
        if call.name == "create":
            named.add(call.file)
        else:
            named.discard(call.file)


def _apply(data: bytearray, call: Call) -> None:
    """Do a write or a truncation to the bytes of a file; what was never written is zero."""
    if call.name == "truncate":
        del data[call.offset :]
        data.extend(bytes(call.offset - len(data)))
        return
    data.extend(bytes(max(0, call.offset - len(data))))
    data[call.offset : call.offset + len(call.data)] = call.data
