"""The one shape that pages, REST, stream, journal and replay all read."""

from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any

from app.base.message import NOTHING, Message
from app.sun.position import Location, SunPosition
from app.tracker.commands.control import ControlState
from app.tracker.memory.memory import CommissioningLock, HomeTrust, RejectedSetting
from app.tracker.motion.hybrid import HybridPhase
from app.tracker.protections.words import (
    LinkQuality,
    MaintenanceLock,
    ProtectionState,
    ServiceState,
    WarningState,
)
from app.tracker.settings.config import Orientation
from app.tracker.settings.protections import StowName
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.alarm_words import AlarmCounts, AlarmNow
from app.tracker.values.mode import Mode
from app.tracker.values.motion import LightReading
from app.tracker.values.operator_message import OperatorMessage, StateWord
from app.tracker.values.reason import Reason
from app.tracker.weather.weather import Quality, Quantity, WeatherNow


class ActivityName(StrEnum):
    """What the machine is doing."""

    HOLDING = "holding"
    JOGGING = "jogging"
    MOVING = "moving"
    SETTING_HOME = "setting_home"
    HOMING = "homing"
    TRACKING = "tracking"
    SHOWING = "showing"
    STOPPING = "stopping"
    FAULTED = "faulted"
    MEASURING = "measuring"
    STOWING = "stowing"
    STOWED = "stowed"


class ShowPhase(StrEnum):
    """Where a show is."""

    GOING_TO_START = "going_to_start"
    READY = "ready"
    RUNNING = "running"
    PAUSED = "paused"


@dataclass(frozen=True, slots=True)
class Pair:
    """Azimuth and elevation of the same thing, degrees."""

    azimuth_deg: float
    elevation_deg: float


@dataclass(frozen=True, slots=True)
class AxisState:
    """Switches and trust of one axis as the panel shows them, and its own angle."""

    moving: bool
    homed: bool
    at_lower_limit: bool
    at_upper_limit: bool
    at_origin: bool
    position_deg: float | None = None


@dataclass(frozen=True, slots=True)
class ShowProgress:
    """How far a show is: its own clock and how much of it has run."""

    show_id: str
    phase: ShowPhase
    sun_time: datetime
    elapsed_s: float
    duration_s: float
    acceleration: float
    start: datetime
    end: datetime
    sun_is_up: bool


@dataclass(frozen=True, slots=True)
class StepProgress:
    """The step of a program that is held, counted from one, and when the next comes, hours of the day."""

    name: str
    time_base: str
    frame: str
    hour: float
    step: int
    steps: int
    from_h: float
    next_h: float | None
    first_deg: float | None
    second_deg: float | None


@dataclass(frozen=True, slots=True)
class HybridState:
    """Computed axis angles, the correction by the light sensors, and their sum within the limits, degrees.

    The words say what the correction of each axis is doing; `light` is what the sensors read, if anything.
    """

    computed: Pair
    correction: Pair
    sum: Pair
    azimuth_phase: HybridPhase
    elevation_phase: HybridPhase
    light: LightReading | None


