"""What a piece of code tells the log."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from app.base.logs import NAME


class _Kept(logging.Handler):
    def __init__(self) -> None:
        super().__init__()
        self.lines: list[dict[str, Any]] = []

    def emit(self, record: logging.LogRecord) -> None:
        values: dict[str, object] = record.__dict__["values"]
        self.lines.append({"event": record.getMessage(), "log_level": record.levelname.lower(), **values})


@contextmanager
def capture_logs() -> Iterator[list[dict[str, Any]]]:
    """Collect what is told meanwhile: the event, its level and its values."""
    logger, kept = logging.getLogger(NAME), _Kept()
    before = logger.level
    logger.setLevel(logging.DEBUG)
    logger.addHandler(kept)
    try:
        yield kept.lines
    finally:
        logger.removeHandler(kept)
        logger.setLevel(before)
