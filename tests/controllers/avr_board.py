"""The firmware of `controllers/avr` in simavr, cycle by cycle; its time is the cycles of the processor."""

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fcntl import LOCK_EX, flock
from pathlib import Path
from struct import pack, unpack

from app.modbus.rtu_frame import sealed
from tests.patience import PATIENCE_S

ROOT = Path(__file__).resolve().parents[2]
FIRMWARE = ROOT / "controllers/avr"
BUILT = ROOT / "build/avr"
HZ = 16_000_000
STEPS_PER_DEG = 200
HALT, VELOCITY, POSITION = 0, 1, 2
SET_HOME_AZIMUTH, SET_HOME_ELEVATION, HOME, RESET_FAULT = 1, 2, 3, 4
LOWER, UPPER, ORIGIN, EMERGENCY, LOCAL = 0, 1, 2, 6, 7
PACKAGES = "gcc-avr avr-libc binutils-avr libsimavr-dev libelf-dev gcc"
NEEDED = (
    "The tests of the firmware need: {}. Install them with: sudo apt-get install --no-install-recommends {}"
)


@dataclass(frozen=True)
class Status:
    """The status block, decoded."""

    words: tuple[int, ...]

    def signed(self, address: int) -> int:
        """Return a 32-bit value, high word first."""
        value: int = unpack(">i", pack(">2H", *self.words[address : address + 2]))[0]
        return value

    @property
    def positions_mdeg(self) -> tuple[int, int]:
        return self.signed(8), self.signed(10)

    @property
    def velocities_mdps(self) -> tuple[int, int]:
        return self.signed(12), self.signed(14)

    @property
    def moving(self) -> tuple[bool, bool]:
        return bool(self.words[5] & 1), bool(self.words[5] & 2)

    @property
    def homed(self) -> tuple[bool, bool]:
        return bool(self.words[5] & 4), bool(self.words[5] & 8)

    @property
    def homing(self) -> bool:
        return bool(self.words[5] & 16)

    @property
    def tripped(self) -> bool:
        return bool(self.words[5] & 32)

    @property
    def failed(self) -> bool:
        return bool(self.words[5] & 64)

    @property
    def local(self) -> bool:
        return bool(self.words[5] & 128)

    @property
    def fault(self) -> int:
        return self.words[7]


@dataclass(frozen=True)
class Counted:
    """What left the step pins of one axis; intervals in cycles since `mark`."""

    position: int
    pulses: int
    least: int
    most: int


