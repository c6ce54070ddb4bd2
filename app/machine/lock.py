"""One process owns the drives: the lock file of a data folder says which."""

import fcntl
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

from app.base.errors import WRONG, Foreseen

LOCK_NAME = "machine.lock"


class AlreadyRunning(Foreseen):
    """Another controller service holds this data folder."""

    exit_code = WRONG


@contextmanager
def only_instance(data_dir: Path, now: datetime) -> Iterator[None]:
    """Hold the data folder for as long as the block runs, or raise `AlreadyRunning` with who holds it."""
    path = data_dir / LOCK_NAME
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            holder = os.read(descriptor, 200).decode(errors="replace").strip() or "an unknown process"
            raise AlreadyRunning(
                f"The data folder {data_dir} is in use by {holder}. "
                "Stop that one first, or give this one another folder with HELIOPANEL_DATA_DIR."
            ) from error
        os.ftruncate(descriptor, 0)
        os.pwrite(
            descriptor, f"process {os.getpid()}, running since {now:%Y-%m-%d %H:%M:%S} UTC\n".encode(), 0
        )
        yield
    finally:
        os.close(descriptor)


def holder(data_dir: Path) -> int | None:
    """Return the process id of the controller service that holds a data folder, None if nobody does."""
    try:
        with (data_dir / LOCK_NAME).open("r+", encoding="utf-8") as file:
            text = file.read()
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        found = re.match(r"process (\d+)", text)
        return int(found.group(1)) if found else None
    except FileNotFoundError:
        return None
    return None
