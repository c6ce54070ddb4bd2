"""A whole site on a virtual clock with simulated drives: ask it for something and let time pass."""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

from app.alarms.alarm import Alarm
from app.base.clock import VirtualClock
from app.drives.drive import Drive
from app.link.messages import Order, ReleaseControl, SetClock, SetLocation, SiteCommand
from app.simulation.position_memory import Memory
from app.simulation.simulated import SimulatedDrive
from app.site.recording.gathering import BackgroundWriter
from app.site.site import Site, SiteOptions
from app.sun.position import Location
from app.tracker.commands.commands import Command, CommandRejected, Home, SelectMode, Track
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.mode import Mode

SUMMER_NOON = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
SAMSUN = Location(41.2867, 36.33, 4.0)
STEP = timedelta(seconds=1)
IDLE_ROUNDS = 12
FIRST = TrackerState(TrackerConfig("T1", "Tracker 1"), TrackerMemory())


@dataclass
class Plant:
    """The site, its clock and its drives."""

    clock: VirtualClock
    site: Site
    drives: dict[str, Drive]
    events: list[Event] = field(default_factory=list)
    listening: asyncio.Task[None] | None = None
    closed: bool = False

    async def start(self) -> None:
        self.listening = asyncio.create_task(self._listen())
        await settle()
        await self.site.start()
        await settle()

    async def close(self) -> None:
        if self.closed:
            return
        self.closed = True
        await self.site.close()
        if self.listening is not None:
            await self.listening

    async def ask(
        self, command: Command | SiteCommand, tracker_id: str | None = "T1", **more: object
    ) -> SiteSnapshot:
        addressed = None if isinstance(command, SiteCommand) else tracker_id
        asking = asyncio.create_task(self.site.execute(Order(command, "technician", addressed, **more)))  # type: ignore[arg-type]
        while not asking.done():
            await settle()
        return await asking

    async def forward(self, *, seconds: float) -> None:
        end = self.clock.now() + timedelta(seconds=seconds)
        while self.clock.now() < end:
            self.clock.move_to(min(end, self.clock.now() + STEP, self.clock.next_wake or end))
            await settle()

    async def until(self, reached: Callable[[Snapshot], bool], *, within_s: float = 300.0) -> None:
        end = self.clock.now() + timedelta(seconds=within_s)
        while not reached(self.tracker()):
            assert self.clock.now() < end, f"not reached: {self.tracker()}"
            await self.forward(seconds=0.1)

    def tracker(self, tracker_id: str = "T1") -> Snapshot:
        return self.site.model.snapshot(self.site.model.tracker(tracker_id), self.site.model.now())

    def happened(self, kind: EventKind) -> list[Event]:
        return [event for event in self.events if event.kind is kind]

    async def commission(self, tracker_id: str = "T1") -> None:
        await self.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
        await self.ask(SetClock("system"))
        await self.ask(Home(), tracker_id)
        await self.until(
            lambda _: (
                self.tracker(tracker_id).homed and self.tracker(tracker_id).activity is ActivityName.HOLDING
            )
        )
        with suppress(CommandRejected):
            await self.ask(ReleaseControl(tracker_id))

    async def track(self, *, until: Callable[[Snapshot], bool] | None = None) -> None:
        """Commission the tracker and let it track, until something is so."""
        await self.commission()
        await self.ask(SelectMode(Mode.DUAL))
        await self.ask(Track())
        if until is not None:
            await self.until(until)

    def latest(self) -> SiteSnapshot:
        """Return what everybody was told last."""
        seen = self.site.latest()
        assert seen is not None
        return seen

    def alarms(self) -> dict[str, str]:
        """Return the messages of the alarms that are active."""
        return {one.code: one.message for one in self.latest().alarms if one.returned_at is None}

    async def _listen(self) -> None:
        async for update in self.site.updates():
            self.events.extend(update.events)


Begun = Callable[..., Awaitable[Plant]]


async def settle() -> None:
    """Let every task run until it waits for the clock."""
    for _ in range(IDLE_ROUNDS):
        await asyncio.sleep(0)


def make_plant(
    *,
    start: datetime = SUMMER_NOON,
    writer: BackgroundWriter | None = None,
    state: SiteState | None = None,
    trackers: tuple[TrackerState, ...] = (FIRST,),
    wrap: Callable[[Drive], Drive] = lambda drive: drive,
    options: SiteOptions | None = None,
    memory: Memory | None = None,
    alarms: tuple[Alarm, ...] = (),
) -> Plant:
    """Return a site on a virtual clock; with a memory every drive begins as that says."""
    clock = VirtualClock(start)
    drives: dict[str, Drive] = {}

    def make_drive(config: TrackerConfig) -> Drive:
        drives[config.tracker_id] = wrap(SimulatedDrive(config, clock, memory=memory))
        return drives[config.tracker_id]

    site = Site(
        clock, make_drive, state or SiteState(), trackers, writer=writer, options=options, alarms=alarms
    )
    return Plant(clock, site, drives)
