"""What one tracker knows between two ticks, and the few ways to change it."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from typing import Any, NamedTuple

from app.base.message import Message
from app.sun.position import SunPosition
from app.tracker.memory.memory import TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.motion.following_error import AxisWatch
from app.tracker.motion.machine_watch import AxisGuard
from app.tracker.protections.guarding import Guarding
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.activity import HOLDING, Activity
from app.tracker.state.parts import ANSWERS, LONG_AGO, NO_COUNTDOWN, NO_FAULT, NO_SETPOINTS, NOT_WAITING
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.motion import DriveCapabilities, DriveCommand, Feedback, Velocity
from app.tracker.values.reason import Reason

HALTED = DriveCommand()
STANDING = DriveCommand(Velocity(0.0), Velocity(0.0))
"""Stands still like `HALTED`, and also ends a search for the origin switches that the drive still pursues."""
PRESSES_REMEMBERED = 1000
LAST_REQUEST_NUMBER = 30_000
"""Request numbers stay within 16 bits: drives keep them in a register."""


class Turn(NamedTuple):
    """What an activity wants at one tick. `target` is of the sky, `sun` the sun that is followed."""

    activity: Activity
    command: DriveCommand = HALTED
    target: Orientation | None = None
    sun: SunPosition | None = None


class ControllerState:
    """State of one tracker. Activities read it and change it by `say`, `remember` and `kill_press`."""

    __slots__ = (
        "activity",
        "actor",
        "alarmed",
        "capabilities",
        "clear_until",
        "command",
        "config",
        "connection",
        "countdowns",
        "dead_presses",
        "events",
        "feedback",
        "feedback_at",
        "guarding",
        "guards",
        "made_up",
        "memory",
        "now",
        "reached",
        "recovery",
        "request_number",
        "seen",
        "setpoints",
        "site_time",
        "started_at",
        "sun",
        "supply_since",
        "target",
        "ticks",
        "told_before",
        "via",
        "waiting",
        "watches",
        "zeroed",
    )

    def __init__(self, config: TrackerConfig, memory: TrackerMemory, capabilities: DriveCapabilities) -> None:
        self.config = config
        self.memory = memory
        self.capabilities = capabilities
        self.activity: Activity = HOLDING
        self.actor = CONTROLLER
        self.via = ""
        self.now = LONG_AGO
        self.site_time = LONG_AGO
        self.started_at: datetime | None = None
        self.seen: Observation | None = None
        self.feedback: Feedback | None = None
        self.feedback_at: datetime | None = None
        self.connection = ANSWERS
        self.made_up = False
        self.waiting = NOT_WAITING
        self.countdowns = NO_COUNTDOWN
        self.guarding: Guarding | None = None
        self.alarmed: Reason | None = None
        self.command = HALTED
        self.setpoints = NO_SETPOINTS
        self.target: Orientation | None = None
        self.sun: SunPosition | None = None
        self.events: list[Event] = []
        self.dead_presses: dict[str, None] = {}
        self.request_number = 0
        self.zeroed: frozenset[Axis] = frozenset(Axis) if memory.home else frozenset()
        self.watches: Mapping[Axis, AxisWatch] = {}
        self.ticks = 0
        self.guards: Mapping[Axis, AxisGuard] = {}
        self.told_before = HALTED
        self.supply_since: datetime | None = None
        self.clear_until: datetime | None = None
        self.recovery = NO_FAULT
        self.reached = False

    def say(self, kind: EventKind, message: Message, **data: Any) -> None:
        """Note that something happened; it leaves with the present call's events."""
        self.events.append(Event(self.site_time, kind, self.config.tracker_id, message, self.actor, data))

    def drain(self) -> tuple[Event, ...]:
        """Return what happened since the last call, and forget it."""
        if not self.events:
            return ()
        events = tuple(self.events)
        self.events.clear()
        return events

    def remember(self, **changes: Any) -> None:
        """Replace fields of the memory; an unchanged memory stays the same object."""
        changed = replace(self.memory, **changes)
        if changed != self.memory:
            self.memory = changed

    def kill_press(self, press_id: str) -> None:
        """Make a press dead for ever; only the newest are remembered, older ones fail by their sequence."""
        self.dead_presses[press_id] = None
        if len(self.dead_presses) > PRESSES_REMEMBERED:
            del self.dead_presses[next(iter(self.dead_presses))]

    def shift_reading(self, feedback: Feedback | None) -> None:
        """Go by the newest reading as it is from another home position."""
        self.feedback = feedback

    def next_request(self) -> int:
        """Return a request number that the drive has not answered yet."""
        done = self.feedback.request_done if self.feedback else 0
        self.request_number = max(self.request_number, done) % LAST_REQUEST_NUMBER + 1
        return self.request_number
