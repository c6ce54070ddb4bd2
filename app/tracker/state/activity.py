"""What a tracker is doing: a sum type, each member with its own data and nothing else."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum
from typing import Literal

from app.tracker.memory.drive_tests import StopSpeed
from app.tracker.programs.show import Course
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import ActivityName, ShowPhase
from app.tracker.values.motion import DriveCommand
from app.tracker.values.reason import Reason


class MoveKind(StrEnum):
    """Who asked for a move."""

    MOVE = "move"
    PARK = "park"
    STEP = "step"
    DIRECTION = "direction"
    SCALE = "scale"


class TrackPhase(StrEnum):
    """What tracking is doing at the moment."""

    FOLLOWING = "following"
    LIMITED = "limited"
    KEYHOLE = "keyhole"
    FIXED = "fixed"
    NIGHT = "night"
    PAUSED = "paused"
    RESTING = "resting"


@dataclass(frozen=True, slots=True)
class AxisPair:
    """Azimuth and elevation in degrees of the axes (not wrapped); None: this axis is not meant."""

    azimuth_deg: float | None
    elevation_deg: float | None


@dataclass(frozen=True, slots=True)
class Run:
    """One motion of both axes to a fixed place; it must have arrived by `until`."""

    target: AxisPair
    command: DriveCommand
    until: datetime


@dataclass(frozen=True, slots=True)
class Holding:
    """At rest, or coming to rest; the axes are halted."""


@dataclass(frozen=True, slots=True)
class Jogging:
    """One axis turns by hand until the lease ends; `sequence` is that of the last renewal."""

    press_id: str
    axis: Axis
    direction: Literal[-1, 1]
    speed: JogSpeed
    sequence: int
    until: datetime


@dataclass(frozen=True, slots=True)
class Moving:
    """Going to a place, to stay there."""

    kind: MoveKind
    run: Run
    actor: str


@dataclass(frozen=True, slots=True)
class SettingHome:
    """The drive is told, axis by axis, that here is zero; `number` is the request under way."""

    axes: tuple[Axis, ...]
    pending: tuple[Axis, ...]
    number: int
    until: datetime
    actor: str


@dataclass(frozen=True, slots=True)
class Homing:
    """The drive searches its origin switches by itself."""

    number: int
    until: datetime
    actor: str


@dataclass(frozen=True, slots=True)
class Tracking:
    """Following the selected mode; `run` is a motion under way, None while within the deadband.

    `rested` says that the panel has not moved since the night or a rest: its first motion is announced.
    """

    phase: TrackPhase = TrackPhase.FOLLOWING
    run: Run | None = None
    rested: bool = False


@dataclass(frozen=True, slots=True)
class Showing:
    """A show; `elapsed` of its own time has run when it was last looked at, at `at`."""

    course: Course
    phase: ShowPhase
    run: Run | None
    elapsed: timedelta
    at: datetime
    actor: str


@dataclass(frozen=True, slots=True)
class Asked:
    """What an axis did at the instant from which its coming to rest is measured, and since.

    `reacted_at` is when it was first seen to slow down, `looked_at` when it was last seen to move.
    """

    at: datetime
    position_deg: float
    velocity_dps: float
    looked_at: datetime
    reacted_at: datetime | None = None


@dataclass(frozen=True, slots=True)
class Measuring:
    """An axis turns in order to come to rest: stopped at a `speed`, or left without commands (None).

    The command is one to a place not far ahead, so that the way is bounded whatever happens. `steady_at` is
    when the axis has its speed; `asked` is what it did when the measurement began.
    """

    axis: Axis
    speed: StopSpeed | None
    speed_dps: float
    from_deg: float
    command: DriveCommand
    steady_at: datetime
    until: datetime
    actor: str
    asked: Asked | None = None


@dataclass(frozen=True, slots=True)
class Stowing:
    """Going to a stow position; `run` is None until the motion was announced."""

    stow: StowName
    run: Run | None = None


@dataclass(frozen=True, slots=True)
class Stowed:
    """At rest in a stow position, until what demanded it ends."""

    stow: StowName


@dataclass(frozen=True, slots=True)
class Stopping:
    """Coming to rest after a stop."""


@dataclass(frozen=True, slots=True)
class Faulted:
    """A latched fault; `number` is a reset request under way, to be answered by `until`."""

    reason: Reason
    number: int | None = None
    until: datetime | None = None


Unfaulted = (
    Holding
    | Jogging
    | Moving
    | SettingHome
    | Homing
    | Tracking
    | Showing
    | Measuring
    | Stopping
    | Stowing
    | Stowed
)
Activity = Unfaulted | Faulted

NAMES: dict[type[Activity], ActivityName] = {
    Holding: ActivityName.HOLDING,
    Jogging: ActivityName.JOGGING,
    Moving: ActivityName.MOVING,
    SettingHome: ActivityName.SETTING_HOME,
    Homing: ActivityName.HOMING,
    Tracking: ActivityName.TRACKING,
    Showing: ActivityName.SHOWING,
    Measuring: ActivityName.MEASURING,
    Stopping: ActivityName.STOPPING,
    Faulted: ActivityName.FAULTED,
    Stowing: ActivityName.STOWING,
    Stowed: ActivityName.STOWED,
}

HOLDING = Holding()
STOPPING = Stopping()
