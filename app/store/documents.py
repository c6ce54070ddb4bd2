"""Aggregates of the domain as JSON documents and back; a document that does not fit is refused by name."""

from typing import Any, Generic, TypeVar

from pydantic import ValidationError
from pydantic_core import PydanticSerializationError

from app.adapter import adapter
from app.alarms.alarm import Alarm
from app.store.store import StoreFailed
from app.tracker.config import TrackerConfig
from app.tracker.memory import SiteState, TrackerState
from app.tracker.programs.show import ShowPlan
from app.tracker.recording import RecordingInfo

T = TypeVar("T")


class Documents(Generic[T]):
    """One kind of document: the type and what to call it in a sentence."""

    def __init__(self, shape: type[T], name: str) -> None:
        self._adapter = adapter(shape)
        self._name = name

    def write(self, value: T) -> str:
        """Return the JSON of a value."""
        try:
            return self._adapter.dump_json(value).decode()
        except PydanticSerializationError as error:
            raise StoreFailed(f"The {self._name} cannot be stored: {error}.") from error

    def read(self, text: str, key: str = "") -> T:
        """Return the value of a stored document, or raise `StoreFailed` that names the record."""
        try:
            return self._adapter.validate_json(text)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(str(part) for part in first["loc"]) or "the document"
            raise StoreFailed(
                f"The stored {self._name}{f' {key!r}' if key else ''} cannot be read "
                f"({place}: {first['msg']}). Restore a backup, or install the version that wrote it."
            ) from error


SITE = Documents(SiteState, "site")
CONFIG = Documents(TrackerConfig, "settings")
TRACKER = Documents(TrackerState, "tracker")
PLAN = Documents(ShowPlan, "show")
RECORDING = Documents(RecordingInfo, "recording")
ALARM = Documents(Alarm, "alarm")
EVENT_DATA: Documents[dict[str, Any]] = Documents(dict[str, Any], "event data")


def plain(text: str) -> str:
    """Return text that both databases can hold: without NUL and without lone surrogates."""
    return text.encode("utf-8", "replace").decode().replace("\x00", "\N{REPLACEMENT CHARACTER}")
