"""What an axis does that it should not, seen over several readings. Pure steps: (state, reading) -> state.

Angles are degrees of the axis, speeds degrees a second, signed as the axis angle grows.
"""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from app.tracker.memory.drive_tests import StopProof
from app.tracker.settings.axes import AxisConfig
from app.tracker.values.motion import AxisCommand, AxisFeedback, Halt, Velocity

SETTLES_WITHIN = timedelta(seconds=10)
"""An axis that still reports motion so long after a halt counts as one that should stand."""
STILL_DPS = 0.05
FROZEN_AFTER_DEG = 1.0
FROZEN_SHARE = 0.1
FROZEN_FOR = timedelta(seconds=0.5)
REACTION_S = 0.5
"""From the halt being written to the axis slowing down, where no stop was measured."""
OVERRUN_PLAY_DEG = 0.3
CROSSED_DEG = 0.3


@dataclass(frozen=True, slots=True)
class Rest:
    """An axis that is told to stand: since when, and where it came to rest (`settled`)."""

    since: datetime
    position_deg: float
    settled: bool

    def crept_deg(self, seen: AxisFeedback) -> float:
        """Return by how much the axis has turned, signed; 0 until it has come to rest."""
        return seen.position_deg - self.position_deg if self.settled else 0.0


def rest(before: Rest | None, command: AxisCommand, seen: AxisFeedback, now: datetime) -> Rest | None:
    """Return the rest of an axis under a command, None while it is told to move."""
    if not stands(command):
        return None
    if before is None:
        return Rest(now, seen.position_deg, settled=False)
    if before.settled or (seen.moving and now - before.since < SETTLES_WITHIN):
        return before
    return replace(before, position_deg=seen.position_deg, settled=True)


def stands(command: AxisCommand) -> bool:
    """Return whether a command is one to stand still."""
    return isinstance(command, Halt) or command == Velocity(0.0)


@dataclass(frozen=True, slots=True)
class Braking:
    """An axis that comes to rest: where it was and how fast when it was told to."""

    position_deg: float
    velocity_dps: float


def braking(
    before: Braking | None, told: AxisCommand, was_told: AxisCommand, seen: AxisFeedback
) -> Braking | None:
    """Return a stop that begins or goes on, None where there is none; `seen` is from before the command."""
    if not stands(told):
        return None
    if stands(was_told):
        return before
    return Braking(seen.position_deg, seen.velocity_dps) if abs(seen.velocity_dps) > STILL_DPS else None


def overrun_deg(stop: Braking, seen: AxisFeedback) -> float:
    """Return how far the axis has run on since it was told to stand, 0 or above."""
    return abs(seen.position_deg - stop.position_deg)


def allowed_overrun_deg(stop: Braking, config: AxisConfig, proof: StopProof | None, factor: float) -> float:
    """Return how far a stop may run: the way that was measured, else computed, times a factor, and play.

    The way of a measured stop is scaled by the square of the speed, but never below a straight line.
    """
    speed_dps = abs(stop.velocity_dps)
    computed_deg = speed_dps**2 / (2.0 * config.acceleration_dps2) + speed_dps * REACTION_S
    if proof is None or proof.settings != config or proof.speed_dps <= 0.0:
        return computed_deg * factor + OVERRUN_PLAY_DEG
    share = speed_dps / proof.speed_dps
    learned_deg = proof.overrun_deg * max(share, share**2) + speed_dps * proof.resolution_s
    return learned_deg * factor + OVERRUN_PLAY_DEG


@dataclass(frozen=True, slots=True)
class Pressed:
    """A limit switch that is on: the farthest place towards it that the axis has had since."""

    upper: bool
    deepest_deg: float

    def left_deg(self, seen: AxisFeedback) -> float:
        """Return how far the axis has gone away from the switch, 0 or above."""
        away_deg = self.deepest_deg - seen.position_deg
        return max(0.0, away_deg if self.upper else -away_deg)


def pressed(before: Pressed | None, seen: AxisFeedback) -> Pressed | None:
    """Return the switch that is on, None if none is (or both, which is another fault)."""
    if seen.at_lower_limit == seen.at_upper_limit:
        return None
    if before is None or before.upper is not seen.at_upper_limit:
        return Pressed(seen.at_upper_limit, seen.position_deg)
    farther = max if before.upper else min
    return replace(before, deepest_deg=farther(before.deepest_deg, seen.position_deg))


@dataclass(frozen=True, slots=True)
class Turning:
    """An axis that says it turns: where the counter stood, since when, and how far it must have turned."""

    since: datetime
    seen_at: datetime
    position_deg: float
    turned_deg: float

    def is_frozen(self) -> bool:
        """Return whether the position stands although the axis says that it has turned by a degree."""
        return self.turned_deg > FROZEN_AFTER_DEG and self.seen_at - self.since >= FROZEN_FOR


def turning(before: Turning | None, seen: AxisFeedback, now: datetime) -> Turning | None:
    """Return the turning of an axis by its own word, begun anew whenever its position follows."""
    if abs(seen.velocity_dps) <= STILL_DPS:
        return None
    if before is None:
        return Turning(now, now, seen.position_deg, 0.0)
    turned_deg = before.turned_deg + abs(seen.velocity_dps) * (now - before.seen_at).total_seconds()
    moved_deg = abs(seen.position_deg - before.position_deg)
    if moved_deg > STILL_DPS + FROZEN_SHARE * turned_deg:
        return Turning(now, now, seen.position_deg, 0.0)
    return replace(before, seen_at=now, turned_deg=turned_deg)


@dataclass(frozen=True, slots=True)
class Beyond:
    """An axis outside its soft limits: the nearest that it has been to them since."""

    least_deg: float


def beyond(before: Beyond | None, config: AxisConfig, seen: AxisFeedback) -> Beyond | None:
    """Return how an axis stands outside its soft limits, None within them."""
    now_deg = config.beyond_deg(seen.position_deg)
    if now_deg <= 0.0:
        return None
    return Beyond(now_deg if before is None else min(before.least_deg, now_deg))


@dataclass(frozen=True, slots=True)
class AxisGuard:
    """Everything that is watched of one axis between two readings."""

    rest: Rest | None = None
    braking: Braking | None = None
    pressed: Pressed | None = None
    turning: Turning | None = None
    beyond: Beyond | None = None
    crept_at: datetime | None = None
    overruns: tuple[float, ...] = ()
    slow_stops_left: int = 0


UNWATCHED = AxisGuard()
