"""A serial line that is not there: a pseudo-terminal, paced like a line if that is wanted."""

import asyncio
import os
import tty
from contextlib import suppress
from pathlib import Path

from app.base.message import Message, say
from app.modbus.line import CHUNK, Line, Lost, Received, SerialLine
from app.tracker.settings.config import SerialConfig

PIECE = 8


class PtyLine:
    """The far end of a pseudo-terminal; the near end can be opened as a serial port by the name `path`.

    With a `character_s` above zero both directions take as long as on a line of that speed.
    """

    def __init__(self, path: Path, character_s: float = 0.0) -> None:
        self._path = path
        self._character_s = character_s
        self._ends: tuple[int, int] | None = None
        self._sent_until_s = self._heard_until_s = 0.0
        self._received: Received | None = None

    @property
    def is_open(self) -> bool:
        """Return whether the pseudo-terminal is there."""
        return self._ends is not None

    @property
    def character_s(self) -> float:
        """Return how long one character takes."""
        return self._character_s

    @property
    def advice(self) -> Message:
        """Return what to check when it cannot be made."""
        return say("Check that {path} is writable and is not another file or device.", path=self._path)

    async def open(self, received: Received, lost: Lost) -> bool:
        """Make the pseudo-terminal and its name, and return whether that worked; `lost` is never called."""
        ends = os.openpty()
        tty.setraw(ends[1])
        os.set_blocking(ends[0], False)
        if not self._name(_device(ends[1])):
            _close(ends)
            return False
        self._ends, self._received = ends, received
        asyncio.get_running_loop().add_reader(ends[0], self._read)
        return True

    def write(self, data: bytes) -> None:
        """Send bytes, each when a line of this speed would have carried it."""
        if self._character_s == 0.0:
            self._put(data)
            return
        loop = asyncio.get_running_loop()
        self._sent_until_s = max(self._sent_until_s, loop.time())
        for start in range(0, len(data), PIECE):
            piece = data[start : start + PIECE]
            self._sent_until_s += len(piece) * self._character_s
            loop.call_at(self._sent_until_s, self._put, piece)

    def close(self) -> None:
        """Take the pseudo-terminal away, as an adapter that is unplugged."""
        ends, self._ends = self._ends, None
        if ends is None:
            return
        asyncio.get_running_loop().remove_reader(ends[0])
        _close(ends)
        with suppress(OSError):
            self._path.unlink()

    def _name(self, device: Path) -> bool:
        """Let the name point at a device; one that a killed process left behind is taken over."""
        try:
            if self._path.is_symlink() and not self._path.exists():
                self._path.unlink()
            self._path.symlink_to(device)
        except OSError:
            return False
        return True

    def _put(self, data: bytes) -> None:
        if self._ends is not None:
            with suppress(BlockingIOError):
                os.write(self._ends[0], data)

    def _read(self) -> None:
        if self._ends is None:
            return
        with suppress(BlockingIOError):
            data = os.read(self._ends[0], CHUNK)
            if self._character_s == 0.0:
                self._take(data)
                return
            loop = asyncio.get_running_loop()
            self._heard_until_s = max(self._heard_until_s, loop.time()) + len(data) * self._character_s
            loop.call_at(self._heard_until_s, self._take, data)

    def _take(self, data: bytes) -> None:
        if self._ends is not None and self._received is not None:
            self._received(data)


def _device(end: int) -> Path:
    """Return a path that vanishes with this process; the device's number is soon somebody else's."""
    own = Path(f"/proc/{os.getpid()}/fd/{end}")
    return own if own.exists() else Path(os.ttyname(end))


def _close(ends: tuple[int, int]) -> None:
    for end in ends:
        os.close(end)


def serial_end(serial: SerialConfig, *, paced: bool = False) -> Line:
    """Return the serial device of a name, or a pseudo-terminal to be made where there is none."""
    path = Path(serial.port)
    if path.is_char_device():
        return SerialLine(serial)
    return PtyLine(path, serial.bits / serial.baud_rate if paced else 0.0)
