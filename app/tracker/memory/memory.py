"""What a tracker and its site must still know after a power cut."""

from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum

from app.base.message import N_, NOTHING, Message, say
from app.sun.horizon import FLAT, Horizon
from app.sun.position import Location
from app.tracker.memory.drive_tests import Proofs
from app.tracker.protections.words import MaintenanceLock, Protection, ServiceMode
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, Orientation, TrackerConfig
from app.tracker.settings.protections import StowName
from app.tracker.values.mode import Mode
from app.tracker.values.notifications import Notifications
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather import Quantity
from app.tracker.weather.weather_windows import WeatherWindows


class StepName(StrEnum):
    """The five steps, in order."""

    LOCATION = "location"
    CLOCK = "clock"
    HOMING = "homing"
    MODE = "mode"
    RUN = "run"


@dataclass(frozen=True, slots=True)
class HomeTrust:
    """Why the zero is believed: who set it, when, how, and in which life of the drive."""

    set_at: datetime
    by: str
    how: Message
    boot_count: int


@dataclass(frozen=True, slots=True)
class Confirmation:
    """A step was saved: when, by whom, and under which revision of the location."""

    at: datetime
    by: str
    location_revision: int


@dataclass(frozen=True, slots=True)
class HomeShift:
    """What is added to the drive's own count to get the angles of the axes, degrees."""

    azimuth_deg: float = 0.0
    elevation_deg: float = 0.0


@dataclass(frozen=True, slots=True)
class FormerHome:
    """The home position before it was set last, so that this can be undone: its shift and who set it.

    `axes` were set, in the life of the drive that `boot_count` names; `zeroed` had been set before.
    """

    axes: tuple[Axis, ...]
    shift: HomeShift
    boot_count: int
    home: HomeTrust | None
    home_lost: Message
    home_lost_at: datetime | None
    zeroed: tuple[Axis, ...]
    confirmation: Confirmation | None


@dataclass(frozen=True, slots=True)
class Sighting:
    """The panel faced the sun here: sun and panel at the same instant, degrees."""

    at: datetime
    sun_azimuth_deg: float
    sun_elevation_deg: float
    panel_azimuth_deg: float
    panel_elevation_deg: float


@dataclass(frozen=True, slots=True)
class Pointing:
    """Correction from sightings: what is added to a sky direction to get axis angles, degrees.

    `lean_north_deg` and `lean_east_deg` tilt the mast towards north and east.
    """

    azimuth_offset_deg: float = 0.0
    elevation_offset_deg: float = 0.0
    lean_north_deg: float = 0.0
    lean_east_deg: float = 0.0
    residual_deg: float | None = None


@dataclass(frozen=True, slots=True)
class CommissioningLock:
    """Settings that were commissioned are not to be changed: who said so, and when."""

    by: str
    at: datetime


@dataclass(frozen=True, slots=True)
class RejectedSetting:
    """A stored value that was not accepted at the start, what is used in its place, and why, for people.

    `is_last_accepted` says that the value in use is the one with which the tracker ran before; else it is the
    usual one.
    """

    what: Message
    stored: Message
    used: Message
    why: Message
    is_last_accepted: bool = False


