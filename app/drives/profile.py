"""Drive profiles: what a device offers on its bus, as a TOML file. Adding a drive is adding a file."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import timedelta
from enum import StrEnum
from pathlib import Path
from typing import Any, TypeVar

from app.drives.drive import DriveError
from app.drives.register import Access, Register, WordOrder, WordType

PROFILES = Path(__file__).parent / "profiles"
MOST_REGISTERS = 125
LAST_ADDRESS = 0xFFFF

T = TypeVar("T")
Word = TypeVar("Word", bound=StrEnum)


class ProfileError(DriveError):
    """A profile is missing or wrong; the text names file, line, key and rule."""


class Adapter(StrEnum):
    """Which code turns the registers into the drive protocol."""

    PLC = "plc"


@dataclass(frozen=True, slots=True)
class Block:
    """Neighbouring registers that are read or written in one frame."""

    name: str
    address: int
    count: int


@dataclass(frozen=True, slots=True)
class Watchdog:
    """The device's own communication watchdog: what feeds it, when it trips and what it does then."""

    register: str
    timeout_ms: int
    readback: str | None
    action: str


@dataclass(frozen=True, slots=True)
class Profile:
    """Everything that is known about one kind of device."""

    name: str
    title: str
    adapter: Adapter
    verified: bool
    source: str
    timeout_ms: int
    poll_ms: int
    watchdog: Watchdog | None
    blocks: Mapping[str, Block]
    registers: Mapping[str, Register]
    bits: Mapping[str, Mapping[str, int]]
    enums: Mapping[str, Mapping[str, int]]

    @property
    def timeout(self) -> timedelta:
        """Return after which time a reply counts as none."""
        return timedelta(milliseconds=self.timeout_ms)

    def at(self, address: int) -> str:
        """Return a register by its address in words for people."""
        for register in self.registers.values():
            if address in register.addresses:
                return f"{register.name} ({address})"
        return str(address)


def known_profiles() -> tuple[str, ...]:
    """Return the names of the profiles that come with this program."""
    return tuple(sorted(path.stem for path in PROFILES.glob("*.toml")))


def load_profile(name: str) -> Profile:
    """Return a profile by its name or by the path of its file, or raise `ProfileError`."""
    path = Path(name) if name.endswith(".toml") else PROFILES / f"{name}.toml"
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ProfileError(
            f"There is no drive profile {name!r}. Choose one of {', '.join(known_profiles())}, "
            "or give the path of a .toml file."
        ) from error
    return parse_profile(text, path.name)


