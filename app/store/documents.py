"""Aggregates of the domain as JSON documents and back; a document that does not fit is refused by name."""

from collections.abc import Callable
from typing import Any, Generic, TypeVar

from pydantic import ValidationError
from pydantic_core import PydanticSerializationError

from app.alarms.alarm import Alarm
from app.base.adapter import adapter
from app.base.logs import get_logger
from app.base.message import N_, WHOLE, say, told_by
from app.store.store import StoreFailed, StoreUnreadable
from app.tracker.memory.memory import SiteState, TrackerState
from app.tracker.memory.recording import RecordingInfo
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.config import TrackerConfig

T = TypeVar("T")

log = get_logger()


class Documents(Generic[T]):
    """One kind of document: the type, what to call it in a sentence, and former names of its fields."""

    def __init__(self, shape: type[T], name: str, former: dict[str, str] | None = None) -> None:
        self._shape = shape
        self._name = name
        self._former = former or {}

    def write(self, value: T) -> str:
        """Return the JSON of a value."""
        try:
            return adapter(self._shape).dump_json(value, context=WHOLE).decode()
        except PydanticSerializationError as error:
            raise StoreFailed(
                say("The {name} cannot be stored: {error}.", name=self._name, error=told_by(error))
            ) from error

    def read(self, text: str, key: str = "") -> T:
        """Return the value of a stored document, or raise `StoreUnreadable` that names the record."""
        try:
            return adapter(self._shape).validate_json(self._today(text))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(str(part) for part in first["loc"]) or N_("the document")
            raise StoreUnreadable(
                say(
                    "The stored {name} {key} cannot be read ({place}: {first}). Restore a backup, or "
                    "install the version that wrote it.",
                    name=self._name,
                    key=repr(key),
                    place=place,
                    first=first["msg"],
                )
                if key
                else say(
                    "The stored {name} cannot be read ({place}: {first}). Restore a backup, or install "
                    "the version that wrote it.",
                    name=self._name,
                    place=place,
                    first=first["msg"],
                )
            ) from error

    def _today(self, text: str) -> str:
        """Return a document with the names of this version; a quote within a text of it is escaped."""
        for former, name in self._former.items():
            text = text.replace(f'"{former}":', f'"{name}":')
        return text


FORMER_SITE = {"light_wm2": "irradiance_wm2"}
FORMER_RECORDING = {"sun_begin_at": "sun_start", "sun_end_at": "sun_end", "frame_count": "sample_count"}

SITE = Documents(SiteState, "site", FORMER_SITE)
CONFIG = Documents(TrackerConfig, "settings")
TRACKER = Documents(TrackerState, "tracker")
PLAN = Documents(ShowPlan, "show")
RECORDING = Documents(RecordingInfo, "recording", FORMER_RECORDING)
ALARM = Documents(Alarm, "alarm")
EVENT_DATA: Documents[dict[str, Any]] = Documents(dict[str, Any], N_("event data"))


def or_none(read: Callable[[Any], T], row: Any) -> T | None:
    """Return what a row holds; one that does not fit is told in the log, and keeps nothing from starting."""
    try:
        return read(row)
    except StoreUnreadable as error:
        log.warning("not_read", reason=str(error))
        return None


def plain(text: str) -> str:
    """Return text that both databases can hold: without NUL and without lone surrogates."""
    return text.encode("utf-8", "replace").decode().replace("\x00", "\N{REPLACEMENT CHARACTER}")
