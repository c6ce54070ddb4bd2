"""Rules that hold between the tables of a profile; a broken one is told with file, line, key and rule."""

import re
from collections.abc import Mapping

from app.base.message import say
from app.drives.profile_text import Source
from app.drives.register import RANGES, Access, Register

NAME = re.compile(r"[a-z0-9][a-z0-9_-]{0,63}")
LAST_ADDRESS = 0xFFFF
Registers = Mapping[str, Register]


def check_name(name: str, source: Source) -> None:
    """Raise `ProfileError` for a name that could not be asked for."""
    if not NAME.fullmatch(name):
        rule = say(
            "must have at most 64 lowercase letters, digits, '-', and '_', not {name}", name=repr(name)
        )
        raise source.error("name", rule)


def check_registers(registers: Registers, source: Source) -> None:
    """Raise `ProfileError` if two registers share an address, one passes the last, or none is believed."""
    taken: dict[int, str] = {}
    for register in registers.values():
        key = f"registers.{register.name}"
        for address in register.addresses:
            if address > LAST_ADDRESS:
                raise source.error(f"{key}.address", f"its second word would lie behind {LAST_ADDRESS}")
            if address in taken:
                raise source.error(f"{key}.address", f"address {address} is taken by {taken[address]}")
            taken[address] = register.name
        low, high = register.minimum, register.maximum
        if low is not None and high is not None and low > high:
            raise source.error(f"{key}.minimum", f"must not lie above maximum, {high:g}, but is {low:g}")


def check_blocks(blocks: Mapping[str, range], registers: Registers, source: Source) -> None:
    """Raise `ProfileError` for a block that passes the last address, cuts a register or holds none."""
    for name, inside in blocks.items():
        key = f"blocks.{name}"
        if inside.stop - 1 > LAST_ADDRESS:
            raise source.error(key, f"must end at address {LAST_ADDRESS}, not at {inside.stop - 1}")
        held = [[one in inside for one in register.addresses] for register in registers.values()]
        for register, words in zip(registers.values(), held, strict=True):
            if any(words) and not all(words):
                raise source.error(key, f"cuts register {register.name} in two")
        if not any(map(all, held)):
            raise source.error(key, "holds no register")


def check_bits(bits: Mapping[str, Mapping[str, int]], registers: Registers, source: Source) -> None:
    """Raise `ProfileError` for bits of no register, or beyond its last bit."""
    for name, numbers in bits.items():
        if name not in registers:
            raise source.error(f"bits.{name}", f"there is no register {name} whose bits these could be")
        last = 16 * registers[name].count - 1
        for word, number in numbers.items():
            if number > last:
                rule = say("must lie between 0 and {last}, not {number}", last=last, number=number)
                raise source.error(f"bits.{name}.{word}", rule)


def check_enums(enums: Mapping[str, Mapping[str, int]], registers: Registers, source: Source) -> None:
    """Raise `ProfileError` for words that no register takes, or whose numbers one cannot hold."""
    for name, words in enums.items():
        taking = [register for register in registers.values() if has_words(register.name, name)]
        for register in taking:
            if register.access is Access.READ_WRITE:
                for word, number in words.items():
                    check_step(register, number, f"enums.{name}.{word}", source)
        if not taking:
            rule = say(
                "there is no register named {name}, *_{name2} or {name3}_kind that takes these words",
                name=name,
                name2=name,
                name3=name,
            )
            raise source.error(f"enums.{name}", rule)


def has_words(register: str, enum: str) -> bool:
    """Return whether a register's numbers are told by an enumeration's words."""
    return register in (enum, f"{enum}_kind") or register.endswith(f"_{enum}")


def check_step(register: Register, value: int, key: str, source: Source) -> None:
    """Raise `ProfileError` for a write that the register cannot take."""
    if register.access is Access.READ:
        raise source.error(key, f"writes {register.name}, which can only be read")
    lowest, highest = RANGES[register.type]
    if not lowest <= value <= highest:
        raise source.error(key, f"{value} does not fit into {register.name} ({register.type})")
