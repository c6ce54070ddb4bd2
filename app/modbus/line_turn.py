"""How long a line needs until every device on it was asked and told once: its turn."""

from typing import NamedTuple

from app.modbus.wire import Timing
from app.tracker.settings.config import SerialConfig

READ_REQUEST, READ_HEAD, WRITE_BOTH = 8, 5, 16
"""Characters of a read's request, of its reply but for the registers, and of a write of one and its reply."""
SILENCES, SILENT_CHARACTERS, SHORTEST_SILENCE_S = 4, 3.5, 0.00175
DEVICE_S = 0.005
"""How long a device usually thinks before it replies."""
UNKNOWN_S = 0.01
"""What a device behind a gateway takes of a turn until that is measured; most take less."""
REPLIES = 2
NEWEST_SHARE = 0.1


class LineTurn(NamedTuple):
    """So many devices share a line, whose turn takes so long; one drive's part of that was reckoned before.

    `reckoned_s` is 0 where nothing is known of the line, as behind a gateway.
    """

    devices: int
    turn_s: float
    reckoned_s: float


def serial_part_s(serial: SerialConfig, timing: Timing) -> float:
    """Return how much of a serial line one device takes a turn: one poll, and one value written."""
    character_s = serial.bits / serial.baud_rate
    characters = READ_REQUEST + READ_HEAD + 2 * timing.registers + WRITE_BOTH
    silence_s = max(SILENT_CHARACTERS * character_s, SHORTEST_SILENCE_S)
    return characters * character_s + SILENCES * silence_s + REPLIES * (timing.rest_s + DEVICE_S)


class Part:
    """One device's part of a turn: reckoned until it has answered, then as measured.

    What it is asked for counts by its address, what it is told as one: a turn has one command.
    """

    def __init__(self, reckoned_s: float) -> None:
        self.reckoned_s = reckoned_s
        self._reads: dict[int, float] = {}
        self._write_s = 0.0

    @property
    def takes_s(self) -> float:
        """Return how long this device keeps the line busy in a turn."""
        return sum(self._reads.values()) + self._write_s if self._reads else self.reckoned_s or UNKNOWN_S

    def note(self, address: int, took_s: float, *, written: bool) -> None:
        """Take in how long one good exchange took."""
        if written:
            self._write_s = _smoothed(self._write_s, took_s)
        else:
            self._reads[address] = _smoothed(self._reads.get(address, 0.0), took_s)


def _smoothed(before_s: float, took_s: float) -> float:
    return took_s if before_s == 0.0 else before_s + (took_s - before_s) * NEWEST_SHARE
