"""The backups that lie in the data folder, for those who have to choose one."""

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

FOLDER = "backups"
ENDING = ".backup"


@dataclass(frozen=True, slots=True)
class BackupFile:
    """One backup: where it lies, its size, and when it was written."""

    path: Path
    size_bytes: int
    written_at: datetime


def backups(data_dir: Path) -> tuple[BackupFile, ...]:
    """Return the backups of a data folder, the newest first; what is in them is not looked at."""
    try:
        found = [_described(path) for path in (data_dir / FOLDER).glob(f"*{ENDING}")]
    except OSError:
        return ()
    return tuple(sorted(found, key=lambda one: one.written_at, reverse=True))


def _described(path: Path) -> BackupFile:
    about = path.stat()
    return BackupFile(path, about.st_size, datetime.fromtimestamp(about.st_mtime, UTC))
