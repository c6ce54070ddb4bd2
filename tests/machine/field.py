"""A field of trackers, prepared in its database as after commissioning: homed, in mode dual, tracking."""

import asyncio
from collections.abc import Iterable
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from itertools import accumulate
from pathlib import Path

from app.base.clock import SystemClock
from app.link.messages import SiteCommand
from app.link.metrics import Lateness, MachineMetrics
from app.simulation.kept_positions import KeptPositions
from app.simulation.position_memory import AxisMemory, PositionFile, PositionMemory
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.sun.position import Algorithm, Location, sun_position
from app.tracker.memory.memory import (
    ClockSetting,
    Confirmation,
    HomeTrust,
    SiteState,
    StepName,
    TrackerMemory,
    TrackerState,
)
from app.tracker.settings.config import DriveConfig, DriveKind, NightBehaviour, Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind, SiteSnapshot
from app.tracker.supervision.weather_protection import TWILIGHT_DEG
from app.tracker.values.mode import Mode
from tests.machine.service import Service

SHELTERED = frozenset({ActivityName.STOWING, ActivityName.STOWED})
BOOT_COUNT = 1
LATITUDE = 10.0


@dataclass(frozen=True, slots=True)
class Line:
    """Drives that share one line: how it is reached, how many there are, and their own watchdogs."""

    drive: DriveConfig
    drives: int
    memory: Path
    watchdog_ms: int = 500

    @property
    def doors(self) -> tuple[str, ...]:
        """Return the words that have `heliopanel drive-sim` serve them."""
        drive, serial = self.drive, self.drive.serial
        reached = {
            DriveKind.MODBUS_TCP: ("--tcp", drive.line),
            DriveKind.MODBUS_RTU_OVER_TCP: ("--rtu-over-tcp", drive.line),
            DriveKind.MODBUS_RTU: ("--rtu", serial.port, "--baud-rate", str(serial.baud_rate), "--paced"),
        }[drive.kind]
        units = [word for unit in range(1, self.drives + 1) for word in ("--unit", str(unit))]
        kept = ("--memory", str(self.memory), "--watchdog-ms", str(self.watchdog_ms))
        return (*reached, *units, *kept)

    def memory_of(self, unit: int) -> Path:
        """Return where `heliopanel drive-sim` keeps the position of one of them."""
        return self.memory if unit == 1 else self.memory.with_stem(f"{self.memory.stem}-{unit}")


def noon_place(at: datetime) -> Location:
    """Return a place where it is the middle of the day now, so that trackers track at any hour."""
    hours = at.hour + at.minute / 60.0
    return Location(LATITUDE, (12.0 - hours) * 15.0 % 360.0 - 360.0 * ((12.0 - hours) * 15.0 % 360.0 > 180.0))


def dawn_place(at: datetime) -> Location:
    """Return a place where the sun wakes trackers at an instant."""
    west, east = 60.0, 120.0
    noon_deg = noon_place(at).longitude_deg
    for _ in range(40):
        middle = (west + east) / 2.0
        sun = sun_position(Algorithm.PSA, _at_longitude(noon_deg - middle), at)
        west, east = (middle, east) if sun.apparent_elevation_deg > TWILIGHT_DEG else (west, middle)
    return _at_longitude(noon_deg - west)


def _at_longitude(longitude_deg: float) -> Location:
    return Location(LATITUDE, (longitude_deg + 180.0) % 360.0 - 180.0)


def prepare(
    data_dir: Path, count: int, location: Location, line: Line | None = None, *, revision: int = 1
) -> None:
    """Store a site with its trackers, and where its simulated drives stand.

    Steps are confirmed for a revision of the location: for the next one, trackers wait for that.
    """
    now = datetime.now(UTC) - timedelta(minutes=1)
    data_dir.mkdir(mode=0o700, parents=True, exist_ok=True)
    url = f"sqlite:///{data_dir / 'heliopanel.db'}"
    upgrade(url)
    store = open_writer(url)
    try:
        store.save_site(_site(location, now))
        for state in _trackers(count, now, line, revision):
            store.save_tracker(state)
    finally:
        store.close()
    stands = _stands(location)
    kept = KeptPositions(data_dir / "drives")
    for number in range(count):
        kept.of(f"T{number + 1}").keep(stands)
    if line is not None:
        for unit in range(1, line.drives + 1):
            PositionFile(line.memory_of(unit)).keep(stands)


