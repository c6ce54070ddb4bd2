"""The whole service as real processes on free ports: started, killed, frozen and asked over its own link."""

import asyncio
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from signal import Signals

from app.base.clock import SystemClock
from app.drives.drive import Drive
from app.link.client import LinkClient
from app.link.codec import Answer, Request
from app.link.messages import (
    ConfigureTracker,
    MachineUnreachable,
    Order,
    SetClock,
    SetLocation,
    SiteCommand,
)
from app.machine.drive_factory import DriveFactory
from app.store.engine import open_reader
from app.store.reader import DatabaseReader
from app.store.store import JournalFilter
from app.sun.position import Location
from app.tracker.commands.commands import Command, SelectMode, SetHome, Stop, Track
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.state.snapshot import ActivityName, Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.alarm_words import AlarmState
from app.tracker.values.mode import Mode
from app.tracker.values.motion import Feedback
from tests.e2e.product import DriveSim, Product
from tests.patience import PATIENCE_S, eventually, pause

SAMSUN = Location(41.2867, 36.33, 4.0)
GONE = (AlarmState.RETURNED, AlarmState.NORMAL)


@dataclass
class DriveSimulator:
    """`heliopanel drive-sim` as a process of its own, and a second pair of eyes on it."""

    sim: DriveSim
    eyes: Drive

    @classmethod
    async def start(cls) -> "DriveSimulator":
        sim = await asyncio.to_thread(DriveSim.start)
        return cls(sim, DriveFactory(SystemClock()).make(config_for(sim.port)))

    @property
    def port(self) -> int:
        return self.sim.port

    async def look(self) -> Feedback:
        return await self.eyes.read()

    async def rests(self, *, within_s: float = PATIENCE_S) -> float:
        """Return after how many seconds both axes stood still, or fail."""
        loop = asyncio.get_running_loop()
        begun = loop.time()
        while True:
            seen = await self.look()
            if not (seen.azimuth.moving or seen.elevation.moving):
                return loop.time() - begun
            assert loop.time() - begun <= within_s, "the axes still turn"
            await pause()

    async def stop(self) -> None:
        # The eyes are not closed, which would send a stop through a second master.
        await asyncio.to_thread(self.sim.stop)


def config_for(port: int) -> TrackerConfig:
    return TrackerConfig("T1", "Tracker 1", drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))


class PatientLink(LinkClient):
    """Waits long for an answer: how long a busy disk takes is none of what is judged here."""

    async def _ask(self, request: Request, patience_s: float) -> Answer:
        return await super()._ask(request, PATIENCE_S)


class Linked:
    """A controller in a data folder, asked over its own link, and what its database tells."""

    link: LinkClient
    data_dir: Path

    async def ask(self, command: Command | SiteCommand, tracker_id: str = "T1") -> SiteSnapshot:
        """Give an order once."""
        addressed = None if isinstance(command, SiteCommand) else tracker_id
        return await self.link.execute(Order(command, "technician", addressed))

    async def ask_until_taken(self, command: Command | SiteCommand) -> SiteSnapshot:
        async with asyncio.timeout(PATIENCE_S):
            while True:
                try:
                    return await self.ask(command)
                except MachineUnreachable:
                    await pause()

    def tracker(self) -> Snapshot | None:
        latest = self.link.latest()
        return None if latest is None else latest.trackers[0]

    def boot_id(self) -> str:
        latest = self.link.latest()
        return "" if latest is None else latest.boot_id

    def alarms(self) -> set[str]:
        """Return the codes of what is wrong now."""
        latest = self.link.latest()
        return set() if latest is None else {one.code for one in latest.alarms if one.state not in GONE}

    def reader(self) -> "closing[DatabaseReader]":
        """Return what reads its database."""
        return closing(open_reader(f"sqlite:///{self.data_dir / 'heliopanel.db'}"))

    def journal(self, *kinds: EventKind) -> list[Event]:
        """Return what the database tells of such events, newest first."""
        with self.reader() as reader:
            found = reader.journal(JournalFilter(limit=1000, kinds=kinds))
            return [entry.event for entry in found]

    async def until(self, reached: Callable[[Snapshot], bool], *, within_s: float = PATIENCE_S) -> None:
        def is_so() -> bool:
            seen = self.tracker()
            return seen is not None and bool(seen.actions) and reached(seen)

        await eventually(is_so, within_s=within_s)


@dataclass
class Service(Linked):
    """`heliopanel serve` in a data folder of its own."""

    product: Product
    link: LinkClient
    data_dir: Path

    @classmethod
    async def start(cls, data_dir: Path, *, tick_ms: int = 100) -> "Service":
        """Return once the controller is heard; its panel may still start."""
        product = Product.begin(data_dir, tick_ms=str(tick_ms))
        service = cls(product, PatientLink(data_dir / "machine.sock"), data_dir)
        try:
            await service.link.start()
            await service.link.watch(frozenset({"T1"}))
            await eventually(lambda: service.link.latest() is not None)
        except BaseException:
            await service.stop()
            raise
        return service

    @property
    def port(self) -> int:
        return self.product.port

    def starts(self, child: str) -> list[int]:
        return self.product.starts(child)

    def deaths(self) -> list[str]:
        return self.product.deaths()

    def signal(self, child: str, number: Signals) -> None:
        self.product.signal(child, number)

    async def until_holding(self) -> None:
        await self.until(lambda seen: seen.activity is ActivityName.HOLDING)

    async def until_served(self) -> None:
        """Return once the panel answers."""
        await asyncio.to_thread(self.product.until_ready)

    async def rest(self) -> None:
        """Stop whatever it does."""
        await self.ask_until_taken(Stop())
        await self.until_holding()

    async def commission(self, drive: DriveSimulator | None = None, *, port: int | None = None) -> None:
        """Point T1 at a drive, if one is given, give it a place, a clock, and a zero where it stands."""
        if drive is not None:
            await self.ask(ConfigureTracker(config_for(port or drive.port)))
        await self.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
        await self.ask(SetClock("system"))
        await self.home()

    async def home(self) -> None:
        """Call where the axes stand zero."""
        await self.until(lambda seen: not seen.actions["set_home"])
        await self.ask(SetHome())
        await self.until(lambda seen: seen.homed and seen.activity is ActivityName.HOLDING)

    async def track(self) -> None:
        await self.ask(SelectMode(Mode.DUAL))
        await self.ask(Track())

    async def stop(self) -> int:
        await self.link.close()
        return await asyncio.to_thread(self.product.stop)
