"""A second pair of eyes on the simulated drive: a Modbus connection of its own that only reads."""

import socket
import threading
import time
from collections import deque
from dataclasses import dataclass
from itertools import pairwise
from struct import pack, unpack_from

from app.simulation.sim_training import TRUE_AZIMUTH

LOOK_EVERY_S = 0.003
JUDGE_EVERY_S = 0.01
MOST_SIGHTS = 6000
RESTS_AFTER_S = 0.15
STEP_DEG = 0.0005
HEADER = 9
"""Bytes of a Modbus TCP reply before its registers."""


class ModbusEyes:
    """Reads holding registers over a plain socket, one request at a time."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=5.0)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._number = 0

    def read(self, address: int, count: int) -> bytes:
        """Return `count` registers from an address, as bytes."""
        self._number = (self._number + 1) & 0xFFFF
        self._socket.sendall(pack(">HHHBBHH", self._number, 0, 6, 1, 3, address, count))
        wanted, reply = HEADER + 2 * count, b""
        while len(reply) < wanted:
            got = self._socket.recv(wanted - len(reply))
            assert got, "the simulated drive hung up"
            reply += got
        assert unpack_from(">H", reply)[0] == self._number
        return reply[HEADER:]

    def close(self) -> None:
        """Let go of the connection."""
        self._socket.close()


@dataclass(frozen=True, slots=True)
class Sight:
    """Where the panel really pointed at an instant of the monotonic clock."""

    at: float
    azimuth_deg: float
    elevation_deg: float

    def is_apart(self, other: "Sight") -> bool:
        """Return whether the panel has turned between two sights."""
        return (
            abs(self.azimuth_deg - other.azimuth_deg) > STEP_DEG
            or abs(self.elevation_deg - other.elevation_deg) > STEP_DEG
        )


class Eyes:
    """Watches where the panel really points, every 3 ms, in a thread of its own.

    It reads the training registers: unlike status they do not tell the drive that its master has
    seen the watchdog's trip.
    """

    def __init__(self, port: int) -> None:
        self.sights: deque[Sight] = deque(maxlen=MOST_SIGHTS)
        self._modbus = ModbusEyes(port)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()
        while not self.sights:
            time.sleep(LOOK_EVERY_S)

    def close(self) -> None:
        """Look away."""
        self._over.set()
        self._thread.join(5)
        self._modbus.close()

    @property
    def now(self) -> Sight:
        """Return the newest sight."""
        return self.sights[-1]

    def moved_after(self, at: float) -> bool:
        """Return whether the panel has turned at any time after an instant."""
        seen = self._since(at)
        return any(sight.is_apart(seen[0]) for sight in seen)

    def stays(self, since: float, seconds: float) -> None:
        """Fail if the panel turns within so many seconds after an instant."""
        while self.now.at < since + seconds:
            time.sleep(JUDGE_EVERY_S)
        assert not self.moved_after(since + JUDGE_EVERY_S)

    def until_moving(self, *, within_s: float = 5.0) -> None:
        """Return once the panel turns."""
        begun = self.now
        give_up = begun.at + within_s
        while not self.now.is_apart(begun):
            assert self.now.at < give_up, "the panel does not turn"
            time.sleep(JUDGE_EVERY_S)

    def rest_after(self, at: float, *, within_s: float = 5.0) -> float:
        """Return how long after an instant the panel turned for the last time, once it stands still."""
        while self._stands_since() > self.now.at - RESTS_AFTER_S or self.now.at < at + RESTS_AFTER_S:
            assert self.now.at < at + within_s, "the panel still turns"
            time.sleep(JUDGE_EVERY_S)
        return max(0.0, self._last_turn() - at)

    def first_rest_after(self, at: float, *, within_s: float = 5.0) -> float:
        """Return how long after an instant the panel stood still for the first time."""
        give_up = at + within_s
        while (rest := self._first_rest(at)) is None:
            assert self.now.at < give_up, "the panel still turns"
            time.sleep(JUDGE_EVERY_S)
        return rest.at - at

    def longest_blink_s(self, at: float) -> float:
        """Return the longest time after an instant for which a busy computer kept it from looking."""
        seen = [at, *(sight.at for sight in self._since(at))]
        return max(after - before for before, after in pairwise(seen))

    def _since(self, at: float) -> list[Sight]:
        return [sight for sight in list(self.sights) if sight.at >= at]

    def _first_rest(self, at: float) -> Sight | None:
        stood: Sight | None = None
        for sight in self._since(at):
            if stood is None or sight.is_apart(stood):
                stood = sight
            elif sight.at - stood.at >= RESTS_AFTER_S:
                return stood
        return None

    def _stands_since(self) -> float:
        """Return since when the panel was seen where it is; while it does not look it sees nobody stand."""
        sights = list(self.sights)
        since = sights[-1]
        for sight in reversed(sights):
            if sight.is_apart(sights[-1]):
                break
            since = sight
        return since.at

    def _last_turn(self) -> float:
        sights = list(self.sights)
        for sight in reversed(sights):
            if sight.is_apart(sights[-1]):
                return sight.at
        return sights[0].at

    def _watch(self) -> None:
        while not self._over.is_set():
            words = self._modbus.read(TRUE_AZIMUTH.address, 4)
            azimuth, elevation = unpack_from(">ii", words)
            self.sights.append(Sight(time.monotonic(), azimuth / 1000.0, elevation / 1000.0))
            time.sleep(LOOK_EVERY_S)
