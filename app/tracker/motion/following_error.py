"""Does an axis do what it is told? A reference axis beside each real one tells.

The reference obeys the same command with the rated acceleration. The real axis may lag behind it by
the configured following error, by what it travels in the link's delay, and by a tenth of the way
(form of LinuxCNC: a minimum plus a part that grows with speed), for half a second.
"""

from dataclasses import dataclass
from datetime import datetime, timedelta
from math import copysign, sqrt
from typing import assert_never

from app.tracker.settings.axes import AxisConfig
from app.tracker.values.motion import AxisCommand, AxisFeedback, Halt, Position, Velocity

PATIENCE = timedelta(seconds=0.5)
DELAY_S = 0.3
WAY_SHARE = 0.1
NEW_ANCHOR_DEG = 20.0
WRONG_WAY_DEG = 0.3
THERE_DEG = 0.05
"""An axis so near to its position goes no particular way: what is left is the rounding of its encoder."""
LONGEST_STEP_S = 0.1
MOST_STEPS = 20


@dataclass(frozen=True, slots=True)
class AxisWatch:
    """The reference axis: where it is, its signed speed, its way since it was last set to the real one.

    `behind_since` is when the real axis was first too far away. `direction` is where the command leads from
    where the real axis is; `turned_at` and `turned_deg` tell since when and from where on.
    """

    position_deg: float
    speed_dps: float
    way_deg: float
    at: datetime
    behind_since: datetime | None
    direction: float
    turned_at: datetime
    turned_deg: float
    error_deg: float = 0.0

    def follows(self, now: datetime) -> bool:
        """Return whether the axis has not been too far away for too long."""
        return self.behind_since is None or now - self.behind_since < PATIENCE

    def turns_wrongly(self, measured_deg: float, now: datetime) -> bool:
        """Return whether the axis moves against its command, by more than play and for long enough."""
        way_deg = self.direction * (measured_deg - self.turned_deg)
        return way_deg < -WRONG_WAY_DEG and now - self.turned_at >= PATIENCE


def watch(
    before: AxisWatch | None,
    config: AxisConfig,
    command: AxisCommand,
    seen: AxisFeedback,
    now: datetime,
    allowed_deg: float,
) -> AxisWatch | None:
    """Return the reference axis at `now` under the command given until now; None while halted."""
    if isinstance(command, Halt):
        return None
    if before is None:
        begun_deg = seen.position_deg
        return AxisWatch(begun_deg, seen.velocity_dps, 0.0, now, None, 0.0, now, begun_deg)
    elapsed_s = min((now - before.at).total_seconds(), LONGEST_STEP_S * MOST_STEPS)
    position_deg, speed_dps = _advance(before, config, command, elapsed_s)
    way_deg = before.way_deg + abs(position_deg - before.position_deg)
    error_deg = position_deg - seen.position_deg
    lag_s = DELAY_S + elapsed_s
    behind = abs(error_deg) > allowed_deg + abs(speed_dps) * lag_s + way_deg * WAY_SHARE
    direction = _direction(command, seen.position_deg)
    same_way = direction == before.direction and speed_dps * direction >= 0.0
    turned_at, turned_deg = (before.turned_at, before.turned_deg) if same_way else (now, seen.position_deg)
    if not behind and way_deg > NEW_ANCHOR_DEG:
        position_deg, way_deg = seen.position_deg, 0.0
    since = (before.behind_since or now) if behind else None
    return AxisWatch(
        position_deg, speed_dps, way_deg, now, since, direction, turned_at, turned_deg, error_deg
    )


def _advance(
    before: AxisWatch, config: AxisConfig, command: Velocity | Position, elapsed_s: float
) -> tuple[float, float]:
    """Return position and speed of the reference after a time, in steps of at most 0.1 s."""
    position_deg, speed_dps = before.position_deg, before.speed_dps
    steps = max(1, round(elapsed_s / LONGEST_STEP_S))
    step_s = elapsed_s / steps
    for _ in range(steps):
        wanted_dps = _wanted_dps(config, command, position_deg, step_s)
        change_dps = config.acceleration_dps2 * step_s
        speed_dps = min(speed_dps + change_dps, max(speed_dps - change_dps, wanted_dps))
        position_deg += speed_dps * step_s
    return position_deg, speed_dps


def _wanted_dps(
    config: AxisConfig, command: Velocity | Position, position_deg: float, step_s: float
) -> float:
    match command:
        case Position():
            away_deg = command.position_deg - position_deg
            braking_dps = sqrt(2.0 * config.acceleration_dps2 * abs(away_deg))
            fastest_dps = min(command.speed_dps, braking_dps, abs(away_deg) / max(step_s, 1e-3))
            return copysign(fastest_dps, away_deg)
        case Velocity():
            return command.velocity_dps
    assert_never(command)


def _direction(command: Velocity | Position, measured_deg: float) -> float:
    match command:
        case Position():
            away_deg = command.position_deg - measured_deg
            return copysign(1.0, away_deg) if abs(away_deg) > THERE_DEG else 0.0
        case Velocity():
            return copysign(1.0, command.velocity_dps)
    assert_never(command)
