"""The words of the protections: what may hold, and what a page is told of it."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from app.tracker.values.reason import Reason


class Protection(StrEnum):
    """What may hold, the strongest first: TYPHOON to TRACK of Xia et al. (2015)."""

    WIND_STOW = "wind_stow"
    SNOW = "snow"
    NIGHT = "night"
    WAIT = "wait"
    LOW_LIGHT_HOLD = "low_light_hold"
    TRACK = "track"

    @classmethod
    def _missing_(cls, value: object) -> "Protection | None":
        """Return what is stored under a former name, those of Xia et al."""
        return {"typhoon": cls.WIND_STOW, "hibernate": cls.LOW_LIGHT_HOLD}.get(str(value))


@dataclass(frozen=True, slots=True)
class ProtectionState:
    """The protection that holds: since when, until when at the earliest (None: not known), and why.

    Both instants are by the site's clock, as a snapshot's `at`.
    """

    protection: Protection
    since: datetime
    earliest_end: datetime | None
    reason: Reason


@dataclass(frozen=True, slots=True)
class WarningState:
    """A motion that nobody at the machine asked for begins in `remaining_s` seconds; Stop prevents it."""

    remaining_s: float
    reason: Reason


@dataclass(frozen=True, slots=True)
class MaintenanceLock:
    """Somebody works on the machine: nothing moves it automatically until the lock is released."""

    name: str
    by: str
    since: datetime
    reason: str


@dataclass(frozen=True, slots=True)
class ServiceMode:
    """Somebody serves the machine, since an instant of the site's clock; it moves at slow hand speed."""

    name: str
    by: str
    since: datetime


@dataclass(frozen=True, slots=True)
class ServiceState:
    """Service mode as it is shown: the word that the area is clear counts so long; 0: not given or over."""

    mode: ServiceMode
    clear_for_s: float


@dataclass(frozen=True, slots=True)
class LinkQuality:
    """How the drive's replies come: 99 of 100 within `p99_s`, where `allowed_s` are granted."""

    p99_s: float
    allowed_s: float

    @property
    def slow(self) -> bool:
        """Return whether replies take more than half of the time that they may."""
        return self.p99_s > self.allowed_s / 2.0
