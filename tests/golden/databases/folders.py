"""The data folders of earlier versions, and what each version told about its own."""

import json
import tarfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
NAME, PASSWORD = "ada", "tvq9-Lumpen-47-garble"
"""The administrator of every folder; nothing but tests ever sees these data."""
LARGEST = 300_000
"""Bytes of all files of a folder: they stay in the repository for good."""


@dataclass(frozen=True, slots=True)
class Folder:
    """A data folder, packed, and the answers to questions about it by their address."""

    version: str
    path: Path

    @classmethod
    def of(cls, version: str, root: Path = HERE) -> "Folder":
        """Return the folder of a version."""
        return cls(version, root / version)

    def unpack(self, target: Path) -> None:
        """Put the data folder there."""
        with tarfile.open(self.path / "data.tar.xz") as archive:
            archive.extractall(target, filter="data")

    def told(self) -> dict[str, Any]:
        """Return what the version answered."""
        found: dict[str, Any] = json.loads((self.path / "told.json").read_text())
        return found

    def keep(self, data: Path, told: dict[str, Any]) -> None:
        """Pack a data folder and its answers."""
        self.path.mkdir()
        with tarfile.open(self.path / "data.tar.xz", "w:xz", preset=9) as archive:
            for one in sorted(data.iterdir()):
                archive.add(one, one.name, filter=_nobodys)
        (self.path / "told.json").write_text(json.dumps(told, ensure_ascii=False, indent=1) + "\n")

    def size(self) -> int:
        """Return how many bytes it takes."""
        return sum(one.stat().st_size for one in self.path.iterdir())


def folders() -> list[Folder]:
    """Return all folders, the oldest version first."""
    versions = [one.name for one in HERE.iterdir() if (one / "told.json").exists()]
    return [Folder.of(one) for one in sorted(versions, key=lambda one: [int(n) for n in one.split(".")])]


def _nobodys(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    entry.uid = entry.gid = entry.mtime = 0
    entry.uname = entry.gname = ""
    return entry
