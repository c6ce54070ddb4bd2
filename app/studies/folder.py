"""Studies and weather files in the data folder: plain files, written whole and put in place at once."""

import re
import shutil
from collections.abc import Iterable
from dataclasses import dataclass, replace
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from unicodedata import normalize

from pydantic import ValidationError

from app.base.adapter import adapter
from app.base.message import N_, join, say
from app.studies.jobs import WeatherSeen
from app.studies.request import StudyRequest
from app.studies.result import StudyResult

MOST_STUDIES = 100
MOST_WEATHER_FILES = 20
LARGEST_WEATHER = 8 * 1024 * 1024
LONGEST_FILE_NAME = 120
MOST_NAME_BYTES = 240
"""Linux takes 255, the endings of our own among them."""
OUR_ENDINGS = (".json", ".new", ".part")
JOINERS = "\N{ZERO WIDTH NON-JOINER}\N{ZERO WIDTH JOINER}"
STUDY_ID = re.compile(r"[0-9]{8}T[0-9]{6}-[0-9a-f]{6}")
INTERRUPTED = N_("Heliopanel was restarted while the study was running; run the study again.")


class StudyUnknown(LookupError):
    """There is no such study or weather file; the text says which."""


class WeatherFileRefused(ValueError):
    """A weather file cannot be taken; the text says why."""