class Board:
    """A powered board: registers over its serial line, switches and pulses at its pins."""

    def __init__(self, process: "subprocess.Popen[str]", terminal: str) -> None:
        self._process = process
        self.terminal = terminal
        self._keep_alive = 0
        self.answer_cycles = 0

    def say(self, line: str) -> str:
        """Return the host's answer to one line."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()
        return self._process.stdout.readline().strip()

    @property
    def cycle(self) -> int:
        return int(self.say("run 0"))

    def run(self, seconds: float) -> None:
        """Let time pass without anybody reading or writing."""
        self.say(f"run {round(seconds * HZ)}")

    def ask_raw(self, frame: bytes) -> bytes:
        """Return what comes back for bytes as they are; nothing after 0.1 s."""
        reply, cycles = self.say(f"ask {frame.hex()}").split()
        self.answer_cycles = int(cycles)
        return b"" if reply == "-" else bytes.fromhex(reply)

    def ask(self, body: bytes, unit: int = 1) -> bytes:
        """Return function code and data of the reply to a request, whose checksum is right."""
        reply = self.ask_raw(sealed(bytes((unit,)) + body))
        assert reply == sealed(reply[:-2])
        assert reply[0] == unit
        return reply[1:-2]

    def status(self) -> Status:
        reply = self.ask(pack(">BHH", 3, 0, 40))
        return Status(unpack(">40H", reply[2:]))

    def write(self, address: int, *words: int) -> bytes:
        return self.ask(pack(f">BHHB{len(words)}H", 16, address, len(words), 2 * len(words), *words))

    def command(
        self,
        azimuth: Sequence[int] = (HALT, 0, 0),
        elevation: Sequence[int] = (HALT, 0, 0),
        request: tuple[int, int] = (0, 0),
    ) -> None:
        """Write one command with a new keep-alive value: motion, mdeg or mdeg/s, greatest mdeg/s."""
        self._keep_alive += 1
        axes = b"".join(pack(">HiI", *axis) for axis in (azimuth, elevation))
        data = pack(">H", self._keep_alive & 0xFFFF) + axes + pack(">HH", *request)
        assert self.ask(pack(">BHHB", 16, 20, 13, 26) + data) == pack(">BHH", 16, 20, 13)

    def drive(
        self,
        seconds: float,
        azimuth: Sequence[int] = (HALT, 0, 0),
        elevation: Sequence[int] = (HALT, 0, 0),
        request: tuple[int, int] = (0, 0),
    ) -> Status:
        """Write the same command until the time is over, as a control loop does, and read at last."""
        end = self.cycle + round(seconds * HZ)
        while (left := end - self.cycle) > 0:
            self.command(azimuth, elevation, request)
            self.say(f"run {max(0, min(left, HZ // 5))}")
        return self.status()

    def until_rest(
        self,
        azimuth: Sequence[int] = (HALT, 0, 0),
        elevation: Sequence[int] = (HALT, 0, 0),
        request: tuple[int, int] = (0, 0),
    ) -> Status:
        for _ in range(300):
            status = self.drive(0.5, azimuth, elevation, request)
            if not (any(status.moving) or status.homing):
                return status
        raise AssertionError("the axes did not come to rest")

    def world(self, axis: int, start: float, lower: float, upper: float, home: float) -> None:
        """Say where an axis really is and where its switches are, in degrees."""
        steps = (round(angle * STEPS_PER_DEG) for angle in (start, lower, upper, home))
        self.say(f"world {axis} " + " ".join(map(str, steps)))

    def hold(self, bit: int, level: int | None) -> None:
        """Hold an input at a level; None leaves it to where the axis is."""
        self.say(f"input {bit} {'a' if level is None else level}")

    def counted(self) -> tuple[Counted, Counted]:
        numbers = [int(number) for number in self.say("counts").split()]
        return Counted(*numbers[1:5]), Counted(*numbers[5:9])

    def edges(self, axis: int) -> list[int]:
        """Return the cycles of an axis's pulses since `mark`."""
        return [int(number) for number in self.say(f"edges {axis}").split()]

    def mark(self) -> None:
        self.say("mark")

    def outputs(self) -> int:
        return int(self.say("outputs"))

    def reset(self) -> None:
        """Switch the power off and on."""
        self.say("reset")
        self.run(0.01)


def built() -> tuple[Path, Path]:
    """Return host and firmware, built if sources are newer; a missing package fails with its name."""
    missing = [name for name in ("avr-g++", "avr-objcopy", "gcc", "make") if shutil.which(name) is None]
    headers = ("/usr/include/simavr/sim_avr.h", "/usr/include/libelf.h")
    missing += [name for name in headers if not Path(name).exists()]
    assert not missing, NEEDED.format(", ".join(missing), PACKAGES)
    BUILT.mkdir(parents=True, exist_ok=True)
    host, source = BUILT / "host", ROOT / "tests/controllers/avr/host.c"
    with (BUILT / "lock").open("w") as lock:
        flock(lock, LOCK_EX)
        subprocess.run(["make", "-s", "-C", FIRMWARE], check=True)
        if not host.exists() or host.stat().st_mtime < source.stat().st_mtime:
            line = ["gcc", "-O2", "-Wall", "-Werror", "-o", str(host), str(source)]
            line += ["-lsimavr", "-lelf", "-lutil"]
            subprocess.run(line, check=True)
    return host, FIRMWARE / "build/heliopanel-axes-mega.elf"


@contextmanager
def powered() -> Iterator[Board]:
    """A board whose axes stand at 12.4 and 6.6 degrees, as the simulated tracker does at its first start."""
    process = subprocess.Popen(
        list(map(os.fspath, built())), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        terminal = next(line.strip() for line in process.stdout if line.startswith("/dev/"))
        board = Board(process, terminal)
        board.world(0, 12.4, -5.0, 365.0, 0.5)
        board.world(1, 6.6, -5.0, 95.0, 0.5)
        board.run(0.01)
        yield board
    finally:
        process.stdin.close()
        process.wait(timeout=PATIENCE_S)
        process.stdout.close()
