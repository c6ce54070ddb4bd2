"""A drive with something between it and the site: hanging, failing, refusing or talking nonsense."""

import asyncio
from dataclasses import dataclass, field, replace
from datetime import datetime

from app.drives.drive import Drive
from app.modbus.errors import DriveSilent
from app.tracker.values.motion import DriveCapabilities, DriveCommand, Feedback
from tests.site.plant import Plant


@dataclass
class WrappedDrive:
    """A drive that can be made to hang, to fail or to answer nonsense."""

    inner: Drive
    hangs: bool = False
    nonsense: bool = False
    refuses: bool = False
    deaf: bool = False
    cannot_stop: bool = False
    watchdog_off: bool = False
    stops: int = 0
    written: list[DriveCommand] = field(default_factory=list)

    @property
    def capabilities(self) -> DriveCapabilities:
        known = self.inner.capabilities
        return replace(known, watchdog_s=None) if self.watchdog_off else known

    async def read(self) -> Feedback:
        if self.hangs:
            await asyncio.Event().wait()
        if self.nonsense:
            raise RuntimeError("a programming error")
        return await self.inner.read()

    async def write(self, command: DriveCommand) -> None:
        if self.refuses:
            raise DriveSilent("The drive did not take the command.")
        self.written.append(command)
        await self.inner.write(command)

    async def stop(self) -> None:
        self.stops += 1
        if self.deaf:
            await asyncio.Event().wait()
        if self.cannot_stop:
            raise RuntimeError("a programming error")
        await self.inner.stop()

    async def set_clock(self, at: datetime) -> None:
        if self.hangs:
            await asyncio.Event().wait()
        await self.inner.set_clock(at)

    async def close(self) -> None:
        await self.inner.close()


def wrapped(plant: Plant, tracker_id: str) -> WrappedDrive:
    drive = plant.drives[tracker_id]
    assert isinstance(drive, WrappedDrive)
    return drive
