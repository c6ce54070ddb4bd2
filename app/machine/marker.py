"""A file that exists while the machine runs: found at a start, it tells that the last life ended badly."""

import os
from datetime import datetime
from pathlib import Path

MARKER_NAME = "machine.running"


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


def _began_at(path: Path) -> datetime | None:
    try:
        return datetime.fromisoformat(path.read_text(encoding="utf-8").strip())
    except (OSError, ValueError):
        return None