def parse_profile(text: str, file: str) -> Profile:
    """Return the profile that a TOML text describes, or raise `ProfileError`."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ProfileError(f"{file}: this is not TOML: {error}.") from error
    profile = _profile(_Table(content, _Source(file, text)))
    _check_overlaps(profile, _Source(file, text))
    return profile


@dataclass(frozen=True, slots=True)
class _Source:
    file: str
    text: str

    def error(self, key: str, rule: str) -> ProfileError:
        return ProfileError(f"{self.file}{self._line(key)}, {key}: {rule}.")

    def _line(self, key: str) -> str:
        """Return where the innermost part of a dotted key stands, as far as it can be found."""
        section, found = "", ""
        for number, line in enumerate(self.text.splitlines(), start=1):
            bare = line.strip()
            if bare.startswith("["):
                section = bare.strip("[]").strip() + "."
                here = section.rstrip(".")
            else:
                here = section + bare.partition("=")[0].strip()
            if here and (key == here or key.startswith(here + ".")):
                found = f", line {number}"
        return found


@dataclass(frozen=True, slots=True)
class _Table:
    """A TOML table that says what is wrong with its values."""

    content: Mapping[str, Any]
    source: _Source
    path: str = ""

    def error(self, key: str, rule: str) -> ProfileError:
        return self.source.error(self.path + key, rule)

    def only(self, *keys: str) -> None:
        for key in self.content:
            if key not in keys:
                raise self.error(key, f"is not known here; known are {', '.join(keys)}")

    def table(self, key: str) -> "_Table":
        content = self.content.get(key, {})
        if not isinstance(content, dict):
            raise self.error(key, "must be a table")
        return _Table(content, self.source, f"{self.path}{key}.")

    def get(self, key: str, kind: type[T], default: T | None = None) -> T:
        value = self.content.get(key, default)
        if value is None:
            raise self.error(key, "is missing")
        if kind is float and type(value) is int:
            value = float(value)
        if type(value) is not kind:
            raise self.error(key, f"must be {_KINDS[kind]}, not {value!r}")
        return value

    def whole(self, key: str, low: int, high: int, default: int | None = None) -> int:
        value = self.get(key, int, default)
        if not low <= value <= high:
            raise self.error(key, f"must lie between {low} and {high}, not {value}")
        return value

    def word(self, key: str, words: type[Word], default: Word | None = None) -> Word:
        value = self.get(key, str, default.value if default is not None else None)
        try:
            return words(value)
        except ValueError as error:
            raise self.error(key, f"must be one of {', '.join(words)}, not {value!r}") from error

    def limit(self, key: str) -> float | None:
        return self.get(key, float) if key in self.content else None


_KINDS: dict[type, str] = {
    int: "a whole number",
    float: "a number",
    str: "text in quotes",
    bool: "true or false",
}
_TOP = (
    "name", "title", "adapter", "word_order", "verified", "source", "timing", "watchdog", "blocks",
    "registers", "bits", "enums",
)  # fmt: skip
_REGISTER = (
    "address", "type", "word_order", "scale", "sign", "unit", "access", "minimum", "maximum", "expect",
    "text", "source", "verified",
)  # fmt: skip


def _profile(top: _Table) -> Profile:
    top.only(*_TOP)
    order = top.word("word_order", WordOrder, WordOrder.HIGH_FIRST)
    verified, source = top.get("verified", bool), top.get("source", str)
    rows = top.table("registers")
    registers = {
        name: _register(name, rows.table(name), order, source, verified=verified) for name in rows.content
    }
    timing = top.table("timing")
    return Profile(
        name=top.get("name", str),
        title=top.get("title", str),
        adapter=top.word("adapter", Adapter),
        verified=verified and all(register.verified for register in registers.values()),
        source=source,
        timeout_ms=timing.whole("timeout_ms", 20, 5000, 300),
        poll_ms=timing.whole("poll_ms", 20, 5000, 100),
        watchdog=_watchdog(top.table("watchdog"), registers),
        blocks={name: _block(name, top.table("blocks").table(name)) for name in top.table("blocks").content},
        registers=registers,
        bits={name: _numbers(top.table("bits").table(name), 15) for name in top.table("bits").content},
        enums={
            name: _numbers(top.table("enums").table(name), LAST_ADDRESS)
            for name in top.table("enums").content
        },
    )


def _register(name: str, row: _Table, order: WordOrder, source: str, *, verified: bool) -> Register:
    row.only(*_REGISTER)
    scale = row.get("scale", float, 1.0)
    if scale <= 0.0:
        raise row.error("scale", f"must be above zero, not {scale}; use sign = -1 to turn a direction")
    sign = row.whole("sign", -1, 1, 1)
    if sign == 0:
        raise row.error("sign", "must be 1 or -1")
    return Register(
        name=name,
        address=row.whole("address", 0, LAST_ADDRESS),
        type=row.word("type", WordType),
        order=row.word("word_order", WordOrder, order),
        scale=scale,
        sign=sign,
        unit=row.get("unit", str, ""),
        access=row.word("access", Access, Access.READ),
        minimum=row.limit("minimum"),
        maximum=row.limit("maximum"),
        expect=row.whole("expect", 0, LAST_ADDRESS) if "expect" in row.content else None,
        text=row.get("text", str, ""),
        source=row.get("source", str, source),
        verified=row.get("verified", bool, verified),
    )


def _block(name: str, row: _Table) -> Block:
    row.only("address", "count")
    return Block(name, row.whole("address", 0, LAST_ADDRESS), row.whole("count", 1, MOST_REGISTERS))


def _watchdog(row: _Table, registers: Mapping[str, Register]) -> Watchdog | None:
    if not row.content:
        return None
    row.only("register", "timeout_ms", "readback", "action")
    for key in ("register", "readback"):
        if key in row.content and row.get(key, str) not in registers:
            raise row.error(key, f"names no register: {row.get(key, str)!r}")
    return Watchdog(
        register=row.get("register", str),
        timeout_ms=row.whole("timeout_ms", 50, 60_000),
        readback=row.get("readback", str) if "readback" in row.content else None,
        action=row.get("action", str),
    )


def _numbers(row: _Table, highest: int) -> dict[str, int]:
    numbers = {name: row.whole(name, 0, highest) for name in row.content}
    for name, number in numbers.items():
        if list(numbers.values()).count(number) > 1:
            raise row.error(name, f"has the number {number}, which is given twice")
    return numbers


def _check_overlaps(profile: Profile, source: _Source) -> None:
    taken: dict[int, str] = {}
    for register in profile.registers.values():
        for address in register.addresses:
            if address in taken:
                raise source.error(
                    f"registers.{register.name}.address",
                    f"address {address} is taken by {taken[address]}",
                )
            taken[address] = register.name