@dataclass(frozen=True, slots=True)
class TrackerMemory:
    """The latches of one tracker: on disk before the command that changes them is acknowledged.

    `home_lost` says why a zero that was set is no longer trusted, `home_lost_at` since when (None: not
    known); `former_drive` are the drive settings before the last change, so that it can be undone. `stow` is
    the place it was sent to by command and stays in until it is resumed or commanded otherwise; `protection`
    is the one that holds, which must be seen good before tracking goes on; `sensors` are those that were ever
    seen, so that they can be missed. `show_moves` says that a show moves the panel by itself, or did so when
    it was cut off and nobody has asked for anything since. `control_epoch` is the newest number that orders
    were fenced with. `rejected` are the stored settings that were not accepted at the start; nothing moves
    until somebody has saved the settings. `home_shift` is not zero while setting the
    home position was undone, `former_home` is what it would be undone to.
    """

    mode: Mode | None = None
    orientation: Orientation = Orientation(180.0, 45.0)
    tracking_on: bool = False
    home: HomeTrust | None = None
    home_lost: Message = NOTHING
    home_lost_at: datetime | None = None
    showing: str | None = None
    show_moves: bool = False
    fault_code: str | None = None
    fault_text: Message = NOTHING
    confirmations: dict[StepName, Confirmation] = field(default_factory=dict)
    sightings: tuple[Sighting, ...] = ()
    pointing: Pointing = Pointing()
    proofs: Proofs = field(default_factory=Proofs)
    former_drive: DriveConfig | None = None
    stow: StowName | None = None
    protection: Protection | None = None
    sensors: tuple[Quantity, ...] = ()
    lock: MaintenanceLock | None = None
    service: ServiceMode | None = None
    control_epoch: int = 0
    settings_lock: CommissioningLock | None = None
    rejected: tuple[RejectedSetting, ...] = ()
    home_shift: HomeShift = HomeShift()
    former_home: FormerHome | None = None


@dataclass(frozen=True, slots=True)
class TrackerState:
    """Everything stored about one tracker."""

    config: TrackerConfig
    memory: TrackerMemory


@dataclass(frozen=True, slots=True)
class ClockSetting:
    """The operator's clock: `system` trusts the computer's clock, `manual` adds an offset to it."""

    source: str = "unset"
    offset_s: float = 0.0
    set_at: datetime | None = None
    by: str = ""


@dataclass(frozen=True, slots=True)
class AgesFrom:
    """The instant from which the age of what is kept counts, and how long the machine has run since, s.

    It follows the site's clock only as far as the machine runs: a clock that was ahead makes nothing old.
    """

    at: datetime
    ran_s: float = 0.0


@dataclass(frozen=True, slots=True)
class MetStation:
    """A weather station that is read over Modbus TCP: SunSpec model 307."""

    host: str
    port: int = 502
    unit: int = 1

    def __post_init__(self) -> None:
        if not self.host.strip() or len(self.host) > 253:
            raise ValueError(N_("Give the host name or address of the weather station."))
        if not 1 <= self.port <= 65535:
            raise ValueError(N_("The port of the weather station must lie between 1 and 65535."))
        if not 0 <= self.unit <= 255:
            raise ValueError(N_("The unit of the weather station must lie between 0 and 255."))

    @property
    def name(self) -> Message:
        """Return what it is called where its readings are shown."""
        return say("SunSpec {host}:{port} unit {unit}", host=self.host, port=self.port, unit=self.unit)


@dataclass(frozen=True, slots=True)
class SiteSettings:
    """What is set for the whole site, its place and clock aside."""

    name: str
    horizon: Horizon
    met_station: MetStation | None
    simulated_weather: SimulatedStation | None
    weather_windows: WeatherWindows
    notifications: Notifications


@dataclass(frozen=True, slots=True)
class SiteState:
    """Everything stored about the site that its trackers share; it has one weather station at most.

    `weather_windows` None are the usual ones, with the age that the machine was set up with. `former` are the
    settings of trackers before their last change, their drives aside, so that it can be undone; `former_site`
    are those of the site. `ages_from` None is the newest entry of the journal.
    """

    name: str = N_("Solar site")
    location: Location | None = None
    location_revision: int = 0
    time_zone: str = "UTC"
    clock: ClockSetting = ClockSetting()
    ages_from: AgesFrom | None = None
    confirmations: dict[StepName, Confirmation] = field(default_factory=dict)
    met_station: MetStation | None = None
    notifications: Notifications = field(default_factory=Notifications)
    simulated_weather: SimulatedStation | None = None
    weather_windows: WeatherWindows | None = None
    horizon: Horizon = FLAT
    former: dict[str, TrackerConfig] = field(default_factory=dict)
    former_site: SiteSettings | None = None
