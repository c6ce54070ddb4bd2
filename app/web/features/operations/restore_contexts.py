"""What the page about restoring a backup shows."""

from dataclasses import dataclass
from typing import ClassVar

from app.store.backup.backups import BackupFile
from app.web.shell.contexts import Frame


@dataclass(frozen=True, slots=True)
class RestorePage:
    """The damage (empty: none), the backups to choose from, and what was done."""

    template: ClassVar[str] = "restore.html"

    frame: Frame
    damage: str
    backups: tuple[BackupFile, ...]
    done: str
