"""One tracker's mind: `handle` and `tick` are the two ways in."""

from datetime import datetime
from typing import NamedTuple

from app.tracker.commands import Command
from app.tracker.config import TrackerConfig
from app.tracker.memory import Confirmation, Pointing, StepName, TrackerMemory
from app.tracker.motion import DriveCapabilities, DriveCommand
from app.tracker.observation import Observation
from app.tracker.snapshot import Event, Snapshot


class Tick(NamedTuple):
    """What comes out of one tick: what the drive shall do, and what happened."""

    command: DriveCommand
    events: tuple[Event, ...]


class Controller:
    """Decides for one tracker; pure: reads no clock and no drive, knows only what it is told."""

    def __init__(self, config: TrackerConfig, memory: TrackerMemory, capabilities: DriveCapabilities) -> None:
        self._config = config
        self._memory = memory
        self._capabilities = capabilities

    @property
    def config(self) -> TrackerConfig:
        """Return what the engineer set."""
        return self._config

    @property
    def memory(self) -> TrackerMemory:
        """Return what must survive a power cut; a new object whenever it changed."""
        return self._memory

    def handle(self, command: Command, now: datetime, actor: str = "operator") -> tuple[Event, ...]:
        """Obey a command and return what happened, or raise `CommandRejected` with all unmet conditions."""
        raise NotImplementedError

    def tick(self, seen: Observation) -> Tick:
        """Return what the drive shall do from now on and what happened since the last tick."""
        raise NotImplementedError

    def snapshot(self, at: datetime) -> Snapshot:
        """Return everything known after the last tick, stamped `at`."""
        raise NotImplementedError

    def frame(self) -> tuple[float, ...]:
        """Return the last tick as one row of `recording.COLUMNS`; the first two columns are NaN."""
        raise NotImplementedError

    def deadline(self) -> datetime | None:
        """Return the instant by which `tick` must be called again (a jog's lease ends), else None."""
        raise NotImplementedError

    def configure(self, config: TrackerConfig, capabilities: DriveCapabilities) -> None:
        """Take over a new configuration; the caller sees to it that the tracker stands still."""
        raise NotImplementedError

    def set_pointing(self, pointing: Pointing) -> None:
        """Take over a correction from sightings."""
        raise NotImplementedError

    def confirm(self, step: StepName, confirmation: Confirmation) -> None:
        """Remember that the operator said a step is right."""
        raise NotImplementedError
