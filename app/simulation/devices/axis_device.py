"""What the simulated axis drives have in common: a table of words, one axis of the machine, its faults."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from itertools import count

from app.base.clock import Clock
from app.drives.register import WordOrder
from app.modbus.server import ILLEGAL_ADDRESS, ILLEGAL_FUNCTION, Refusal
from app.simulation.faults import FaultKind
from app.simulation.sim_plc import spoiled
from app.simulation.sim_training import LATE
from app.simulation.simulated_machine import SimulatedMachine
from app.tracker.settings.axes import Axis
from app.tracker.values.motion import HALT, AxisFeedback


class AxisDevice(ABC):
    """A drive that moves one axis of a simulated machine. Positions are steps of its motor's encoder."""

    order = WordOrder.HIGH_FIRST

    def __init__(self, machine: SimulatedMachine, axis: Axis, clock: Clock, steps_per_deg: float) -> None:
        self.machine = machine
        self.axis = axis
        self.steps_per_deg = steps_per_deg
        self._clock = clock
        self._words: dict[int, int] = {}
        self._boot_count = machine.boot_count
        self._damage = count()
        self.homing = self.homing_failed = False
        self.power_up()

    @property
    @abstractmethod
    def writable(self) -> Collection[int]:
        """Return the addresses that a master may write."""

    @abstractmethod
    def power_up(self) -> None:
        """Fill the table with what the device holds after power-up."""

    @abstractmethod
    def refresh(self, feedback: AxisFeedback, fault_code: int) -> None:
        """Bring what the device measures up to the present."""

    @abstractmethod
    def act(self, written: Collection[int]) -> None:
        """Do what was written."""

    def read_bits(self, function: int, address: int, count: int) -> list[bool]:
        """Refuse: these drives have no bits."""
        raise Refusal(ILLEGAL_FUNCTION)

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        """Refuse: these drives have no bits."""
        raise Refusal(ILLEGAL_FUNCTION)

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        """Return holding registers."""
        self.live()
        try:
            return [self._words[one] for one in range(address, address + count)]
        except KeyError as error:
            raise Refusal(ILLEGAL_ADDRESS) from error

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        """Write holding registers and act on them, all or none."""
        written = {address + place: word for place, word in enumerate(words)}
        if not written.keys() <= set(self.writable):
            raise Refusal(ILLEGAL_ADDRESS)
        if self.machine.ignores_writes:
            return
        self.live()
        self._words |= written
        self.act(written.keys())
        self.live()

    async def let_out(self, reply: bytes) -> bytes | None:
        """Return the reply, spoiled as the fault that is being played demands."""
        match self.machine.link_fault:
            case FaultKind.SILENCE:
                return None
            case FaultKind.LATE_REPLIES:
                await self._clock.sleep_until(self._clock.now() + LATE)
            case FaultKind.CORRUPT_REPLIES:
                return spoiled(reply, next(self._damage))
        return reply

    def live(self) -> None:
        """Let everything happen that the time since the last request brings."""
        observed = self.machine.observe()
        if observed.boot_count != self._boot_count:
            self._boot_count = observed.boot_count
            self.homing = self.homing_failed = False
            self.power_up()
        feedback = self.feedback
        if self.homing and (observed.fault_code or not feedback.moving):
            self.homing = False
            found = not observed.fault_code and feedback.at_origin and self.machine.set_home(self.axis)
            self.homing_failed = not found
            feedback = self.feedback
        self.refresh(feedback, observed.fault_code)

    @property
    def feedback(self) -> AxisFeedback:
        """Return what the axis measures now."""
        observed = self.machine.observe()
        return observed.azimuth if self.axis is Axis.AZIMUTH else observed.elevation

    def seek_origin(self) -> None:
        """Begin the search for the origin switch."""
        self.homing, self.homing_failed = True, False
        self.machine.seek_origin(self.axis)

    def halt(self) -> None:
        """Ramp down; a search for the origin is given up."""
        self.homing = False
        self.machine.turn(self.axis, HALT)

    def steps(self, axis_deg: float) -> int:
        """Return an axis angle in steps."""
        return round(axis_deg * self.steps_per_deg)

    def put(self, address: int, word: int) -> None:
        """Put one word into the table."""
        self._words[address] = word & 0xFFFF

    def put_wide(self, address: int, value: int) -> None:
        """Put a 32-bit value into the table."""
        high, low = value >> 16 & 0xFFFF, value & 0xFFFF
        first, second = (high, low) if self.order is WordOrder.HIGH_FIRST else (low, high)
        self._words |= {address: first, address + 1: second}

    def word(self, address: int) -> int:
        """Return one word of the table."""
        return self._words[address]

    def signed(self, address: int) -> int:
        """Return one word of the table with its sign."""
        value = self._words[address]
        return value - 0x10000 if value & 0x8000 else value

    def wide(self, address: int) -> int:
        """Return a signed 32-bit value of the table."""
        first, second = self._words[address], self._words[address + 1]
        value = first << 16 | second if self.order is WordOrder.HIGH_FIRST else second << 16 | first
        return value - 0x1_0000_0000 if value & 0x8000_0000 else value
