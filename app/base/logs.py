"""One structured log for all processes: JSON lines or readable text, on standard error.

It stands on the standard library alone: the library that did this took 6 MB of every process.
"""

import json
import logging
import re
import sys
import traceback
from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any, Literal, TextIO

NAME = "heliopanel"
SECRET = re.compile(r"\b((?:stop_)?ticket|token)=[^&\s\"']+")
MOST_FRAMES = 50
COLOURS = {"debug": 32, "info": 32, "warning": 33, "error": 31, "critical": 31}

EACH_SOCKET = frozenset({"connection open", '%s - "WebSocket %s" [accepted]'})
"""What uvicorn and websockets tell of every live page that opens: nobody reads it, and it holds up others."""


class Log:
    """Tells what happened: the event in a few words, and values by their names."""

    def __init__(self, logger: logging.Logger) -> None:
        self._logger = logger

    def debug(self, event: str, **values: object) -> None:
        """Tell what only those who look for a fault want to know."""
        self._logger.log(logging.DEBUG, event, extra={"values": values})

    def info(self, event: str, **values: object) -> None:
        """Tell what is as it should be."""
        self._logger.log(logging.INFO, event, extra={"values": values})

    def warning(self, event: str, **values: object) -> None:
        """Tell what somebody should look at."""
        self._logger.log(logging.WARNING, event, extra={"values": values})

    def error(self, event: str, **values: object) -> None:
        """Tell what failed."""
        self._logger.log(logging.ERROR, event, extra={"values": values})

    def critical(self, event: str, *, exc_info: BaseException | None = None, **values: object) -> None:
        """Tell what endangers the drives or the data, with the traceback of an exception."""
        self._logger.log(logging.CRITICAL, event, exc_info=exc_info, extra={"values": values})

    def exception(self, event: str, **values: object) -> None:
        """Tell what failed, with the traceback of the exception that is being handled."""
        self._logger.log(logging.ERROR, event, exc_info=True, extra={"values": values})


def get_logger() -> Log:
    """Return the log of this process."""
    return Log(logging.getLogger(NAME))


def set_up_logs(
    process: str, *, log_format: Literal["json", "text"], log_level: str, stream: TextIO | None = None
) -> None:
    """Send this process's log, the libraries' included, to standard error in one form."""
    target = stream or sys.stderr
    handler = logging.StreamHandler(target)
    handler.setFormatter(AsJson(process) if log_format == "json" else AsText(process, target.isatty()))
    root = logging.getLogger()
    for old in tuple(root.handlers):
        root.removeHandler(old)
    root.addHandler(handler)
    root.setLevel(_number(log_level))
    for chatty in ("pymodbus", "alembic", "asyncio"):
        logging.getLogger(chatty).setLevel(max(logging.WARNING, _number(log_level)))
    logging.getLogger("uvicorn.error").addFilter(_is_no_mere_socket)


def told(record: logging.LogRecord, process: str) -> dict[str, object]:
    """Return what a line of the log says; tickets in addresses are left out: no reader shall use them."""
    values: dict[str, object] = getattr(record, "values", {})
    at = datetime.fromtimestamp(record.created, UTC).isoformat(timespec="microseconds")
    return {
        "timestamp": at.replace("+00:00", "Z"),
        "level": record.levelname.lower(),
        "event": SECRET.sub(r"\1=...", record.getMessage()),
        "process": process,
        **values,
    }


class AsJson(logging.Formatter):
    """One JSON object a line; of an exception type, text and places, never the values of variables."""

    def __init__(self, process: str) -> None:
        super().__init__()
        self._process = process

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        line = told(record, self._process)
        if record.exc_info and record.exc_info[1] is not None:
            line["exception"] = list(_chain(record.exc_info[1]))
        if record.stack_info:
            line["stack"] = record.stack_info
        return json.dumps(line, default=repr)


def _chain(error: BaseException) -> Iterator[dict[str, Any]]:
    """Yield an exception, what it came from, and so on; each with its places, the outermost first."""
    seen: set[int] = set()
    following: BaseException | None = error
    while following is not None and id(following) not in seen:
        seen.add(id(following))
        frames = traceback.extract_tb(following.__traceback__, limit=-MOST_FRAMES)
        yield {
            "exc_type": type(following).__name__,
            "exc_value": str(following),
            "frames": [{"filename": at.filename, "lineno": at.lineno, "name": at.name} for at in frames],
            "exceptions": [list(_chain(one)) for one in getattr(following, "exceptions", ())],
        }
        hidden = following.__suppress_context__
        following = following.__cause__ or (None if hidden else following.__context__)


class AsText(logging.Formatter):
    """A line for people, coloured on a terminal; a traceback below it, without the values of variables."""

    def __init__(self, process: str, is_coloured: bool) -> None:
        super().__init__()
        self._process = process
        self._is_coloured = is_coloured

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        line = told(record, self._process)
        at, level, event = (str(line.pop(name)) for name in ("timestamp", "level", "event"))
        shown = f"[{level:<8}]"
        if self._is_coloured:
            shown = f"\x1b[{COLOURS.get(level, 0)}m{shown}\x1b[0m"
        pairs = " ".join(f"{name}={_on_one_line(value)}" for name, value in line.items())
        lines = [f"{at} {shown} {event:<30} {pairs}"]
        if record.exc_info:
            lines.append(self.formatException(record.exc_info))
        if record.stack_info:
            lines.append(record.stack_info)
        return "\n".join(lines)


def _on_one_line(value: object) -> str:
    """Return a value as it is, or as Python writes it where it could pass for more than itself."""
    return value if isinstance(value, str) and value.isprintable() else repr(value)


def _is_no_mere_socket(record: logging.LogRecord) -> bool:
    return record.msg not in EACH_SOCKET


def _number(level: str) -> int:
    return logging.getLevelNamesMapping()[level.upper()]
