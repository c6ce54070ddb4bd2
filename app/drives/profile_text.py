"""TOML tables that say what is wrong with their values: file, line, key and rule."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite
from typing import Any, TypeVar

from app.modbus.errors import DriveError

T = TypeVar("T")
Word = TypeVar("Word", bound=StrEnum)


class ProfileError(DriveError):
    """A profile is missing or wrong; the text names file, line, key and rule."""


@dataclass(frozen=True, slots=True)
class Source:
    """The text that a table came from."""

    file: str
    text: str

    def error(self, key: str, rule: str) -> ProfileError:
        """Return the error that a key breaks a rule."""
        return ProfileError(f"{self.file}{self._line(key)}, {key}: {rule}.")

    def _line(self, key: str) -> str:
        """Return where the innermost part of a dotted key stands, as far as it can be found."""
        section, found = "", ""
        for number, line in enumerate(self.text.splitlines(), start=1):
            bare = line.strip()
            if bare.startswith("["):
                section = bare.partition("#")[0].strip().strip("[]").strip() + "."
                here = section.rstrip(".")
            else:
                here = section + bare.partition("=")[0].strip()
            if here and (key == here or key.startswith(here + ".")):
                found = f", line {number}"
        return found


@dataclass(frozen=True, slots=True)
class Table:
    """A TOML table that says what is wrong with its values."""

    content: Mapping[str, Any]
    source: Source
    path: str = ""

    def error(self, key: str, rule: str) -> ProfileError:
        """Return the error that a key of this table breaks a rule."""
        return self.source.error(self.path + key, rule)

    def only(self, *keys: str) -> None:
        """Raise `ProfileError` if there is a key beside these."""
        for key in self.content:
            if key not in keys:
                raise self.error(key, f"is not known here; known are {', '.join(keys)}")

    def table(self, key: str) -> "Table":
        """Return the table under a key, an empty one if there is none."""
        content = self.content.get(key, {})
        if not isinstance(content, dict):
            raise self.error(key, "must be a table")
        return Table(content, self.source, f"{self.path}{key}.")

    def get(self, key: str, kind: type[T], default: T | None = None) -> T:
        """Return the value of a key, of this type, or raise `ProfileError`."""
        value = self.content.get(key, default)
        if value is None:
            raise self.error(key, "is missing")
        if kind is float and type(value) is int:
            value = float(value)
        if type(value) is not kind or (isinstance(value, float) and not isfinite(value)):
            raise self.error(key, f"must be {_KINDS[kind]}, not {value!r}")
        return value

    def whole(self, key: str, low: int, high: int, default: int | None = None) -> int:
        """Return a whole number between two bounds."""
        value = self.get(key, int, default)
        if not low <= value <= high:
            raise self.error(key, f"must lie between {low} and {high}, not {value}")
        return value

    def word(self, key: str, words: type[Word], default: Word | None = None) -> Word:
        """Return one of some words."""
        value = self.get(key, str, default.value if default is not None else None)
        try:
            return words(value)
        except ValueError as error:
            raise self.error(key, f"must be one of {', '.join(words)}, not {value!r}") from error

    def texts(self, key: str) -> list[str]:
        """Return a list of texts."""
        found = self.content.get(key)
        if not isinstance(found, list) or not all(isinstance(one, str) for one in found):
            raise self.error(key, "must be a list of texts in quotes")
        return found

    def number(self, key: str) -> float | None:
        """Return a number, None if the key is not there."""
        return self.get(key, float) if key in self.content else None


_KINDS: dict[type, str] = {
    int: "a whole number",
    float: "a number",
    str: "text in quotes",
    bool: "true or false",
}
