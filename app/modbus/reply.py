"""Is this the reply to that request? Every byte of a Modbus TCP reply that can be checked is checked."""

from dataclasses import dataclass
from struct import unpack_from

from app.base.message import N_, say

EXCEPTION_BIT = 0x80
EXCEPTION_LENGTH = 3
ANY_REFUSAL = 0x81
"""What some devices answer a failed request with, whatever was asked (Kinco FD5P manual, chapter 10)."""
HEADER = 8
READ_HOLDING, WRITE_ONE, WRITE_MANY = 3, 6, 16


class BadReply(Exception):
    """What arrived is no reply to the request; the text says what is wrong with it."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """What the reply must look like: unit, function code, length field and the bytes after the function."""

    unit: int
    function: int
    length: int
    begins: bytes


def wanted_read(unit: int, count: int) -> Wanted:
    """Return what the reply to a read of holding registers looks like."""
    return Wanted(unit, READ_HOLDING, 3 + 2 * count, bytes((2 * count,)))


def wanted_write(unit: int, address: int, words: tuple[int, ...]) -> Wanted:
    """Return what the reply to a write of one or more holding registers looks like: its echo."""
    if len(words) == 1:
        return Wanted(unit, WRITE_ONE, 6, address.to_bytes(2, "big") + words[0].to_bytes(2, "big"))
    return Wanted(unit, WRITE_MANY, 6, address.to_bytes(2, "big") + len(words).to_bytes(2, "big"))


def is_complete(frame: bytes, wanted: Wanted, transaction: int) -> bool:
    """Return whether the reply has arrived whole, or raise `BadReply` as soon as a byte is wrong."""
    head = transaction.to_bytes(2, "big") + b"\x00\x00"
    if frame[:4] != head[: len(frame)]:
        raise BadReply(N_("the reply belongs to another request"))
    if len(frame) < HEADER:
        return False
    length, unit, function = unpack_from(">HBB", frame, 4)
    if unit != wanted.unit:
        raise BadReply(say("unit {unit} answered instead of unit {unit2}", unit=unit, unit2=wanted.unit))
    due = _due_length(function, wanted)
    if length != due or len(frame) > 6 + due:
        raise BadReply(N_("the reply has the wrong length"))
    if len(frame) < 6 + due:
        return False
    if function == wanted.function and not frame.startswith(wanted.begins, HEADER):
        raise BadReply(N_("the reply does not match the request"))
    return True


def _due_length(function: int, wanted: Wanted) -> int:
    if function == wanted.function:
        return wanted.length
    if function in (wanted.function | EXCEPTION_BIT, ANY_REFUSAL):
        return EXCEPTION_LENGTH
    raise BadReply(
        say(
            "the reply has function code {function} instead of {function2}",
            function=function,
            function2=wanted.function,
        )
    )
