"""What a look at a drive brought, before it is trusted with anything: plain data for the set-up page."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from app.base.message import NOTHING, Message
from app.tracker.settings.config import DriveConfig


class CheckOutcome(StrEnum):
    """How a drive answered when it was only read."""

    ANSWERED = "answered"
    SILENT = "silent"
    WRONG_DEVICE = "wrong_device"
    UNUSABLE = "unusable"


@dataclass(frozen=True, slots=True)
class RegisterReading:
    """One register as it was read: `shown` is its value in words, empty where `trouble` says why not."""

    name: str
    address: int
    unit_id: int
    shown: str
    unit: str
    text: str
    verified: bool
    source: str
    trouble: Message = NOTHING


@dataclass(frozen=True, slots=True)
class DriveReadings:
    """What was read of a drive. `watchdog_s` is its own time-out read back, None where it tells none."""

    outcome: CheckOutcome
    message: Message
    registers: tuple[RegisterReading, ...] = ()
    watchdog_s: float | None = None
    watchdog_action: str = ""


@dataclass(frozen=True, slots=True)
class DriveCheck:
    """One test of a connection: with which settings, when, by whom, and what came of it."""

    drive: DriveConfig
    at: datetime
    by: str
    readings: DriveReadings


@dataclass(frozen=True, slots=True)
class ProfileChoice:
    """A profile that can be chosen; `watchdog` says what the device does without commands, empty: nothing."""

    name: str
    title: str
    verified: bool
    source: str
    unverified: tuple[str, ...]
    watchdog: str
    trouble: Message = NOTHING


@dataclass(frozen=True, slots=True)
class PortChoice:
    """A serial port of the machine by its most lasting name, and what hangs on it."""

    port: str
    description: str


@dataclass(frozen=True, slots=True)
class DriveChoices:
    """What there is to choose from when a drive is set up."""

    profiles: tuple[ProfileChoice, ...] = ()
    ports: tuple[PortChoice, ...] = ()
