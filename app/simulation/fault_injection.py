"""Faults on demand at the other end of a drive: simulated here, or in `heliopanel drive-sim` over Modbus."""

from collections.abc import Sequence
from typing import Protocol

from app.base.message import N_
from app.drives.dialects.plc import PlcDrive
from app.drives.drive import Drive
from app.drives.linear_actuator import TransmittedDrive
from app.drives.scaled import CorrectedDrive
from app.modbus.bus import BusUnit
from app.simulation.faults import Fault
from app.simulation.sim_training import COMMAND_WORDS, FIRST, training_words
from app.simulation.simulated import SimulatedDrive

TRAINED_PROFILE = "simulated-plc"
"""The one profile whose simulated device has training registers; a real device has none and refuses them."""


class Trainer(Protocol):
    """A simulated machine that can be made to suffer."""

    async def play(self, faults: Sequence[Fault]) -> None:
        """Suffer these faults from now on, or raise `DriveError`."""

    async def clear(self) -> None:
        """Be sound again, or raise `DriveError`."""


def trainer_of(drive: Drive) -> Trainer | None:
    """Return what plays faults on a drive behind its gear and actuators, None for one that may be real."""
    while isinstance(drive, CorrectedDrive | TransmittedDrive):
        drive = drive.inner
    match drive:
        case SimulatedDrive():
            return HereTrainer(drive)
        case PlcDrive(profile_name=name, link=link) if name == TRAINED_PROFILE:
            return ThereTrainer(link)
        case _:
            return None


class HereTrainer:
    """Faults of the simulated drive in this program."""

    def __init__(self, drive: SimulatedDrive) -> None:
        self._drive = drive

    async def play(self, faults: Sequence[Fault]) -> None:
        """Suffer these faults from now on."""
        for fault in faults:
            self._drive.inject(fault)

    async def clear(self) -> None:
        """Be sound again."""
        self._drive.end_injected_faults()


class ThereTrainer:
    """Faults of the simulated drive in another program, over its training registers.

    They are read before they are written: a device that does not have them refuses, and nothing is written.
    They answer even while a fault of the connection is played.
    """

    def __init__(self, link: BusUnit) -> None:
        self._link = link

    async def play(self, faults: Sequence[Fault]) -> None:
        """Suffer these faults from now on, or raise `DriveError`."""
        await self._look()
        for fault in faults:
            await self._write(training_words(fault))

    async def clear(self) -> None:
        """Be sound again, or raise `DriveError`."""
        await self._look()
        await self._write(training_words(None))

    async def _look(self) -> None:
        await self._link.read(FIRST, COMMAND_WORDS, what=N_("the training registers"))

    async def _write(self, words: Sequence[int]) -> None:
        await self._link.write(FIRST, words, what=N_("the training registers"), ticket=None)
