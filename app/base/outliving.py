"""Records in memory that outlives the process: a kill loses nothing, a power cut all of it, no disk wears."""

import os
import stat
from contextlib import suppress
from pathlib import Path

from app.base.twins import Twins

SHARED_MEMORY = Path("/dev/shm")  # noqa: S108  # nosec B108
"""Each makes a folder there that nobody else can open."""


def memory_beside(folder: Path) -> Path | None:
    """Return where such records can be, None where there is but the disk that holds this folder.

    A service of systemd is given a place that is its own; the one that all programs share comes second.
    """
    given = os.environ.get("RUNTIME_DIRECTORY", "").partition(":")[0]
    places = (Path(given), SHARED_MEMORY) if given else (SHARED_MEMORY,)
    return next((place for place in places if _fits(place, folder)), None)


def _fits(place: Path, folder: Path) -> bool:
    try:
        elsewhere = place.stat().st_dev != folder.stat().st_dev
    except OSError:
        return False
    return elsewhere and os.access(place, os.R_OK | os.W_OK | os.X_OK)


class OutlivingTwins:
    """Records in a folder that this user alone can open, found again by its name."""

    def __init__(self, place: Path, name: str, room: int) -> None:
        self._folder = place / f"heliopanel-{name}"
        self._path = self._folder / "records"
        self._twins = Twins(self._path, room)

    def read(self) -> list[bytes | None]:
        """Return the content of every record; what somebody else may have put there is not looked at."""
        return self._twins.read() if self._is_own() else []

    def make(self) -> None:
        """Make the folder, or raise `OSError`: there must be none."""
        self._folder.mkdir(mode=0o700)

    def write(self, number: int, content: bytes) -> None:
        """Overwrite the older copy of a record, or raise `OSError`, also where the file was removed."""
        self._twins.write(number, content)
        self._path.stat()

    def drop(self) -> None:
        """Remove it."""
        if self._is_own():
            with suppress(OSError):
                self._path.unlink(missing_ok=True)
                self._folder.rmdir()

    def _is_own(self) -> bool:
        try:
            found = self._folder.lstat()
        except OSError:
            return False
        private = not stat.S_IMODE(found.st_mode) & 0o077
        return stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and private
