"""What can go wrong on the way between master and device, and the script that says when."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from struct import pack

from app.modbus.rtu_frame import CRC_BYTES, crc, sealed

LATE_MS = 400.0
BUSY = 6.0
NOISE = b"\x00\xff\x55\xaa"
TCP_HEAD = 6
STRUCTURE = 9
STEP = re.compile(
    r"(?:after\s+(?P<after>\d+)(?:\s+frames?)?\s*:\s*)?"
    r"(?P<fault>[a-z-]+)(?:=(?P<amount>\d+(?:\.\d+)?))?(?:\s+(?P<times>\d+))?"
)


class Framing(StrEnum):
    """How requests and replies are told apart on a line."""

    TCP = "tcp"
    RTU = "rtu"


class WireFault(StrEnum):
    """What happens to a request or to its reply."""

    CLEAR = "clear"
    DELAY = "delay"
    DROP = "drop"
    TRUNCATE = "truncate"
    CORRUPT = "corrupt"
    WRONG_TRANSACTION = "wrong-transaction"
    WRONG_UNIT = "wrong-unit"
    DUPLICATE = "duplicate"
    EXCEPTION = "exception"
    RESET = "reset"
    CLOSE = "close"
    BLACK_HOLE = "black-hole"
    CHECKSUM = "checksum"
    NOISE = "noise"
    MERGE = "merge"


MEANINGS = {
    WireFault.CLEAR: "everything passes",
    WireFault.DELAY: "the reply comes so many milliseconds later, delay=400 if not said",
    WireFault.DROP: "the device acts, its reply is lost",
    WireFault.TRUNCATE: "only the first half of the reply comes",
    WireFault.CORRUPT: "one byte of the reply is wrong; on TCP one of its head, as no payload is protected",
    WireFault.WRONG_TRANSACTION: "the reply has another transaction number (TCP)",
    WireFault.WRONG_UNIT: "the reply comes from another unit",
    WireFault.DUPLICATE: "the reply comes twice",
    WireFault.EXCEPTION: "an exception comes in the reply's place, exception=6 (busy) if not said",
    WireFault.RESET: "the connection is reset in the reply's place (TCP)",
    WireFault.CLOSE: "the connection is closed in the reply's place (TCP)",
    WireFault.BLACK_HOLE: "requests vanish before the device",
    WireFault.CHECKSUM: "the reply's checksum is wrong (RTU)",
    WireFault.NOISE: "bytes that mean nothing come right before the reply",
    WireFault.MERGE: "the reply is held back and comes together with the next one",
}
CONNECTION = (WireFault.RESET, WireFault.CLOSE)
ONLY = {
    WireFault.WRONG_TRANSACTION: Framing.TCP,
    WireFault.CHECKSUM: Framing.RTU,
}


@dataclass(frozen=True, slots=True)
class Step:
    """So many good frames, then a fault so many times; `times` None means until something else is asked."""

    fault: WireFault
    after: int = 0
    times: int | None = None
    amount: float | None = None


class Script:
    """Steps that are played one after the other, one request at a time."""

    def __init__(self, steps: Iterable[Step] = ()) -> None:
        self._steps = list(steps)

    def next(self) -> Step:
        """Return what happens to the next request."""
        if not self._steps:
            return Step(WireFault.CLEAR)
        step = self._steps[0]
        if step.after > 0:
            self._steps[0] = replace(step, after=step.after - 1)
            return Step(WireFault.CLEAR)
        if step.times is not None:
            left = replace(step, times=step.times - 1)
            self._steps[:1] = [left] if left.times else []
        return step


def parse_script(text: str, framing: Framing) -> Script:
    """Return the script of a text such as `after 5 frames: drop 3; delay=400 2`, or raise `ValueError`."""
    return Script([_step(one.strip(), framing) for one in text.split(";") if one.strip()])


def _step(text: str, framing: Framing) -> Step:
    found = STEP.fullmatch(text)
    if found is None or found["fault"] not in list(WireFault):
        raise ValueError(
            f"{text!r} is no fault. Write a fault, such as drop, drop 3, delay=400 2 or "
            f"after 5 frames: drop 3; the faults are {', '.join(WireFault)}."
        )
    fault = WireFault(found["fault"])
    if ONLY.get(fault, framing) is not framing:
        raise ValueError(f"{fault} is not possible with {framing} frames.")
    return Step(
        fault,
        int(found["after"] or 0),
        int(found["times"]) if found["times"] else None,
        float(found["amount"]) if found["amount"] else None,
    )


def spoiled(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    """Return what comes in the place of a reply; `turn` chooses which byte is wrong."""
    spoil = SPOILERS.get(step.fault)
    return reply if spoil is None else spoil(reply, step, framing, turn)


def _truncated(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    return reply[: len(reply) // 2]


def _corrupted(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    most = min(STRUCTURE, len(reply)) if framing is Framing.TCP else len(reply)
    place = turn % most
    return reply[:place] + bytes((reply[place] ^ 0x11,)) + reply[place + 1 :]


def _another_transaction(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    return pack(">H", int.from_bytes(reply[:2], "big") ^ 0x0101) + reply[2:]


def _another_unit(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    if framing is Framing.TCP:
        return reply[:TCP_HEAD] + bytes((reply[TCP_HEAD] ^ 0x40,)) + reply[TCP_HEAD + 1 :]
    return sealed(bytes((reply[0] ^ 0x40,)) + reply[1:-CRC_BYTES])


def _twice(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    return reply + reply


def _exception(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    code = int(BUSY if step.amount is None else step.amount) & 0xFF
    if framing is Framing.TCP:
        return reply[:4] + pack(">HBBB", 3, reply[TCP_HEAD], reply[TCP_HEAD + 1] | 0x80, code)
    return sealed(bytes((reply[0], reply[1] | 0x80, code)))


def _bad_checksum(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    return reply[:-CRC_BYTES] + bytes(byte ^ 0x5A for byte in crc(reply[:-CRC_BYTES]))


def _noisy(reply: bytes, step: Step, framing: Framing, turn: int) -> bytes:
    return NOISE + reply


SPOILERS: dict[WireFault, Callable[[bytes, Step, Framing, int], bytes]] = {
    WireFault.TRUNCATE: _truncated,
    WireFault.CORRUPT: _corrupted,
    WireFault.WRONG_TRANSACTION: _another_transaction,
    WireFault.WRONG_UNIT: _another_unit,
    WireFault.DUPLICATE: _twice,
    WireFault.EXCEPTION: _exception,
    WireFault.CHECKSUM: _bad_checksum,
    WireFault.NOISE: _noisy,
}
