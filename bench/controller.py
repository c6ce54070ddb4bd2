"""The controller: one tick, and a whole day of one tracker at one tick a second

The peer is the bare closed loop in plain Python: sun's direction, axis target, error on the sphere, deadband,
one row of numbers; no activities, guards, trust, limits, events.
"""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from statistics import median
from time import perf_counter

from app.base.angles import separation_deg
from app.base.clock import VirtualClock
from app.simulation.simulated import SimulatedDrive
from app.sun.position import Algorithm, Location, SunPosition, sun_position
from app.tracker.commands.commands import Home, SelectMode, Track
from app.tracker.controller import Controller
from app.tracker.memory.memory import TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.mode import Mode
from bench.table import Row, at_most, beside

COMMAND = "python -m bench controller"
DAY_S = 86_400
DAY_BOUND_S, TICK_BOUND_US = 0.7, 5.0
SECOND = timedelta(seconds=1)
SAMSUN = Location(41.2867, 36.33, 4.0)
MIDNIGHT = datetime(2026, 6, 21, tzinfo=UTC)
Frame = tuple[float, ...]


class Rig:
    """The real controller on the simulated drive, tracking."""

    def __init__(self, at: datetime) -> None:
        config = TrackerConfig("T1", "Tracker 1")
        self.clock = VirtualClock(at)
        self.drive = SimulatedDrive(config, self.clock, watchdog=None)
        self.controller = Controller(config, TrackerMemory(), self.drive.capabilities)
        self.tick(at, sun_position(Algorithm.PSA, SAMSUN, at))
        self.controller.handle(Home(), at)
        for _ in range(300):
            self.second()
        self.controller.handle(SelectMode(Mode.DUAL), self.clock.now())
        self.controller.handle(Track(), self.clock.now())
        for _ in range(300):
            self.second()

    def second(self) -> None:
        self.clock.advance(SECOND)
        now = self.clock.now()
        self.tick(now, sun_position(Algorithm.PSA, SAMSUN, now))

    def tick(self, now: datetime, sun: SunPosition) -> None:
        seen = Observation(now, now, sun, sun, self.drive.observe(), True, SAMSUN, 1)
        self.drive.obey(self.controller.tick(seen).command)


class BareLoop:
    """The same decision with nothing around it."""

    def __init__(self, deadband_deg: float) -> None:
        self.deadband_deg = deadband_deg
        self.azimuth_deg = self.elevation_deg = 0.0

    def tick(self, sun: SunPosition) -> Frame:
        azimuth_deg, elevation_deg = sun.azimuth_deg, max(0.0, sun.apparent_elevation_deg)
        off_deg = separation_deg(self.azimuth_deg, self.elevation_deg, azimuth_deg, elevation_deg)
        if off_deg > self.deadband_deg:
            self.azimuth_deg, self.elevation_deg = azimuth_deg, elevation_deg
        return (azimuth_deg, elevation_deg, self.azimuth_deg, self.elevation_deg, off_deg)


@dataclass(frozen=True, slots=True)
class Size:
    """How many ticks, how often, and how many seconds of a day."""

    ticks: int = 20_000
    rounds: int = 5
    seconds: int = DAY_S


SMALL = Size(ticks=100, rounds=1, seconds=600)


def measure(size: Size = Size()) -> list[Row]:
    """Return the table."""
    return [*_one_tick(size), *_one_day(size.seconds)]


def _one_tick(size: Size) -> list[Row]:
    rig, bare = Rig(MIDNIGHT + timedelta(hours=6)), BareLoop(0.5)
    now = rig.clock.now()
    sun, feedback = sun_position(Algorithm.PSA, SAMSUN, now), rig.drive.observe()
    instants = [now + timedelta(milliseconds=number) for number in range(size.ticks)]
    seen = [Observation(at, at, sun, sun, feedback, True, SAMSUN, 1) for at in instants]
    ours_s, peer_s = [], []
    for _ in range(size.rounds):
        ours_s.append(_seconds(lambda: [rig.controller.tick(one) for one in seen]))
        peer_s.append(_seconds(lambda: [bare.tick(sun) for _ in seen]))
    ours_us, peer_us = (median(times_s) / size.ticks * 1e6 for times_s in (ours_s, peer_s))
    name = "one tick, tracking within the deadband"
    return [
        at_most(name, ours_us, TICK_BOUND_US, "us", COMMAND),
        beside(name, f"{ours_us:.2f} us", f"the bare loop {peer_us:.2f} us", peer_us / ours_us, COMMAND),
    ]


def _one_day(seconds: int) -> list[Row]:
    rig, bare = Rig(MIDNIGHT - timedelta(minutes=10)), BareLoop(0.5)
    begin, frames = rig.clock.now(), list[Frame]()

    def ours() -> None:
        for _ in range(seconds):
            rig.second()
            frames.append(rig.controller.frame())

    def peer() -> None:
        for number in range(seconds):
            bare.tick(sun_position(Algorithm.PSA, SAMSUN, begin + SECOND * number))

    ours_s, peer_s = _seconds(ours), _seconds(peer)
    assert len(frames) == seconds
    name = f"a day, {seconds:,} ticks with sun, drive and frames"
    told = f"the bare loop with sun {peer_s:.2f} s"
    return [
        at_most(name, ours_s, DAY_BOUND_S, "s", COMMAND),
        beside(name, f"{ours_s:.2f} s", told, peer_s / ours_s, COMMAND),
    ]


def _seconds(work: Callable[[], object]) -> float:
    begun = perf_counter()
    work()
    return perf_counter() - begun