class StudyStatus(StrEnum):
    """How far a study is."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


OPEN = frozenset({StudyStatus.WAITING, StudyStatus.RUNNING})


@dataclass(frozen=True, slots=True)
class StudyState:
    """One study in the list. `done` of `of` cases are worked out; `message` says why it failed."""

    study_id: str
    title: str
    asked_at: datetime
    status: StudyStatus
    done: int = 0
    of: int = 1
    doing: str = ""
    message: str = ""

    @property
    def is_open(self) -> bool:
        """Return whether it is waiting or running."""
        return self.status in OPEN

    @property
    def percent(self) -> int:
        """Return how much is done."""
        return 100 if self.status is StudyStatus.DONE else 100 * self.done // max(1, self.of)


def weather_name(given: str) -> str:
    """Return the name under which a file is kept: composed, with plain spaces. Raises `WeatherFileRefused`.

    macOS and phones decompose letters, and two names that look alike must be one.
    """
    name = normalize("NFC", given.replace("\N{NO-BREAK SPACE}", " ")).strip()
    fits = 1 <= len(name) <= LONGEST_FILE_NAME and len(name.encode(errors="replace")) <= MOST_NAME_BYTES
    usual = all(one.isprintable() or one in JOINERS for one in name) and not set(name) & set("/\\")
    if not (fits and usual) or name.startswith(".") or name.endswith(OUR_ENDINGS):
        raise WeatherFileRefused(
            say(
                "Name the weather file with at most {longest} letters, digits, and other characters, without "
                "slashes, not beginning with a dot, and not ending in {endings}.",
                longest=LONGEST_FILE_NAME,
                endings=join(", ", OUR_ENDINGS),
            )
        )
    return name


@dataclass(frozen=True, slots=True)
class WeatherFile:
    """One stored weather file and what it is."""

    name: str
    size: int
    seen: WeatherSeen


class StudyFolder:
    """`studies/<id>/` with state, request and result, and `weather/` with files and what each is."""

    def __init__(self, data: Path) -> None:
        self._studies = data / "studies"
        self._weather = data / "weather"

    def open(self, state: StudyState, request: StudyRequest) -> None:
        """Keep a new study; the oldest that are not under way go, so that no more than a hundred stay."""
        ended = [one for one in self.states(()) if not one.is_open]
        for old in ended[MOST_STUDIES - 1 :]:
            self.delete(old.study_id)
        folder = self._studies / state.study_id
        folder.mkdir(parents=True)
        _write(folder / "request.json", adapter(StudyRequest).dump_json(request))
        self.note(state)

    def note(self, state: StudyState) -> None:
        """Keep how far a study is."""
        _write(self._folder(state.study_id) / "state.json", adapter(StudyState).dump_json(state))

    def keep(self, study_id: str, result: StudyResult) -> None:
        """Keep what a study found."""
        _write(self._folder(study_id) / "result.json", adapter(StudyResult).dump_json(result))

    def states(self, alive: Iterable[str]) -> list[StudyState]:
        """Return all studies, newest first; one that is open but not alive was interrupted."""
        if not self._studies.is_dir():
            return []
        names = sorted((one.name for one in self._studies.iterdir()), reverse=True)
        read = (self._state(name) for name in names if STUDY_ID.fullmatch(name))
        living = frozenset(alive)
        return [_interrupted(one, living) for one in read if one is not None]

    def state(self, study_id: str, alive: Iterable[str]) -> StudyState:
        """Return one study; raises `StudyUnknown`."""
        self._folder(study_id)
        found = self._state(study_id)
        if found is None:
            raise StudyUnknown(say("There is no study {study_id}.", study_id=study_id))
        return _interrupted(found, frozenset(alive))

    def request(self, study_id: str) -> StudyRequest:
        """Return what a study was asked."""
        return adapter(StudyRequest).validate_json(self._read(study_id, "request.json"))

    def result(self, study_id: str) -> StudyResult:
        """Return what a study found; raises `StudyUnknown` while there is nothing."""
        return adapter(StudyResult).validate_json(self._read(study_id, "result.json"))

    def delete(self, study_id: str) -> None:
        """Remove a study and everything of it."""
        shutil.rmtree(self._folder(study_id))

    def weather_files(self) -> list[WeatherFile]:
        """Return the stored weather files by name."""
        if not self._weather.is_dir():
            return []
        heads = sorted(self._weather.glob("*.json"))
        found = []
        for head in heads:
            path = head.with_suffix("")
            if path.is_file():
                found.append(
                    WeatherFile(
                        path.name, path.stat().st_size, adapter(WeatherSeen).validate_json(head.read_bytes())
                    )
                )
        return found

    def weather_path(self, name: str) -> Path:
        """Return where a stored weather file lies; raises `StudyUnknown`."""
        try:
            path = self._weather / weather_name(name)
        except WeatherFileRefused:
            path = None
        if path is None or not path.is_file():
            raise StudyUnknown(say("There is no weather file {name}: upload it first.", name=repr(name)))
        return path

    def put_weather(self, name: str, content: bytes) -> Path:
        """Keep the bytes of a weather file that is yet to be looked at; raises `WeatherFileRefused`.

        `name` is one of `weather_name`.
        """
        self._check_weather(name, content)
        self._weather.mkdir(parents=True, exist_ok=True)
        path = self._weather / f"{name}.new"
        path.write_bytes(content)
        return path

    def accept_weather(self, name: str, new: Path, seen: WeatherSeen) -> WeatherFile:
        """Keep a weather file that was found good under its name."""
        path = new.replace(self._weather / name)
        _write(path.with_name(f"{name}.json"), adapter(WeatherSeen).dump_json(seen))
        return WeatherFile(name, path.stat().st_size, seen)

    def delete_weather(self, name: str) -> None:
        """Remove a weather file; studies that were made with it stay."""
        path = self.weather_path(name)
        path.with_name(f"{name}.json").unlink(missing_ok=True)
        path.unlink()

    def _check_weather(self, name: str, content: bytes) -> None:
        if not content:
            raise WeatherFileRefused(N_("The weather file is empty: choose the file again."))
        if len(content) > LARGEST_WEATHER:
            raise WeatherFileRefused(
                say(
                    "A weather file has at most {largest_weather} megabytes.",
                    largest_weather=LARGEST_WEATHER // 1024 // 1024,
                )
            )
        others = [one for one in self.weather_files() if one.name != name]
        if len(others) >= MOST_WEATHER_FILES:
            raise WeatherFileRefused(
                say(
                    "There are already {most_weather_files} weather files: delete one that is not needed.",
                    most_weather_files=MOST_WEATHER_FILES,
                )
            )

    def _state(self, name: str) -> StudyState | None:
        """Return a stored state; None for a folder that is none, or is being removed."""
        try:
            return adapter(StudyState).validate_json((self._studies / name / "state.json").read_bytes())
        except (OSError, ValidationError):
            return None

    def _folder(self, study_id: str) -> Path:
        folder = self._studies / study_id
        if STUDY_ID.fullmatch(study_id) is None or not folder.is_dir():
            raise StudyUnknown(say("There is no study {study_id}.", study_id=study_id))
        return folder

    def _read(self, study_id: str, name: str) -> bytes:
        path = self._folder(study_id) / name
        try:
            return path.read_bytes()
        except FileNotFoundError:
            raise StudyUnknown(
                say("The study {study_id} has no result yet: wait until it is done.", study_id=study_id)
            ) from None


def _interrupted(state: StudyState, alive: frozenset[str]) -> StudyState:
    if not state.is_open or state.study_id in alive:
        return state
    return replace(state, status=StudyStatus.FAILED, message=INTERRUPTED)


def _write(path: Path, content: bytes) -> None:
    """Write a file whole or not at all."""
    new = path.with_suffix(".part")
    new.write_bytes(content)
    new.replace(path)