@dataclass(frozen=True, slots=True)
class SensorState:
    """What one protection goes by: the value and the limit it is judged against, and what it means now.

    `enabled` is the setting; `known` says that there is such a sensor, seen or required. Units are m/s, kg
    and W/m2.
    """

    quantity: Quantity
    enabled: bool
    known: bool
    value: float | None
    limit: float
    unit: str
    quality: Quality
    age_s: float | None
    text: Message


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One tracker at one tick. Whatever is not known is None, never an old value.

    `sun` is the sun that is followed: the accelerated one during a show. `target` is where the panel
    should point, `setpoint` what the drive was told, `measured` what the drive reports, in sky
    degrees; `position_age_s` is the age of the last good reading. `off_sun_deg` is the angle between
    the panel's normal and the sun (None while the sun is down), the correction of `hybrid` taken out.
    `waiting` says why a tracker that should move does not. `actions` maps every action to the reasons
    that forbid it (none: allowed); it is empty where nobody asked for it. `unreachable` says that the drive
    does not answer. `protection` is what wind, snow or light demand now (None: nothing),
    `stow` the place it is or goes to for that or by command, `not_stowed` why it does not stow although it
    should (priority 1), `local` that the switch at the cabinet is on local, `service` who serves the machine,
    `link` how the drive's replies come. `home` says who set the zero that is trusted, `home_lost` why and
    `home_lost_at` since when none is, `can_undo_home` that it was set and may be undone.
    `continues` says that tracking goes on with nobody asked: now, after a stow, or by a recovery policy.
    `approaching` says of one that tracks that it has not reached the sun yet, or not again after a break.
    `warning` counts down to a motion that nobody at the machine asked for.
    `state` is the tracker's state in a word or two; `messages` are what to know about it, the most urgent
    first.
    """

    tracker_id: str
    name: str
    at: datetime
    tick: int
    activity: ActivityName
    activity_text: Message
    mode: Mode
    orientation: Orientation
    tracking_on: bool
    sun: SunPosition | None
    sun_is_up: bool
    target: Pair | None
    setpoint: Pair | None
    measured: Pair | None
    last_measured: Pair | None
    position_age_s: float | None
    following_error_deg: float | None
    off_sun_deg: float | None
    in_position: bool
    homed: bool
    azimuth: AxisState | None
    elevation: AxisState | None
    fault: Reason | None
    waiting: tuple[Reason, ...] = ()
    notices: tuple[Reason, ...] = ()
    show: ShowProgress | None = None
    program: StepProgress | None = None
    hybrid: HybridState | None = None
    actions: dict[str, tuple[Reason, ...]] = field(default_factory=dict)
    protection: ProtectionState | None = None
    stow: StowName | None = None
    not_stowed: Reason | None = None
    warning: WarningState | None = None
    lock: MaintenanceLock | None = None
    control: ControlState = field(default_factory=lambda: ControlState(0))
    settings_lock: CommissioningLock | None = None
    sensors: tuple[SensorState, ...] = ()
    local: bool = False
    service: ServiceState | None = None
    link: LinkQuality | None = None
    home: HomeTrust | None = None
    home_lost: Message = NOTHING
    home_lost_at: datetime | None = None
    rejected: tuple[RejectedSetting, ...] = ()
    can_undo_home: bool = False
    unreachable: Reason | None = None
    approaching: bool = False
    continues: bool = False
    state: StateWord = StateWord.AT_STANDSTILL
    messages: tuple[OperatorMessage, ...] = ()


class EventKind(StrEnum):
    """What can happen; past tense, as it goes into the journal."""

    CONTROLLER_STARTED = "controller_started"
    CONTROLLER_STOPPED = "controller_stopped"
    CONTROLLER_RESTARTS = "controller_restarts"
    LOCATION_SET = "location_set"
    HORIZON_SET = "horizon_set"
    CLOCK_SET = "clock_set"
    CLOCK_JUMPED = "clock_jumped"
    TRACKER_ADDED = "tracker_added"
    TRACKER_CHANGED = "tracker_changed"
    TRACKER_REMOVED = "tracker_removed"
    STEP_CONFIRMED = "step_confirmed"
    JOG_STARTED = "jog_started"
    JOG_ENDED = "jog_ended"
    MOVE_STARTED = "move_started"
    MOVE_ENDED = "move_ended"
    HOME_POSITION_SET = "home_position_set"
    HOME_POSITION_NOT_SET = "home_position_not_set"
    HOME_POSITION_UNDONE = "home_position_undone"
    HOMING_STARTED = "homing_started"
    HOMING_ENDED = "homing_ended"
    HOME_LOST = "home_lost"
    MODE_SELECTED = "mode_selected"
    TRACKING_STARTED = "tracking_started"
    TRACKING_ENDED = "tracking_ended"
    TRACKING_RESUMED = "tracking_resumed"
    TRACKING_INTERRUPTED = "tracking_interrupted"
    SHOW_STARTED = "show_started"
    SHOW_PAUSED = "show_paused"
    SHOW_RESUMED = "show_resumed"
    SHOW_ENDED = "show_ended"
    STOPPED = "stopped"
    FAULT_RAISED = "fault_raised"
    FAULT_RESET = "fault_reset"
    DRIVE_LOST = "drive_lost"
    DRIVE_FOUND = "drive_found"
    LIMIT_REACHED = "limit_reached"
    SIGHTING_TAKEN = "sighting_taken"
    DRIVE_TEST_STARTED = "drive_test_started"
    DRIVE_TEST_ENDED = "drive_test_ended"
    DRIVE_CHECKED = "drive_checked"
    RECORDING_DELETED = "recording_deleted"
    REMOTE_WRITTEN = "remote_written"
    REMOTE_REFUSED = "remote_refused"
    CONFIG_REJECTED = "config_rejected"
    PROTECTION_BEGAN = "protection_began"
    PROTECTION_ENDED = "protection_ended"
    STOW_STARTED = "stow_started"
    STOW_ENDED = "stow_ended"
    NOT_STOWED = "not_stowed"
    SENSOR_INVALID = "sensor_invalid"
    SENSOR_VALID = "sensor_valid"
    MOTION_ANNOUNCED = "motion_announced"
    INHIBIT_SET = "inhibit_set"
    WEATHER_STATION_SET = "weather_station_set"
    INHIBIT_RELEASED = "inhibit_released"
    CONTROL_TAKEN = "control_taken"
    CONTROL_REQUESTED = "control_requested"
    CONTROL_DECLINED = "control_declined"
    CONTROL_RELEASED = "control_released"
    SETTINGS_LOCKED = "settings_locked"
    SETTINGS_UNLOCKED = "settings_unlocked"
    UNCOMMANDED_MOTION = "uncommanded_motion"
    RECORD_SIGNED = "record_signed"
    STOPPING_DISTANCE_EXCEEDED = "stopping_distance_exceeded"
    SWITCHED_TO_LOCAL = "switched_to_local"
    SWITCHED_TO_REMOTE = "switched_to_remote"
    SERVICE_MODE_STARTED = "service_mode_started"
    SERVICE_MODE_ENDED = "service_mode_ended"
    AREA_CONFIRMED_CLEAR = "area_confirmed_clear"
    AREA_CONFIRMATION_EXPIRED = "area_confirmation_expired"
    FAULT_RESET_AUTOMATICALLY = "fault_reset_automatically"
    FAULT_INJECTED = "fault_injected"
    INJECTED_FAULTS_ENDED = "injected_faults_ended"
    ALARM_RAISED = "alarm_raised"
    ALARM_RETURNED = "alarm_returned"
    ALARM_ACKNOWLEDGED = "alarm_acknowledged"
    ALARM_SHELVED = "alarm_shelved"
    ALARM_UNSHELVED = "alarm_unshelved"
    NOTIFICATIONS_SET = "notifications_set"
    NOTIFICATION_TESTED = "notification_tested"
    JOURNAL_PRUNED = "journal_pruned"


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened: when (site time), to which tracker (None: the site), by whom."""

    at: datetime
    kind: EventKind
    tracker_id: str | None
    message: Message
    actor: str = CONTROLLER
    data: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ClockState:
    """The controller's clock: where it comes from and whether automatic motion may rely on it.

    `off_s` is by how much it is known to be fast, None if nothing tells; `warnings` say so while it may still
    be relied on.
    """

    source: str
    offset_s: float
    trusted: bool
    ntp_synchronised: bool | None
    set_at: datetime | None
    reasons: tuple[Reason, ...] = ()
    warnings: tuple[Reason, ...] = ()
    off_s: float | None = None


@dataclass(frozen=True, slots=True)
class SiteSnapshot:
    """The whole site at one instant, full every time.

    `boot_id` changes when the machine restarts; `sequence` grows by one with every snapshot. `alarms` are at
    most 50, the most urgent first; `alarm_counts` tells of all. `messages` are what is most urgent at the
    site: one of each tracker that has an alarm of priority 1 to 3 or is on local, and the site's own alarms,
    at most 50.
    `sun_behind_horizon` says that the sun is up, but behind the horizon that was entered.
    """

    boot_id: str
    sequence: int
    at: datetime
    site_name: str
    location: Location | None
    time_zone: str
    clock: ClockState
    sun: SunPosition | None
    trackers: tuple[Snapshot, ...]
    weather: WeatherNow | None = None
    alarms: tuple[AlarmNow, ...] = ()
    alarm_counts: AlarmCounts = field(default_factory=AlarmCounts)
    sun_behind_horizon: bool = False
    messages: tuple[OperatorMessage, ...] = ()
