"""The training registers of the simulated drive: faults on demand, and where it really points."""

from collections.abc import Sequence
from datetime import timedelta

from app.drives.register import Access, Register, WordType
from app.modbus.server import ILLEGAL_ADDRESS, ILLEGAL_VALUE, Refusal
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated_machine import SimulatedMachine
from app.tracker.settings.axes import Axis

LATE = timedelta(milliseconds=400)
FIRST = 900
FAULT = Register(
    "fault",
    FIRST,
    WordType.UINT16,
    access=Access.READ_WRITE,
    text="0 clears all, else the number of a fault; acts at once",
)
AXIS = Register(
    "axis", FIRST + 1, WordType.UINT16, access=Access.READ_WRITE, text="0 both, 1 azimuth, 2 elevation"
)
AMOUNT = Register(
    "amount",
    FIRST + 2,
    WordType.INT32,
    scale=0.001,
    access=Access.READ_WRITE,
    text="Degrees of a jump or misalignment, degrees a second of a slip, a fault code, the share that a "
    "cloud takes, W/m2 of a stuck light sensor, the share of the deceleration that a long stop has, or volts",
)
TRUE_AZIMUTH = Register(
    "true_azimuth", FIRST + 4, WordType.INT32, scale=0.001, unit="deg", text="Where the panel really points"
)
TRUE_ELEVATION = Register(
    "true_elevation", FIRST + 6, WordType.INT32, scale=0.001, unit="deg", text="Where the panel really points"
)
REGISTERS = (FAULT, AXIS, AMOUNT, TRUE_AZIMUTH, TRUE_ELEVATION)
LAST = FIRST + 7
COMMAND_WORDS = 4
AXES = (None, Axis.AZIMUTH, Axis.ELEVATION)
KINDS = tuple(FaultKind)


class Training:
    """Registers that no real drive has. They answer even while a fault of the connection is played."""

    def __init__(self, drive: SimulatedMachine) -> None:
        self._drive = drive
        self._last: tuple[int, ...] = (0, 0, 0, 0)

    def holds(self, address: int) -> bool:
        """Return whether an address lies in the training block."""
        return FIRST <= address <= LAST

    def words(self) -> dict[int, int]:
        """Return every word of the block."""
        truth = self._drive.true_orientation
        values = (
            *self._last,
            *TRUE_AZIMUTH.words(truth.azimuth_deg),
            *TRUE_ELEVATION.words(truth.elevation_deg),
        )
        return {FIRST + place: word for place, word in enumerate(values)}

    def write(self, address: int, words: Sequence[int]) -> None:
        """Play the fault that the four words (fault, axis, amount) name; fault 0 clears all."""
        if address != FIRST or len(words) != COMMAND_WORDS:
            raise Refusal(ILLEGAL_ADDRESS)
        kind, axis = words[0], words[1]
        if kind > len(KINDS) or axis >= len(AXES):
            raise Refusal(ILLEGAL_VALUE)
        self._last = tuple(words)
        if kind == 0:
            self._drive.end_injected_faults()
            return
        self._drive.inject(Fault(KINDS[kind - 1], AXES[axis], AMOUNT.value(words, FIRST)))


def training_words(fault: Fault | None) -> tuple[int, ...]:
    """Return the four words that play a fault, or clear all."""
    if fault is None:
        return (0, 0, 0, 0)
    return (KINDS.index(fault.kind) + 1, AXES.index(fault.axis), *AMOUNT.words(fault.amount))
