"""Drive profiles: what a device offers on its bus, as a TOML file. Adding a drive is adding a file."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from app.base.file_text import TextRefused, utf8_of
from app.drives.profile_rules import (
    LAST_ADDRESS,
    check_bits,
    check_blocks,
    check_enums,
    check_name,
    check_registers,
    check_step,
)
from app.drives.profile_text import ProfileError as ProfileError
from app.drives.profile_text import Source, Table
from app.drives.register import Access, Register, WordOrder, WordType
from app.modbus.wire import Timing

PROFILES = Path(__file__).parent / "profiles"
SUFFIX = ".toml"
MOST_REGISTERS = 125
DEFAULT_TIMEOUT_MS = 300
LAST_BIT = 31
MOST_TRACKERS = 100


class Adapter(StrEnum):
    """Which code turns the registers into the drive protocol."""

    PLC = "plc"
    CIA402 = "cia402"
    PR = "pr"
    DIRECT = "direct"
    SUNSPEC = "sunspec"

    @property
    def counts_degrees(self) -> bool:
        """Return whether the device speaks degrees of the axes, not steps of motors."""
        return self in (Adapter.PLC, Adapter.SUNSPEC)

    @property
    def has_unit_per_axis(self) -> bool:
        """Return whether each axis is a device of its own on the bus."""
        return not self.counts_degrees


@dataclass(frozen=True, slots=True)
class Block:
    """Neighbouring registers that are read or written in one frame."""

    name: str
    address: int
    count: int

    @property
    def addresses(self) -> range:
        """Return the addresses that the block takes."""
        return range(self.address, self.address + self.count)


@dataclass(frozen=True, slots=True)
class SequenceStep:
    """One write of a sequence: a register and the number that goes into it."""

    register: str
    value: int


@dataclass(frozen=True, slots=True)
class Watchdog:
    """The device's own communication watchdog: what feeds it, when it trips and what it does then.

    `register` None says that every request feeds it.
    """

    register: str | None
    timeout_ms: int
    readback: str | None
    action: str


@dataclass(frozen=True, slots=True)
class Profile:
    """Everything that is known about one kind of device.

    `tracker` counts from 1: which tracker of a SunSpec controller that has several.
    """

    name: str
    title: str
    adapter: Adapter
    word_order: WordOrder
    verified: bool
    source: str
    timeout_ms: int
    poll_ms: int
    rest_ms: int
    longest_reply_ms: int
    watchdog: Watchdog | None
    blocks: Mapping[str, Block]
    registers: Mapping[str, Register]
    bits: Mapping[str, Mapping[str, int]]
    enums: Mapping[str, Mapping[str, int]]
    sequences: Mapping[str, tuple[SequenceStep, ...]]
    steps_per_revolution: float
    tracker: int
    text: Source

    @property
    def unverified(self) -> tuple[str, ...]:
        """Return the names of the registers that nobody has tried on a device or found in its manual."""
        return tuple(register.name for register in self.registers.values() if not register.verified)

    @property
    def timing(self) -> Timing:
        """Return what the device needs on its bus."""
        longest_s = self.longest_reply_ms / 1000.0 if self.longest_reply_ms else None
        polled = sum(block.count for name, block in self.blocks.items() if name != "clock")
        return Timing(self.timeout_ms / 1000.0, self.rest_ms / 1000.0, longest_s, polled)

    def block_of(self, register: Register) -> Block | None:
        """Return the block that a register is read with, None if it is read alone."""
        for block in self.blocks.values():
            if all(address in block.addresses for address in register.addresses):
                return block
        return None

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
    path = Path(name) if name.endswith(SUFFIX) else PROFILES / f"{name}{SUFFIX}"
    try:
        return read_profile(path)
    except OSError as error:
        raise ProfileError(
            f"There is no drive profile {name!r}. Choose one of {', '.join(known_profiles())}, "
            "or give the path of a .toml file."
        ) from error


def read_profile(path: Path) -> Profile:
    """Return the profile in a file, or raise `ProfileError` or `OSError`."""
    content = path.read_bytes()
    try:
        text = utf8_of(content)
    except TextRefused as error:
        wrong = error.__cause__
        before = content[: wrong.start] if isinstance(wrong, UnicodeDecodeError) else b""
        line = before.count(b"\n") + 1
        raise ProfileError(f"{path.name}, line {line}: this is not UTF-8 text. Save it as UTF-8.") from error
    return parse_profile(text, path.name)


def parse_profile(text: str, file: str) -> Profile:
    """Return the profile that a TOML text describes, or raise `ProfileError`."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ProfileError(f"{file}: this is not TOML: {error}.") from error
    source = Source(file, text)
    profile = _profile(Table(content, source))
    check_name(profile.name, source)
    check_registers(profile.registers, source)
    blocks = {name: block.addresses for name, block in profile.blocks.items()}
    check_blocks(blocks, profile.registers, source)
    check_bits(profile.bits, profile.registers, source)
    check_enums(profile.enums, profile.registers, source)
    return profile


