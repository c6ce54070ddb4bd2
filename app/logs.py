"""One structured log for both processes: JSON lines or readable text, on standard error."""

import logging
import re
import sys
from typing import Literal, TextIO

import structlog

SECRET = re.compile(r"\b((?:stop_)?ticket|token)=[^&\s\"']+")

EACH_SOCKET = frozenset({"connection open", '%s - "WebSocket %s" [accepted]'})
"""What uvicorn and websockets tell of every live page that opens: nobody reads it, and it holds up others."""


def _masked(_: object, __: str, told: structlog.typing.EventDict) -> structlog.typing.EventDict:
    """Leave tickets out of the addresses that servers log: whoever reads the log shall not use them."""
    told["event"] = SECRET.sub(r"\1=...", str(told["event"]))
    return told


WITHOUT_VALUES = structlog.processors.ExceptionRenderer(
    structlog.tracebacks.ExceptionDictTransformer(show_locals=False)
)
"""Tracebacks without the values of variables: passwords and cookies are among them."""

SHARED = (
    _masked,
    structlog.contextvars.merge_contextvars,
    structlog.processors.add_log_level,
    structlog.processors.TimeStamper(fmt="iso", utc=True),
    structlog.processors.StackInfoRenderer(),
)


def set_up_logs(
    process: str, *, log_format: Literal["json", "text"], log_level: str, stream: TextIO | None = None
) -> None:
    """Send this process's log, the libraries' included, to standard error in one form."""
    target = stream or sys.stderr
    structlog.contextvars.clear_contextvars()
    structlog.contextvars.bind_contextvars(process=process)
    structlog.configure(
        processors=[*SHARED, structlog.stdlib.ProcessorFormatter.wrap_for_formatter],
        wrapper_class=structlog.make_filtering_bound_logger(_number(log_level)),
        logger_factory=structlog.stdlib.LoggerFactory(),
        cache_logger_on_first_use=False,
    )
    handler = logging.StreamHandler(target)
    handler.setFormatter(_formatter(log_format, target))
    root = logging.getLogger()
    for old in tuple(root.handlers):
        root.removeHandler(old)
    root.addHandler(handler)
    root.setLevel(_number(log_level))
    for chatty in ("pymodbus", "alembic", "asyncio"):
        logging.getLogger(chatty).setLevel(max(logging.WARNING, _number(log_level)))
    logging.getLogger("uvicorn.error").addFilter(_is_no_mere_socket)


def _is_no_mere_socket(record: logging.LogRecord) -> bool:
    return record.msg not in EACH_SOCKET


def _formatter(log_format: Literal["json", "text"], target: TextIO) -> structlog.stdlib.ProcessorFormatter:
    tail: list[structlog.typing.Processor] = [structlog.stdlib.ProcessorFormatter.remove_processors_meta]
    if log_format == "json":
        tail += [WITHOUT_VALUES, structlog.processors.JSONRenderer()]
    else:
        plain = structlog.dev.plain_traceback
        tail += [structlog.dev.ConsoleRenderer(colors=target.isatty(), exception_formatter=plain)]
    return structlog.stdlib.ProcessorFormatter(foreign_pre_chain=list(SHARED), processors=tail)


def _number(level: str) -> int:
    return logging.getLevelNamesMapping()[level.upper()]
