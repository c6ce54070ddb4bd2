"""The controller: one tick, and a whole day of one tracker at one tick a second

The peer is the bare closed loop in plain Python: sun's direction, axis target, error on the sphere, deadband,
one row of numbers; no activities, guards, trust, limits, events.
"""

from datetime import UTC, datetime, timedelta
from statistics import median
from time import perf_counter

from app.angles import separation_deg
from app.clock import VirtualClock
from app.drives.simulated import SimulatedDrive
from app.sun.position import Algorithm, Location, SunPosition, sun_position
from app.tracker.commands import Home, SelectMode, Track
from app.tracker.config import TrackerConfig
from app.tracker.controller import Controller
from app.tracker.memory import TrackerMemory
from app.tracker.mode import Mode
from app.tracker.observation import Observation
from bench.table import Row

COMMAND = "python -m bench controller"
DAY_S = 86_400
BOUND_S = 2.0
ROUNDS = 5
TICKS = 20_000
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


def measure() -> list[Row]:
    """Return the table."""
    return [_one_tick(), _one_day()]


def _one_tick() -> Row:
    rig = Rig(MIDNIGHT + timedelta(hours=6))
    now = rig.clock.now()
    sun, feedback = sun_position(Algorithm.PSA, SAMSUN, now), rig.drive.observe()
    instants = [now + timedelta(milliseconds=number) for number in range(TICKS)]
    seen = [Observation(at, at, sun, sun, feedback, True, SAMSUN, 1) for at in instants]
    bare = BareLoop(0.5)
    ours_s, peer_s = [], []
    for _ in range(ROUNDS):
        begun = perf_counter()
        for one in seen:
            rig.controller.tick(one)
        ours_s.append(perf_counter() - begun)
        begun = perf_counter()
        for one in seen:
            bare.tick(one.sun or sun)
        peer_s.append(perf_counter() - begun)
    ours, peer = median(ours_s) / TICKS * 1e6, median(peer_s) / TICKS * 1e6
    name = "One tick, tracking within the deadband (bound 10 us); peer: the bare loop"
    return Row(name, f"{ours:.2f} us", f"{peer:.2f} us", f"{ours / peer:.1f}", COMMAND)


def _one_day() -> Row:
    rig = Rig(MIDNIGHT - timedelta(minutes=10))
    begin = rig.clock.now()
    bare = BareLoop(0.5)
    begun = perf_counter()
    frames: list[Frame] = []
    for _ in range(DAY_S):
        rig.second()
        frames.append(rig.controller.frame())
    ours_s = perf_counter() - begun
    begun = perf_counter()
    for number in range(DAY_S):
        bare.tick(sun_position(Algorithm.PSA, SAMSUN, begin + SECOND * number))
    peer_s = perf_counter() - begun
    assert len(frames) == DAY_S
    name = (
        f"A day, 86,400 ticks with sun, drive and frames (bound {BOUND_S:g} s); peer: the bare loop with sun"
    )
    return Row(name, f"{ours_s:.2f} s", f"{peer_s:.2f} s", f"{ours_s / peer_s:.1f}", COMMAND)
