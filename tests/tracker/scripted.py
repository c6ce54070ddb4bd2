"""A controller whose readings are written down by hand: for what the simulated drive never does."""

from dataclasses import replace
from datetime import timedelta
from typing import Any

from app.base.clock import VirtualClock
from app.sun.position import Algorithm, SunPosition, sun_position
from app.tracker.commands.commands import Command
from app.tracker.controller import Controller
from app.tracker.memory.memory import TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.state.snapshot import Event, EventKind, Snapshot
from app.tracker.values.motion import AxisFeedback, DriveCapabilities, DriveCommand, Feedback
from tests.tracker.plant import BLANK, CONFIG, MORNING, SAMSUN

CAPABILITIES = DriveCapabilities(
    automatic_homing=True,
    watchdog_s=0.5,
    settable_clock=False,
    limit_switches=True,
    description="Written down",
    verified=True,
)


class Scripted:
    """`reading` is what the next tick sees; nothing moves unless the story says so."""

    def __init__(self, memory: TrackerMemory = BLANK, *, capabilities: dict[str, Any] | None = None) -> None:
        self.clock = VirtualClock(MORNING)
        self.period = timedelta(seconds=0.1)
        axis = AxisFeedback(0.0, 0.0, moving=False, homed=memory.home is not None)
        self.reading: Feedback | None = Feedback(axis, axis, boot_count=1)
        self.sun: SunPosition | None = sun_position(Algorithm.PSA, SAMSUN, MORNING)
        self.dawn: SunPosition | None = None
        self.controller = Controller(CONFIG, memory, replace(CAPABILITIES, **(capabilities or {})))
        self.told = DriveCommand()
        self.events: list[Event] = []

    def ask(self, command: Command) -> list[EventKind]:
        happened = list(self.controller.handle(command, self.clock.now(), "technician"))
        self.events += happened
        return [event.kind for event in happened + self.tick()]

    def sees(self, **changes: Any) -> None:
        """Have the next tick read this from the drive."""
        assert self.reading is not None
        self.reading = replace(self.reading, **changes)

    def answers(self, **changes: Any) -> None:
        """Have the drive say that it has done what it was asked for."""
        assert self.told.request is not None
        self.sees(request_done=self.told.request.number, **changes)

    def tick(self) -> list[Event]:
        now = self.clock.now()
        seen = Observation(now, now, self.sun, self.dawn, self.reading, True, SAMSUN, 1)
        self.told, events = self.controller.tick(seen)
        self.events += events
        return list(events)

    def forward(self, seconds: float) -> None:
        end = self.clock.now() + timedelta(seconds=seconds)
        while self.clock.now() < end:
            self.clock.advance(self.period)
            self.tick()

    @property
    def snapshot(self) -> Snapshot:
        return self.controller.snapshot(self.clock.now())

    def happened(self, kind: EventKind) -> list[Event]:
        return [event for event in self.events if event.kind is kind]
