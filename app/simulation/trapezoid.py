"""Motion of one axis as a function of time: ramps of constant acceleration, continuous in speed."""

from dataclasses import dataclass
from math import copysign, sqrt


@dataclass(frozen=True, slots=True)
class Phase:
    """From `start_s` on: position and velocity at its start, constant acceleration (degrees, seconds)."""

    start_s: float
    position_deg: float
    velocity_dps: float
    acceleration_dps2: float = 0.0

    def at(self, time_s: float) -> tuple[float, float]:
        """Return position and velocity at a time inside this phase."""
        elapsed_s = time_s - self.start_s
        velocity_dps = self.velocity_dps + self.acceleration_dps2 * elapsed_s
        return self.position_deg + (self.velocity_dps + velocity_dps) / 2.0 * elapsed_s, velocity_dps


@dataclass(frozen=True, slots=True)
class Path:
    """Phases in the order of their starts; the last one is rest and never ends."""

    phases: tuple[Phase, ...]

    def at(self, time_s: float) -> tuple[float, float]:
        """Return position and velocity at a time; before the first phase, what that phase starts with."""
        for phase in reversed(self.phases):
            if time_s >= phase.start_s:
                return phase.at(time_s)
        return self.phases[0].position_deg, self.phases[0].velocity_dps

    @property
    def end_s(self) -> float:
        """Return when the axis comes to rest."""
        return self.phases[-1].start_s

    @property
    def end_deg(self) -> float:
        """Return where the axis comes to rest."""
        return self.phases[-1].position_deg


def rest(time_s: float, position_deg: float) -> Path:
    """Return the path of an axis that stands still."""
    return Path((Phase(time_s, position_deg, 0.0),))


def braking_end_deg(position_deg: float, velocity_dps: float, acceleration_dps2: float) -> float:
    """Return where an axis comes to rest that brakes from now on."""
    return position_deg + velocity_dps * abs(velocity_dps) / (2.0 * acceleration_dps2)


def brake(start: Phase, acceleration_dps2: float) -> Path:
    """Return the path that ramps down from the start's position and velocity."""
    if start.velocity_dps == 0.0:
        return rest(start.start_s, start.position_deg)
    end_deg = braking_end_deg(start.position_deg, start.velocity_dps, acceleration_dps2)
    slowing = -copysign(acceleration_dps2, start.velocity_dps)
    first = Phase(start.start_s, start.position_deg, start.velocity_dps, slowing)
    end_s = start.start_s + abs(start.velocity_dps) / acceleration_dps2
    return Path((first, Phase(end_s, end_deg, 0.0)))


def move(start: Phase, target_deg: float, speed_dps: float, acceleration_dps2: float) -> Path:
    """Return the fastest path to a target that keeps to a speed and an acceleration, and ends exactly there.

    The velocity at the start carries over: an axis that moves the other way, or too fast to stop in time,
    brakes first and comes back; one that is faster than `speed_dps` slows down to it.
    """
    braking_deg = braking_end_deg(start.position_deg, start.velocity_dps, acceleration_dps2)
    direction = copysign(1.0, target_deg - braking_deg)
    velocity_dps = direction * start.velocity_dps
    distance_deg = direction * (target_deg - start.position_deg)
    peak_dps = sqrt(max(0.0, acceleration_dps2 * distance_deg + velocity_dps**2 / 2.0))
    cruise_dps = min(peak_dps, speed_dps)
    ramp_dps2 = copysign(acceleration_dps2, cruise_dps - velocity_dps)
    to_cruise_deg = (cruise_dps**2 - velocity_dps**2) / (2.0 * ramp_dps2)
    stopping_deg = cruise_dps**2 / (2.0 * acceleration_dps2)
    cruising_deg = max(0.0, distance_deg - to_cruise_deg - stopping_deg)
    ramps = (
        (abs(cruise_dps - velocity_dps) / acceleration_dps2, ramp_dps2),
        (cruising_deg / cruise_dps if cruise_dps else 0.0, 0.0),
        (cruise_dps / acceleration_dps2, -acceleration_dps2),
    )
    return _chain(start, direction, ramps, target_deg)


def _chain(start: Phase, direction: float, ramps: tuple[tuple[float, float], ...], target_deg: float) -> Path:
    phases: list[Phase] = []
    time_s, position_deg, velocity_dps = start.start_s, start.position_deg, start.velocity_dps
    for duration_s, acceleration_dps2 in ramps:
        if duration_s <= 0.0:
            continue
        phase = Phase(time_s, position_deg, velocity_dps, direction * acceleration_dps2)
        phases.append(phase)
        time_s += duration_s
        position_deg, velocity_dps = phase.at(time_s)
    phases.append(Phase(time_s, target_deg, 0.0))
    return Path(tuple(phases))
