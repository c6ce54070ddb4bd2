"""A simulated drive behind a profile's registers: the other end of the `plc` adapter."""

from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import count
from struct import pack

from app.base.clock import Clock
from app.drives.dialects.plc_map import CLOCK_PARTS, PlcMap
from app.drives.profile import Profile
from app.drives.register import Access
from app.modbus.server import ILLEGAL_ADDRESS, ILLEGAL_VALUE, Refusal
from app.simulation.faults import Fault, FaultKind
from app.simulation.sim_training import LATE, Training
from app.simulation.simulated_machine import SimulatedMachine
from app.tracker.values.motion import DriveCommand, Feedback

DISCRETE_INPUTS = 32
STOP_COIL = 0
RESERVED = 0


class SimulatedPlc:
    """Serves status and takes commands as the profile says. Reserved addresses of a block read as zero."""

    def __init__(self, profile: Profile, drive: SimulatedMachine, clock: Clock) -> None:
        self._profile = profile
        self._map = PlcMap(profile)
        self._drive = drive
        self._clock = clock
        self._training = Training(drive)
        self._keep_alive = 0
        self._heartbeat = 0
        self._boot_count = drive.boot_count
        self._fixed = self._fixed_words()
        self._writable = {
            address
            for register in profile.registers.values()
            if register.access is Access.READ_WRITE
            for address in register.addresses
        }
        self._known: tuple[Feedback, DriveCommand, dict[int, int]] | None = None
        self._answers_at_once = False
        self._damage = count()

    def read_bits(self, function: int, address: int, count: int) -> list[bool]:
        """Return discrete inputs (0 to 15 status, 16 to 31 switches) or coils (0 is stop)."""
        self._answers_at_once = False
        if function == 1:
            if address + count > STOP_COIL + 1:
                raise Refusal(ILLEGAL_ADDRESS)
            return [False]
        if address + count > DISCRETE_INPUTS:
            raise Refusal(ILLEGAL_ADDRESS)
        words = self._status(told=True)
        packed = self._word("status", words) | self._word("switches", words) << 16
        return [bool(packed >> bit & 1) for bit in range(address, address + count)]

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        """Return holding registers; input registers are the same."""
        self._answers_at_once = self._training.holds(address)
        words = self._training.words() if self._answers_at_once else self._all(told=True)
        try:
            return [words[one] for one in range(address, address + count)]
        except KeyError as error:
            raise Refusal(ILLEGAL_ADDRESS) from error

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        """Write coils: coil 0 stops both axes."""
        self._answers_at_once = False
        if address != STOP_COIL or len(values) != 1:
            raise Refusal(ILLEGAL_ADDRESS)
        if values[0]:
            self._drive.halt()

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        """Write holding registers and act on them, all or none."""
        self._answers_at_once = self._training.holds(address)
        if self._answers_at_once:
            self._training.write(address, words)
            return
        written = {address + place: word for place, word in enumerate(words)}
        if not written.keys() <= self._writable:
            raise Refusal(ILLEGAL_ADDRESS)
        if self._drive.ignores_writes:
            return
        try:
            self._act(written)
        except ValueError as error:
            raise Refusal(ILLEGAL_VALUE) from error

    async def let_out(self, reply: bytes) -> bytes | None:
        """Return the reply, spoiled as the fault that is being played demands."""
        fault = None if self._answers_at_once else self._drive.link_fault
        match fault:
            case FaultKind.SILENCE:
                return None
            case FaultKind.LATE_REPLIES:
                await self._clock.sleep_until(self._clock.now() + LATE)
            case FaultKind.CORRUPT_REPLIES:
                return spoiled(reply, next(self._damage))
        return reply

    def inject(self, fault: Fault) -> None:
        """Make the drive or its connection faulty."""
        self._drive.inject(fault)

    def _act(self, written: dict[int, int]) -> None:
        everything = self._all(told=False) | written
        words = [everything.get(address, RESERVED) for address in range(max(everything) + 1)]
        stop = self._profile.registers.get("stop")
        self._set_clock(written)
        command = self._map.command(words, 0)
        keep_alive = self._profile.registers["keep_alive"].integer(words, 0)
        if stop is not None and written.get(stop.address):
            self._drive.halt()
        elif keep_alive != self._keep_alive or command != self._drive.command:
            self._drive.obey(command, alive=keep_alive != self._keep_alive)
        self._keep_alive = keep_alive

    def _set_clock(self, written: dict[int, int]) -> None:
        """Set the clock if all of its parts were written in one frame; raise `ValueError` for no date."""
        parts = [self._profile.registers[part] for part in CLOCK_PARTS if part in self._profile.registers]
        if parts and all(part.address in written for part in parts):
            year, month, day, hour, minute, second = (written[part.address] for part in parts)
            self._drive.set_wall_clock(datetime(year, month, day, hour, minute, second, tzinfo=UTC))

    def _clock_words(self) -> dict[int, int]:
        shown = self._drive.wall_clock.astimezone(UTC)
        words: dict[int, int] = {}
        for part in CLOCK_PARTS:
            words |= self._map.words(part, getattr(shown, part))
        return words

    def _all(self, *, told: bool) -> dict[int, int]:
        """Return every word that is mapped; `told` says that the master gets to know it."""
        words = self._status(told=told)
        words |= self._map.words("echo", self._keep_alive) | self._map.words("keep_alive", self._keep_alive)
        self._heartbeat = (self._heartbeat + 1) & 0xFFFF
        words |= self._map.words("heartbeat", self._heartbeat)
        words |= self._map.words("uptime", int(self._drive.uptime.total_seconds()))
        words |= self._clock_words()
        return words

    def _status(self, *, told: bool) -> dict[int, int]:
        """Return what does not change while nothing happens; made anew only if something did."""
        feedback = self._drive.observe(told=told)
        command = self._drive.command
        self._notice_restart(feedback.boot_count)
        if self._known is None or self._known[0] is not feedback or self._known[1] is not command:
            words = self._fixed | self._map.feedback_words(feedback) | self._map.command_words(command)
            self._known = feedback, command, words
        return dict(self._known[2])

    def _notice_restart(self, boot_count: int) -> None:
        if boot_count != self._boot_count:
            self._boot_count = boot_count
            self._keep_alive = 0

    def _word(self, name: str, words: dict[int, int]) -> int:
        register = self._profile.registers.get(name)
        return words[register.address] if register is not None else 0

    def _fixed_words(self) -> dict[int, int]:
        """Return what never changes: identity, watchdog time-out, and zero where nothing is said."""
        words: dict[int, int] = {}
        for block in self._profile.blocks.values():
            words |= dict.fromkeys(range(block.address, block.address + block.count), RESERVED)
        for register in self._profile.registers.values():
            words |= dict.fromkeys(register.addresses, RESERVED)
            if register.expect is not None:
                words |= self._map.words(register.name, register.expect)
        watchdog = self._profile.watchdog
        if watchdog is not None and watchdog.readback is not None and self._drive.watchdog is not None:
            milliseconds = self._drive.watchdog.total_seconds() * 1000.0
            words |= self._map.words(watchdog.readback, round(milliseconds))
        return words


def spoiled(reply: bytes, turn: int) -> bytes:
    """Return a reply that is wrong in one of four ways."""
    match turn % 4:
        case 0:
            return pack(">H", int.from_bytes(reply[:2], "big") ^ 0x0101) + reply[2:]
        case 1:
            return reply[:6] + bytes((reply[6] ^ 0x40,)) + reply[7:]
        case 2:
            return reply[:7] + bytes((reply[7] ^ 0x02,)) + reply[8:]
        case _:
            return reply[:4] + b"\x00\x02" + reply[6:8]
