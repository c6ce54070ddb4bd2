"""A tracker on a virtual clock: the real controller and the simulated drive, told what time it is."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta

from app.base.clock import VirtualClock
from app.simulation.simulated import SimulatedDrive
from app.sun.events import next_rise
from app.sun.position import Algorithm, Location, SunPosition, sun_position
from app.tracker.commands.commands import Command
from app.tracker.controller import Controller
from app.tracker.memory.memory import HomeTrust, TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.protections.words import LinkQuality
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCommand, DriveRequest, RequestKind
from app.tracker.weather.weather import NOTHING_SENSED, Quality, Reading, Sensed
from tests.amount import amount

SAMSUN = Location(41.2867, 36.33, 4.0)
MORNING = datetime(2026, 6, 21, 6, 0, tzinfo=UTC)
CONFIG = TrackerConfig("T1", "Tracker 1")
TRUST = HomeTrust(MORNING, "technician", "set manually", 1)
LONG, SHORT = timedelta(seconds=60), timedelta(seconds=5)
FAR_APART = timedelta(seconds=amount(0.4, 0.0))
"""Within the watchdog of the simulated drive."""
BLANK = TrackerMemory()
READY = TrackerMemory(mode=Mode.DUAL, home=TRUST)


class Plant:
    """Ask, let time pass, look: `drive` is the tracker that is not there."""

    def __init__(
        self,
        memory: TrackerMemory = BLANK,
        *,
        config: TrackerConfig = CONFIG,
        at: datetime = MORNING,
        location: Location | None = SAMSUN,
        watchdog: timedelta | None = timedelta(seconds=0.5),
    ) -> None:
        self.clock = VirtualClock(at - timedelta(minutes=5))
        self.drive = SimulatedDrive(config, self.clock, watchdog=watchdog)
        self.location = location
        self.revision = 1
        self.clock_trusted = True
        self.clock_error = timedelta(0)
        self.cut = False
        self.period = timedelta(seconds=0.1)
        self.events: list[Event] = []
        self.dawn: SunPosition | None = None
        self._dawn_at: datetime | None = None
        self.told = DriveCommand()
        self.weather = NOTHING_SENSED
        self.link: LinkQuality | None = None
        if memory.home is not None:
            self._be_homed(at)
        self.clock.move_to(at)
        self.controller = Controller(config, memory, self.drive.capabilities)

    def ask(self, command: Command, actor: str = "technician", via: str = "") -> list[EventKind]:
        """Give a command and tick at once, as the loop does; return what happened."""
        happened = list(self.controller.handle(command, self.clock.now(), actor, via))
        self.events += happened
        happened += self.tick()
        return [event.kind for event in happened]

    def tick(self) -> list[Event]:
        """Read, decide, write."""
        now = self.clock.now()
        site_time = now + self.clock_error
        feedback = None if self.cut else self.drive.observe()
        sun = self._sun(site_time)
        seen = Observation(
            now=now,
            site_time=site_time,
            sun=sun,
            dawn=self.dawn,
            feedback=feedback,
            clock_trusted=self.clock_trusted,
            location=self.location,
            location_revision=self.revision,
            weather=self.weather,
            link=self.link,
        )
        done = self.controller.tick(seen)
        self.told = done.command
        if not self.cut and not self.controller.is_silent:
            self.drive.obey(done.command)
        self.events += done.events
        return list(done.events)

    def blow(
        self,
        wind_mps: float | None = 3.0,
        *,
        snow_kg: float | None = 0.0,
        irradiance_wm2: float | None = 600.0,
        wind_from_deg: float | None = None,
    ) -> "Plant":
        """Have a station report this from now on; None is a sensor that reports nothing."""
        wind, snow, light = (
            Reading() if value is None else Reading(value, Quality.GOOD, 0.0, "station")
            for value in (wind_mps, snow_kg, irradiance_wm2)
        )
        self.weather = Sensed(wind, snow, light, wind_mps, wind_from_deg)
        return self

    def forward(self, seconds: float, look: Callable[[], None] | None = None, *, every: int = 1) -> "Plant":
        """Let time pass, with a tick every period and a look every so many ticks: a look takes six ticks.

        In the middle of a long time, ticks are further apart, but in the soak.
        """
        end, ticks = self.clock.now() + timedelta(seconds=seconds), 0
        quick, slow = self.clock.now() + LONG, end - SHORT
        while (now := self.clock.now()) < end:
            period = max(self.period, FAR_APART) if quick <= now < slow else self.period
            self.clock.move_to(min(end, now + period))
            self.tick()
            ticks += 1
            if look is not None and ticks % every == 0:
                look()
        return self

    def jump(self, by: timedelta) -> None:
        """Have the site's clock jump, as if somebody set the computer's; nobody trusts it from now on."""
        self.clock_error += by
        self.clock_trusted = False
        self._dawn_at = None

    def leap(self, to: datetime) -> None:
        """Be later at once, with no tick in between."""
        self.clock.move_to(to)

    @property
    def snapshot(self) -> Snapshot:
        return self.controller.snapshot(self.clock.now())

    @property
    def activity(self) -> ActivityName:
        return self.controller.activity

    @property
    def azimuth_deg(self) -> float:
        return self.drive.observe().azimuth.position_deg

    @property
    def elevation_deg(self) -> float:
        return self.drive.observe().elevation.position_deg

    def happened(self, kind: EventKind) -> list[Event]:
        """Return the events of one kind so far."""
        return [event for event in self.events if event.kind is kind]

    def reasons(self, action: str) -> set[str]:
        """Return the codes that forbid an action now."""
        return {reason.code for reason in self.snapshot.actions[action]}

    def _be_homed(self, at: datetime) -> None:
        """Have the drive search its origin before the story begins."""
        search = DriveCommand(request=DriveRequest(901, RequestKind.HOME))
        self.drive.obey(search)
        while self.drive.observe().request_done != search.request.number:
            self.clock.advance(self.period)
            self.drive.obey(search)
        self.clock.move_to(at)
        self.drive.obey(DriveCommand())

    def _sun(self, now: datetime) -> SunPosition | None:
        if self.location is None:
            return None
        if self._dawn_at is None or now >= self._dawn_at:
            self._dawn_at = next_rise(Algorithm.PSA, self.location, now)
            self.dawn = self._dawn_at and sun_position(Algorithm.PSA, self.location, self._dawn_at)
            self._dawn_at = self._dawn_at or now + timedelta(hours=1)
        return sun_position(Algorithm.PSA, self.location, now)
