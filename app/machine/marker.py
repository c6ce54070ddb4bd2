"""Files that tell the next life of the machine how this one ended, and which version an old one was."""

import os
from datetime import datetime
from pathlib import Path

MARKER_NAME = "machine.running"
VERSION_NAME = "machine.version"


def mark_running(data_dir: Path, now: datetime) -> datetime | None:
    """Mark the machine as running; return when the last life began if it did not end properly."""
    path = data_dir / MARKER_NAME
    unclean = _began_at(path)
    fresh = path.with_suffix(".new")
    with fresh.open("w", encoding="utf-8") as file:
        file.write(now.isoformat())
        file.flush()
        os.fsync(file.fileno())
    fresh.replace(path)
    return unclean


def mark_stopped(data_dir: Path) -> None:
    """Take the mark away: this life ended properly."""
    (data_dir / MARKER_NAME).unlink(missing_ok=True)


def version_before(data_dir: Path) -> str:
    """Return the version that a file tells of; up to 0.1.0 it stood there instead of in the database."""
    try:
        return (data_dir / VERSION_NAME).read_text(encoding="utf-8").strip()
    except OSError:
        return ""


def _began_at(path: Path) -> datetime | None:
    try:
        return datetime.fromisoformat(path.read_text(encoding="utf-8").strip())
    except (OSError, ValueError):
        return None