_TOP = (
    "name", "title", "adapter", "word_order", "verified", "source", "timing", "watchdog", "blocks",
    "registers", "bits", "enums", "axis", "sequences", "tracker",
)  # fmt: skip
_REGISTER = (
    "address", "type", "word_order", "scale", "sign", "unit", "access", "minimum", "maximum", "expect",
    "text", "source", "verified", "optional",
)  # fmt: skip


def _profile(top: Table) -> Profile:
    top.only(*_TOP)
    order = top.word("word_order", WordOrder, WordOrder.HIGH_FIRST)
    verified, source = top.get("verified", bool), top.get("source", str)
    rows = top.table("registers")
    registers = {
        name: _register(name, rows.table(name), order, source, verified=verified) for name in rows.content
    }
    timing = top.table("timing")
    enums = {
        name: _numbers(top.table("enums").table(name), LAST_ADDRESS) for name in top.table("enums").content
    }
    return Profile(
        name=top.get("name", str),
        title=top.get("title", str),
        adapter=top.word("adapter", Adapter),
        word_order=order,
        verified=verified and all(register.verified for register in registers.values()),
        source=source,
        timeout_ms=timing.whole("timeout_ms", 20, 5000, DEFAULT_TIMEOUT_MS),
        poll_ms=timing.whole("poll_ms", 20, 5000, 100),
        rest_ms=timing.whole("rest_ms", 0, 1000, 0),
        longest_reply_ms=_longest_reply_ms(timing),
        watchdog=_watchdog(top.table("watchdog"), registers),
        blocks={name: _block(name, top.table("blocks").table(name)) for name in top.table("blocks").content},
        registers=registers,
        bits={name: _numbers(top.table("bits").table(name), LAST_BIT) for name in top.table("bits").content},
        enums=enums,
        sequences=_sequences(top, registers, enums),
        steps_per_revolution=_steps(top.table("axis")),
        tracker=top.whole("tracker", 1, MOST_TRACKERS, 1),
        text=top.source,
    )


def _register(name: str, row: Table, order: WordOrder, source: str, *, verified: bool) -> Register:
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
        minimum=row.number("minimum"),
        maximum=row.number("maximum"),
        expect=row.whole("expect", 0, LAST_ADDRESS) if "expect" in row.content else None,
        text=row.get("text", str, ""),
        source=row.get("source", str, source),
        verified=row.get("verified", bool, verified),
        optional=row.get("optional", bool, False),
    )


def _longest_reply_ms(timing: Table) -> int:
    timeout_ms = timing.whole("timeout_ms", 20, 5000, DEFAULT_TIMEOUT_MS)
    longest_ms = timing.whole("longest_reply_ms", 0, 5000, 0)
    if 0 < longest_ms < timeout_ms:
        raise timing.error("longest_reply_ms", f"must not be shorter than timeout_ms, {timeout_ms}")
    return longest_ms


def _block(name: str, row: Table) -> Block:
    row.only("address", "count")
    return Block(name, row.whole("address", 0, LAST_ADDRESS), row.whole("count", 1, MOST_REGISTERS))


def _watchdog(row: Table, registers: Mapping[str, Register]) -> Watchdog | None:
    if not row.content:
        return None
    row.only("register", "timeout_ms", "readback", "action")
    for key in ("register", "readback"):
        if key in row.content and row.get(key, str) not in registers:
            raise row.error(key, f"names no register: {row.get(key, str)!r}")
    return Watchdog(
        register=row.get("register", str) if "register" in row.content else None,
        timeout_ms=row.whole("timeout_ms", 50, 60_000),
        readback=row.get("readback", str) if "readback" in row.content else None,
        action=row.get("action", str),
    )


def _steps(row: Table) -> float:
    row.only("steps_per_revolution")
    steps = row.get("steps_per_revolution", float, 1.0)
    if steps <= 0.0:
        raise row.error("steps_per_revolution", f"must be above zero, not {steps}")
    return steps


def _sequences(
    top: Table, registers: Mapping[str, Register], enums: Mapping[str, Mapping[str, int]]
) -> dict[str, tuple[SequenceStep, ...]]:
    table = top.table("sequences")
    return {
        name: tuple(_step(table, name, text, registers, enums) for text in table.texts(name))
        for name in table.content
    }


def _step(
    table: Table,
    name: str,
    text: str,
    registers: Mapping[str, Register],
    enums: Mapping[str, Mapping[str, int]],
) -> SequenceStep:
    """Return the write that `register = word or number` says."""
    register, equals, value = (part.strip() for part in text.partition("="))
    if not equals:
        raise table.error(name, f"{text!r} must be written as 'register = word' or 'register = number'")
    if register not in registers:
        raise table.error(name, f"{text!r} names no register")
    words = enums.get(register, {})
    try:
        number = words[value] if value in words else int(value, 0)
    except ValueError as error:
        raise table.error(name, f"{text!r} needs a number or one of the words in enums.{register}") from error
    check_step(registers[register], number, f"{table.path}{name}", table.source)
    return SequenceStep(register, number)


def _numbers(row: Table, highest: int) -> dict[str, int]:
    numbers = {name: row.whole(name, 0, highest) for name in row.content}
    for name, number in numbers.items():
        if list(numbers.values()).count(number) > 1:
            raise row.error(name, f"has the number {number}, which is given twice")
    return numbers
