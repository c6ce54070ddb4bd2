"""Modbus RTU frames: the checksum, how long a request or a reply is, and whether a reply is the right one."""

from struct import pack

from app.modbus.reply import EXCEPTION_BIT, EXCEPTION_LENGTH, BadReply, Wanted
from app.modbus.wire import Ask

CRC_BYTES = 2
SHORTEST = 4
LONGEST = 256
POLYNOMIAL = 0xA001


def _table() -> tuple[int, ...]:
    entries = []
    for entry in range(256):
        for _ in range(8):
            entry = entry >> 1 ^ (POLYNOMIAL if entry & 1 else 0)
        entries.append(entry)
    return tuple(entries)


TABLE = _table()


def crc(body: bytes) -> bytes:
    """Return the two checksum bytes of a frame, low byte first."""
    value = 0xFFFF
    for byte in body:
        value = value >> 8 ^ TABLE[(value ^ byte) & 0xFF]
    return value.to_bytes(2, "little")


def sealed(body: bytes) -> bytes:
    """Return unit, function and data as a frame with its checksum."""
    return body + crc(body)


def is_sealed(frame: bytes) -> bool:
    """Return whether a frame's checksum is right."""
    return len(frame) >= SHORTEST and crc(frame[:-CRC_BYTES]) == frame[-CRC_BYTES:]


def request_frame(ask: Ask) -> bytes:
    """Return the frame of a request."""
    head = pack(">BBH", ask.unit, ask.function, ask.address)
    if not ask.words:
        return sealed(head + pack(">H", ask.count))
    if ask.count == 1:
        return sealed(head + pack(">H", ask.words[0]))
    return sealed(head + pack(f">HB{ask.count}H", ask.count, 2 * ask.count, *ask.words))


def request_length(begin: bytes) -> int | None:
    """Return how long the request is that begins so; None while that cannot be told."""
    if len(begin) < 2:
        return None
    match begin[1]:
        case 15 | 16:
            return 9 + begin[6] if len(begin) > 6 else None
        case 23:
            return 13 + begin[10] if len(begin) > 10 else None
        case _:
            return 8


def reply_length(begin: bytes) -> int | None:
    """Return how long the reply is that begins so; None while that cannot be told."""
    if len(begin) < 3:
        return None
    if begin[1] & EXCEPTION_BIT:
        return EXCEPTION_LENGTH + CRC_BYTES
    return 5 + begin[2] if begin[1] in (1, 2, 3, 4, 23) else 8


def is_whole(frame: bytes, wanted: Wanted) -> bool:
    """Return whether the reply has arrived whole, or raise `BadReply` as soon as it cannot be the right one.

    Any function code with the exception bit is taken for an exception: some devices answer a failed read
    with 0x81.
    """
    if frame[0] != wanted.unit:
        raise BadReply(f"unit {frame[0]} answered instead of unit {wanted.unit}")
    if len(frame) < 2:
        return False
    function = frame[1]
    if function != wanted.function and not function & EXCEPTION_BIT:
        raise BadReply(f"the reply has function code {function} instead of {wanted.function}")
    due = CRC_BYTES + (wanted.length if function == wanted.function else EXCEPTION_LENGTH)
    if len(frame) > due:
        raise BadReply("something came behind the reply")
    body = frame[2 : 2 + len(wanted.begins)]
    if function == wanted.function and not wanted.begins.startswith(body):
        raise BadReply("the reply does not match the request")
    if len(frame) < due:
        return False
    if not is_sealed(frame):
        raise BadReply("the reply's checksum is wrong")
    return True
