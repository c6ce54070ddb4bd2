"""What a line of the log looks like, for programs and for people."""

import io
import json
import logging
from collections.abc import Iterator
from typing import Literal

import pytest

from app.base.logs import get_logger, set_up_logs


@pytest.fixture(autouse=True)
def _logs_as_before() -> Iterator[None]:
    """Leave the loggers of this process as they were."""
    root = logging.getLogger()
    handlers, level = list(root.handlers), root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)
    logging.getLogger("uvicorn.error").filters.clear()


def told_by(log_format: Literal["json", "text"]) -> io.StringIO:
    stream = io.StringIO()
    set_up_logs("controller", log_format=log_format, log_level="info", stream=stream)
    return stream


def fail() -> None:
    try:
        raise KeyError("first")
    except KeyError as error:
        raise ExceptionGroup("both", [OSError("disk"), ValueError("number")]) from error


def test_an_exception_is_told_with_what_it_came_from_and_where() -> None:
    stream = told_by("json")
    try:
        fail()
    except ExceptionGroup:
        get_logger().exception("tick_failed", tracker="T1")
    line = json.loads(stream.getvalue())
    assert (line["level"], line["event"], line["tracker"]) == ("error", "tick_failed", "T1")
    assert line["timestamp"].endswith("Z")
    both, first = line["exception"]
    assert (both["exc_type"], first["exc_type"], first["exc_value"]) == (
        "ExceptionGroup",
        "KeyError",
        "'first'",
    )
    assert [frame["name"] for frame in both["frames"]][-1] == "fail"
    assert [one[0]["exc_value"] for one in both["exceptions"]] == ["disk", "number"]


def test_a_line_for_people_is_one_line() -> None:
    stream = told_by("text")
    get_logger().warning("link_dropped", reason="two\nlines", code=3)
    (line,) = stream.getvalue().splitlines()
    assert line.split(maxsplit=1)[1] == (
        "[warning ] link_dropped                   process=controller reason='two\\nlines' code=3"
    )


def test_what_json_does_not_know_is_told_as_python_writes_it() -> None:
    stream = told_by("json")
    get_logger().info("seen", at=frozenset({1}))
    assert json.loads(stream.getvalue())["at"] == "frozenset({1})"