def _stands(location: Location) -> PositionMemory:
    sun = sun_position(Algorithm.PSA, location, SystemClock().now())
    azimuth_deg, elevation_deg = sun.azimuth_deg, max(10.0, min(80.0, sun.apparent_elevation_deg))
    return PositionMemory(
        AxisMemory(azimuth_deg, 0.0, homed=True),
        AxisMemory(elevation_deg, 0.0, homed=True),
        BOOT_COUNT,
        trusted=True,
    )


def _site(location: Location, now: datetime) -> SiteState:
    said = Confirmation(now, "technician", 1)
    return SiteState(
        name="Field",
        location=location,
        location_revision=1,
        clock=ClockSetting("system", 0.0, now, "technician"),
        confirmations={StepName.LOCATION: said, StepName.CLOCK: said},
    )


def _trackers(count: int, now: datetime, line: Line | None, revision: int) -> Iterable[TrackerState]:
    said = Confirmation(now, "technician", revision)
    memory = TrackerMemory(
        mode=Mode.DUAL,
        orientation=Orientation(180.0, 45.0),
        tracking_on=True,
        home=HomeTrust(now, "technician", "set manually", BOOT_COUNT),
        confirmations={StepName.HOMING: said, StepName.MODE: said, StepName.RUN: said},
    )
    for number in range(1, count + 1):
        drive = DriveConfig()
        if line is not None and number <= line.drives:
            drive = replace(line.drive, unit=number)
        config = TrackerConfig(f"T{number}", f"Tracker {number}", drive=drive, night=NightBehaviour.HOLD)
        yield TrackerState(config, memory)


def sheltered(site: SiteSnapshot | None) -> int:
    """Return how many trackers are on their way to their stow place, or there."""
    return 0 if site is None else sum(one.activity in SHELTERED for one in site.trackers)


def doing(site: SiteSnapshot | None, activity: ActivityName) -> int:
    """Return how many trackers do this."""
    return 0 if site is None else sum(one.activity is activity for one in site.trackers)


@dataclass(frozen=True, slots=True)
class Punctuality:
    """How late the ticks between two looks began, milliseconds, each at most two per cent too high."""

    ticks: int
    p50_ms: float
    p99_ms: float
    p999_ms: float
    max_ms: float

    @classmethod
    def between(cls, before: MachineMetrics, after: MachineMetrics) -> "Punctuality":
        assert before.boot_id == after.boot_id, "the controller was restarted"
        counted = {one.at_most_ms: one.ticks for one in before.lateness}
        late = [
            Lateness(one.at_most_ms, one.ticks - counted.get(one.at_most_ms, 0)) for one in after.lateness
        ]
        late = [one for one in late if one.ticks]
        if not late:
            return cls(0, 0.0, 0.0, 0.0, 0.0)
        sums = list(accumulate(one.ticks for one in late))

        def at(share: float) -> float:
            return next(
                one.at_most_ms for one, sofar in zip(late, sums, strict=True) if sofar >= share * sums[-1]
            )

        return cls(sums[-1], at(0.5), at(0.99), at(0.999), late[-1].at_most_ms)

    def __str__(self) -> str:
        return (
            f"lateness p50 {self.p50_ms:.1f}, p99 {self.p99_ms:.1f}, p99.9 {self.p999_ms:.1f}, "
            f"max {self.max_ms:.1f} ms of {self.ticks} ticks"
        )


async def last_of(
    service: Service, kind: EventKind, order: SiteCommand, trackers: int, *, within_s: float
) -> float:
    """Give an order; return after how many seconds the last tracker did this, by the controller's clock."""
    done: dict[str | None, datetime] = {}
    updates = service.link.updates()
    begun = datetime.now(UTC)
    asking = asyncio.create_task(service.ask(order))
    async with asyncio.timeout(within_s):
        async for update in updates:
            done |= {event.tracker_id: event.at for event in update.events if event.kind is kind}
            if len(done) >= trackers:
                break
    await asking
    return (max(done.values()) - begun).total_seconds()
