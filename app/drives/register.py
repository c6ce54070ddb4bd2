"""One value in a device's register map, and how it is packed into 16-bit words."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite

from app.base.message import data, say, with_format
from app.modbus.errors import DriveRefused


class WordType(StrEnum):
    """How many words a value takes and whether it has a sign."""

    UINT16 = "uint16"
    INT16 = "int16"
    UINT32 = "uint32"
    INT32 = "int32"


class WordOrder(StrEnum):
    """Which word of a 32-bit value comes first."""

    HIGH_FIRST = "high-first"
    LOW_FIRST = "low-first"


class ValueMisfit(DriveRefused):
    """A value does not fit into its register: it is refused before anything is sent."""


class Access(StrEnum):
    """What a master may do with a register."""

    READ = "read"
    READ_WRITE = "read-write"


@dataclass(frozen=True, slots=True)
class Register:
    """A value: its value in `unit` is the packed integer times `scale` times `sign`.

    Without an `optional` register a device can do its work: it is left out where the device refuses it.
    """

    name: str
    address: int
    type: WordType
    order: WordOrder = WordOrder.HIGH_FIRST
    scale: float = 1.0
    sign: int = 1
    unit: str = ""
    access: Access = Access.READ
    minimum: float | None = None
    maximum: float | None = None
    expect: int | None = None
    text: str = ""
    source: str = ""
    verified: bool = False
    optional: bool = False

    @property
    def is_wide(self) -> bool:
        """Return whether the value takes two words."""
        return self.type in (WordType.UINT32, WordType.INT32)

    @property
    def count(self) -> int:
        """Return how many words the value takes."""
        return 2 if self.is_wide else 1

    @property
    def addresses(self) -> range:
        """Return the addresses that the value takes."""
        return range(self.address, self.address + self.count)

    def integer(self, words: Sequence[int], first_address: int) -> int:
        """Return the packed integer out of words that were read from `first_address` on."""
        at = self.address - first_address
        if not self.is_wide:
            value = words[at]
            return value - 0x10000 if self.type is WordType.INT16 and value & 0x8000 else value
        high, low = words[at], words[at + 1]
        if self.order is WordOrder.LOW_FIRST:
            high, low = low, high
        value = high << 16 | low
        return value - 0x1_0000_0000 if self.type is WordType.INT32 and value & 0x8000_0000 else value

    def value(self, words: Sequence[int], first_address: int) -> float:
        """Return the value in its unit."""
        return round(self.integer(words, first_address) * self.scale * self.sign, 9) + 0.0

    def placed(self, value: float) -> dict[int, int]:
        """Return address and word of a value in its unit, or raise `ValueMisfit`."""
        return dict(enumerate(self.words(value), self.address))

    def words(self, value: float) -> tuple[int, ...]:
        """Return the words for a value in its unit, or raise `ValueMisfit`."""
        integer = self.packed(value)
        if not self.is_wide:
            return (integer & 0xFFFF,)
        high, low = integer >> 16 & 0xFFFF, integer & 0xFFFF
        return (low, high) if self.order is WordOrder.LOW_FIRST else (high, low)

    def packed(self, value: float) -> int:
        """Return the integer that stands for a value in its unit, or raise `ValueMisfit`."""
        exact = value / (self.scale * self.sign)
        lowest, highest = RANGES[self.type]
        if not isfinite(exact) or not lowest <= round(exact) <= highest:
            ends = sorted(end * self.scale * self.sign + 0.0 for end in (lowest, highest))
            raise ValueMisfit(
                say(
                    "{value} does not fit into register {name} ({address}), which holds {least} to {most}.",
                    value=with_format(value, NUMBER),
                    name=self.name,
                    address=self.address,
                    least=with_format(ends[0], NUMBER),
                    most=data(f"{ends[1]:{NUMBER}} {self.unit}".strip()),
                )
            )
        return round(exact)

    def is_plausible(self, value: float) -> bool:
        """Return whether a value lies in the range that the profile gives."""
        above = self.minimum is None or value >= self.minimum
        return above and (self.maximum is None or value <= self.maximum)


NUMBER = ".10g"
RANGES = {
    WordType.UINT16: (0, 0xFFFF),
    WordType.INT16: (-0x8000, 0x7FFF),
    WordType.UINT32: (0, 0xFFFF_FFFF),
    WordType.INT32: (-0x8000_0000, 0x7FFF_FFFF),
}


def runs(changed: Mapping[int, int], known: Mapping[int, int]) -> list[tuple[int, list[int]]]:
    """Return runs of neighbouring addresses; a gap whose words are known is filled to save a frame."""
    runs: list[tuple[int, list[int]]] = []
    for address in sorted(changed):
        if runs:
            start, values = runs[-1]
            gap = range(start + len(values), address)
            if all(between in known for between in gap):
                values.extend(known[between] for between in gap)
                values.append(changed[address])
                continue
        runs.append((address, [changed[address]]))
    return runs
