"""What was proven about a drive at the machine itself: by whom, when, with which result and settings.

A proof keeps the settings that it was made under. Whether it still holds is judged by comparing those
with the present ones, so that undoing a change makes an old proof true again.
"""

from dataclasses import dataclass, replace
from datetime import datetime
from enum import StrEnum
from typing import TypeVar

from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import DriveConfig

MEASURABLE_DEG = 0.2
"""A measured angle may differ from the commanded one by this much: about what an inclinometer tells."""


class ProofKind(StrEnum):
    """What can be proven about a drive."""

    DIRECTION = "direction"
    SCALE = "scale"
    LIMITS = "limits"
    STOP = "stop"
    LINK_LOSS = "link_loss"


class AxisEnd(StrEnum):
    """The two ends of an axis."""

    LOWER = "lower"
    UPPER = "upper"


class StopSpeed(StrEnum):
    """The speeds from which stopping is measured: the fast one by hand, and the rated one."""

    JOG = "jog"
    RATED = "rated"


class LinkLossOutcome(StrEnum):
    """What a drive did when no command reached it any more."""

    STOPPED = "stopped"
    WENT_ON = "went_on"


@dataclass(frozen=True, slots=True)
class ProofMove:
    """A bounded move that somebody has to judge, axis degrees; `to_deg` is None while it is under way."""

    kind: ProofKind
    axis: Axis
    from_deg: float
    at: datetime
    by: str
    to_deg: float | None = None

    @property
    def moved_deg(self) -> float:
        """Return by how much the controller says the axis has turned, signed; 0 while it is under way."""
        return 0.0 if self.to_deg is None else self.to_deg - self.from_deg


@dataclass(frozen=True, slots=True)
class DirectionProof:
    """Somebody saw the panel turn the way that the controller says, by `moved_deg`."""

    axis: Axis
    moved_deg: float
    at: datetime
    by: str
    drive: DriveConfig


@dataclass(frozen=True, slots=True)
class ScaleProof:
    """Somebody measured `measured_deg` where the controller says `moved_deg`, both without sign."""

    axis: Axis
    moved_deg: float
    measured_deg: float
    at: datetime
    by: str
    drive: DriveConfig

    @property
    def error_share(self) -> float:
        """Return how much more the panel turned than the controller says, as a share."""
        return self.measured_deg / self.moved_deg - 1.0

    @property
    def within_tolerance(self) -> bool:
        """Return whether measured and commanded angle agree as well as they can be measured."""
        return abs(self.measured_deg - self.moved_deg) <= MEASURABLE_DEG


@dataclass(frozen=True, slots=True)
class LimitProof:
    """Somebody drove the axis to this end and called it the soft limit."""

    axis: Axis
    end: AxisEnd
    limit_deg: float
    at: datetime
    by: str


@dataclass(frozen=True, slots=True)
class StopProof:
    """From the stop being asked to standstill: time and way at a measured speed, to `resolution_s`."""

    axis: Axis
    speed: StopSpeed
    speed_dps: float
    stopped_after_s: float
    overrun_deg: float
    resolution_s: float
    at: datetime
    by: str
    drive: DriveConfig
    settings: AxisConfig


@dataclass(frozen=True, slots=True)
class LinkLossProof:
    """What the drive did by itself when no command reached it, counted from the last one.

    `reacted_after_s` is when it began to slow down, `stopped_after_s` when it stood; None: it never did.
    `expected_s` is its watchdog's time-out, `reported` whether it said that its watchdog has tripped.
    """

    axis: Axis
    outcome: LinkLossOutcome
    speed_dps: float
    expected_s: float | None
    reacted_after_s: float | None
    stopped_after_s: float | None
    overrun_deg: float
    resolution_s: float
    reported: bool
    fault_code: int
    home_kept: bool
    at: datetime
    by: str
    drive: DriveConfig


AxisProof = DirectionProof | ScaleProof | LimitProof | StopProof
P = TypeVar("P", bound=AxisProof)


@dataclass(frozen=True, slots=True)
class Proofs:
    """Every proof of one tracker, the newest of each sort, and a move that waits to be judged."""

    directions: tuple[DirectionProof, ...] = ()
    scales: tuple[ScaleProof, ...] = ()
    limits: tuple[LimitProof, ...] = ()
    stops: tuple[StopProof, ...] = ()
    link_loss: LinkLossProof | None = None
    move: ProofMove | None = None

    def direction(self, axis: Axis) -> DirectionProof | None:
        """Return the direction proof of an axis."""
        return _found(self.directions, axis)

    def scale(self, axis: Axis) -> ScaleProof | None:
        """Return the scale proof of an axis."""
        return _found(self.scales, axis)

    def limit(self, axis: Axis, end: AxisEnd) -> LimitProof | None:
        """Return how one end of an axis was set."""
        return _found(self.limits, axis, end)

    def stop(self, axis: Axis, speed: StopSpeed) -> StopProof | None:
        """Return the stop test of an axis at a speed."""
        return _found(self.stops, axis, speed)

    def keep(self, proof: AxisProof | LinkLossProof) -> "Proofs":
        """Return these proofs with a newer one in the place of the old."""
        match proof:
            case DirectionProof():
                return replace(self, directions=_with(self.directions, proof))
            case ScaleProof():
                return replace(self, scales=_with(self.scales, proof))
            case LimitProof():
                return replace(self, limits=_with(self.limits, proof))
            case StopProof():
                return replace(self, stops=_with(self.stops, proof))
            case LinkLossProof():
                return replace(self, link_loss=proof)


def _detail(proof: AxisProof) -> StrEnum | None:
    """Return what tells two proofs of the same sort and axis apart."""
    match proof:
        case LimitProof():
            return proof.end
        case StopProof():
            return proof.speed
        case _:
            return None


def _found(proofs: tuple[P, ...], axis: Axis, detail: StrEnum | None = None) -> P | None:
    return next((one for one in proofs if one.axis is axis and _detail(one) is detail), None)


def _with(proofs: tuple[P, ...], new: P) -> tuple[P, ...]:
    return (*(one for one in proofs if not _same(one, new)), new)


def _same(one: AxisProof, other: AxisProof) -> bool:
    return (one.axis, _detail(one)) == (other.axis, _detail(other))
