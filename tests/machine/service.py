"""The whole service as real processes on free ports: started, killed, frozen and asked over its own link."""

import asyncio
import json
import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from app.base.clock import SystemClock
from app.drives.drive import Drive
from app.link.client import LinkClient
from app.link.codec import Answer, Request
from app.link.messages import ConfigureTracker, MachineUnreachable, Order, SetClock, SetLocation, SiteCommand
from app.machine.drive_factory import DriveFactory
from app.sun.position import Location
from app.tracker.commands.commands import Command, SetHome
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.state.snapshot import ActivityName, SiteSnapshot, Snapshot
from app.tracker.values.motion import Feedback
from tests.e2e.product import DRIVE_SIM
from tests.patience import PATIENCE_S, eventually, pause
from tests.ports import free_port

__all__ = ["SAMSUN", "DriveSimulator", "Service", "config_for", "end"]

SAMSUN = Location(41.2867, 36.33, 4.0)


@dataclass
class DriveSimulator:
    """`heliopanel drive-sim` as a process of its own, and a second pair of eyes on it."""

    port: int
    process: asyncio.subprocess.Process
    eyes: Drive

    @classmethod
    async def start(cls) -> "DriveSimulator":
        port = free_port()
        process = await asyncio.create_subprocess_exec(
            *DRIVE_SIM, "--tcp", f"127.0.0.1:{port}", stdout=asyncio.subprocess.PIPE
        )
        assert process.stdout is not None
        async with asyncio.timeout(PATIENCE_S):
            await process.stdout.readline()
        return cls(port, process, DriveFactory(SystemClock()).make(config_for(port)))

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
        # Not `close`, which would send a stop through a second master.
        await end(self.process)


def config_for(port: int) -> TrackerConfig:
    return TrackerConfig("T1", "Tracker 1", drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))


async def end(process: asyncio.subprocess.Process) -> int:
    if process.returncode is None:
        process.terminate()
    async with asyncio.timeout(PATIENCE_S):
        return await process.wait()


class PatientLink(LinkClient):
    """Waits long for an answer: how long a busy disk takes is none of what is judged here."""

    async def _ask(self, request: Request, patience_s: float) -> Answer:
        return await super()._ask(request, PATIENCE_S)


@dataclass
class Service:
    """`heliopanel serve` in a data folder of its own."""

    data_dir: Path
    port: int
    process: asyncio.subprocess.Process
    link: LinkClient
    lines: list[dict[str, object]] = field(default_factory=list)
    reading: asyncio.Task[None] | None = None

    @classmethod
    async def start(cls, data_dir: Path, *, tick_ms: int = 100) -> "Service":
        port = free_port()
        environment = os.environ | {
            "HELIOPANEL_DATA_DIR": str(data_dir),
            "HELIOPANEL_PORT": str(port),
            "HELIOPANEL_LOG_FORMAT": "json",
            "HELIOPANEL_TICK_MS": str(tick_ms),
        }
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "app.cli", "serve",
            env=environment, stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.PIPE,
        )  # fmt: skip
        service = cls(data_dir, port, process, PatientLink(data_dir / "machine.sock"))
        service.reading = asyncio.create_task(service._read())
        try:
            await service.link.start()
            await service.link.watch(frozenset({"T1"}))
            await eventually(lambda: service.link.latest() is not None)
        except BaseException:
            await service.stop()
            raise
        return service

    async def _read(self) -> None:
        assert self.process.stderr is not None
        async for line in self.process.stderr:
            with suppress(ValueError):
                self.lines.append(json.loads(line))

    def starts(self, child: str) -> list[int]:
        """Return the process ids that a child has had."""
        return [
            int(str(line["process_id"]))
            for line in self.lines
            if line.get("event") == "child_started" and line.get("child") == child
        ]

    def deaths(self) -> list[str]:
        """Return which child has died of what, in order: a code below 0 is the signal that killed it."""
        return [f"{line['child']} {line['code']}" for line in self.lines if line.get("event") == "child_died"]

    def signal(self, child: str, number: signal.Signals) -> None:
        os.kill(self.starts(child)[-1], number)

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

    async def until(self, reached: Callable[[Snapshot], bool], *, within_s: float = PATIENCE_S) -> None:
        def is_so() -> bool:
            seen = self.tracker()
            return seen is not None and bool(seen.actions) and reached(seen)

        await eventually(is_so, within_s=within_s)

    async def commission(self, drive: DriveSimulator, *, port: int | None = None) -> None:
        """Point T1 at a drive, give it a place and a clock, and call where its axes stand zero."""
        await self.ask(ConfigureTracker(config_for(port or drive.port)))
        await self.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
        await self.ask(SetClock("system"))
        await self.until(lambda seen: not seen.actions["set_home"])
        await self.ask(SetHome())
        await self.until(lambda seen: seen.homed and seen.activity is ActivityName.HOLDING)

    async def stop(self) -> int:
        await self.link.close()
        code = await end(self.process)
        if self.reading is not None:
            await self.reading
        return code
