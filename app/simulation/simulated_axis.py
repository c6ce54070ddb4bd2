"""One simulated axis: motor, gear, encoder and switches; its position is a function of time."""

from dataclasses import dataclass

from app.simulation.faults import Fault, FaultKind
from app.simulation.position_memory import AxisMemory
from app.simulation.trapezoid import Path, Phase, brake, braking_end_deg, move, rest
from app.tracker.settings.axes import AxisConfig
from app.tracker.values.motion import HALT, AxisCommand, AxisFeedback, Halt, Position, Velocity

COUNTS_PER_REVOLUTION = 3600
WORN_GRIP = 0.1


@dataclass(frozen=True, slots=True)
class Mechanics:
    """How an axis is built. Angles in degrees of the axis.

    The limit switches sit `switch_margin_deg` outside soft limits and origin, and the axis comes to rest
    `overrun_deg` behind them. The origin switch is on within `origin_deg` of the true zero.
    """

    gear: float = 10.0
    backlash_deg: float = 0.02
    switch_margin_deg: float = 5.0
    overrun_deg: float = 0.2
    origin_deg: float = 0.5

    @property
    def resolution_deg(self) -> float:
        """Return the angle of one encoder count."""
        return 360.0 / (COUNTS_PER_REVOLUTION * self.gear)


STANDARD = Mechanics()


class SimulatedAxis:
    """Motor, panel and encoder of one axis. True angles are those of the machine, readings add an offset."""

    def __init__(self, config: AxisConfig, mechanics: Mechanics, memory: AxisMemory) -> None:
        self._config = config
        self._mechanics = mechanics
        self._lower_switch_deg = min(config.minimum_deg, 0.0) - mechanics.switch_margin_deg
        self._upper_switch_deg = max(config.maximum_deg, 0.0) + mechanics.switch_margin_deg
        self._path: Path = rest(0.0, memory.true_deg)
        self._panel_deg = memory.true_deg
        self._offset_deg = memory.offset_deg
        self._homed = memory.homed
        self._command: AxisCommand = HALT
        self._faults: dict[FaultKind, Fault] = {}
        self._frozen_deg = 0.0

    @property
    def homed(self) -> bool:
        """Return whether the zero was set and nothing has happened to it since."""
        return self._homed

    @property
    def end_s(self) -> float:
        """Return when the axis comes to rest, if nothing else is commanded."""
        return self._path.end_s

    def resting(self, time_s: float) -> bool:
        """Return whether the axis stands still and will stay where it is."""
        return time_s >= self._path.end_s and FaultKind.SLIP not in self._faults

    def memory(self, time_s: float) -> AxisMemory:
        """Return what survives a power cut."""
        return AxisMemory(self._path.at(time_s)[0], self._offset_deg, self._homed)

    def left_alone(self, from_s: float) -> AxisMemory:
        """Return what survives once the axis has come to rest that is braked from a time on."""
        position_deg, velocity_dps = self._path.at(from_s)
        end_deg = braking_end_deg(position_deg, velocity_dps, self._config.acceleration_dps2 * self._grip())
        return AxisMemory(end_deg, self._offset_deg, self._homed)

    def true_deg(self, time_s: float) -> float:
        """Return where the panel really points; it lags behind the motor by the backlash."""
        play_deg = self._mechanics.backlash_deg / 2.0
        motor_deg = self._path.at(time_s)[0]
        self._panel_deg = min(motor_deg + play_deg, max(motor_deg - play_deg, self._panel_deg))
        return self._panel_deg

    def feedback(self, time_s: float) -> AxisFeedback:
        """Return what encoder and switches say."""
        self._slip(time_s)
        self.true_deg(time_s)
        motor_deg, velocity_dps = self._path.at(time_s)
        lower, upper = self._switches(motor_deg)
        return AxisFeedback(
            position_deg=self._reading(motor_deg),
            velocity_dps=velocity_dps,
            moving=time_s < self._path.end_s or self._is_blocked(),
            homed=self._homed,
            at_lower_limit=lower,
            at_upper_limit=upper,
            at_origin=abs(motor_deg) <= self._mechanics.origin_deg
            and FaultKind.LIMIT_DEAD not in self._faults,
        )

    def obey(self, command: AxisCommand, time_s: float) -> None:
        """Do this from now on; what the axis is doing carries over without a jump in speed."""
        self._command = command
        self._slip(time_s)
        self.true_deg(time_s)
        start = self._start(time_s)
        acceleration_dps2 = self._config.acceleration_dps2
        if self._is_blocked():
            self._path = rest(time_s, start.position_deg)
            return
        goal = self._goal(command, start.position_deg)
        if goal is None:
            self._path = brake(start, acceleration_dps2 * self._grip())
            return
        target_deg, speed_dps = goal
        self._path = move(start, self._within_ends(target_deg, start), speed_dps, acceleration_dps2)

    def seek_origin(self, time_s: float) -> None:
        """Turn to the origin switch at half the rated speed, whatever the encoder says.

        Without a switch the search ends at the end of the travel.
        """
        start = self._start(time_s)
        speed_dps = self._config.speed_dps / 2.0
        if not self._is_blocked():
            dead = FaultKind.LIMIT_DEAD in self._faults
            goal_deg = self._within_ends(float("-inf"), start) if dead else 0.0
            self._path = move(start, goal_deg, speed_dps, self._config.acceleration_dps2)

    def set_home(self, time_s: float) -> None:
        """Call the present reading zero."""
        self._offset_deg = -self._path.at(time_s)[0]
        self._homed = True

    def lose_power(self, time_s: float, offset_deg: float) -> None:
        """Stand still at once and forget the zero."""
        self._path = rest(time_s, self._path.at(time_s)[0])
        self._command = HALT
        self._offset_deg = offset_deg
        self._homed = False

    def inject(self, fault: Fault, time_s: float) -> None:
        """Suffer a fault from now on."""
        if fault.kind is FaultKind.ENCODER_JUMP:
            self._offset_deg += fault.amount
            return
        self._frozen_deg = self._reading(self._path.at(time_s)[0])
        self._faults[fault.kind] = fault
        self.obey(self._command, time_s)

    def end_injected_faults(self, time_s: float) -> None:
        """Be sound again and do what was commanded."""
        self._slip(time_s)
        self._faults.clear()
        self.obey(self._command, time_s)

    def _grip(self) -> float:
        """Return the share of its deceleration that the axis stops with."""
        fault = self._faults.get(FaultKind.LONG_STOP)
        return 1.0 if fault is None else min(1.0, fault.amount or WORN_GRIP)

    def _start(self, time_s: float) -> Phase:
        return Phase(time_s, *self._path.at(time_s))

    def _reading(self, motor_deg: float) -> float:
        if FaultKind.FROZEN_POSITION in self._faults:
            return self._frozen_deg
        resolution_deg = self._mechanics.resolution_deg
        return round((motor_deg + self._offset_deg) / resolution_deg) * resolution_deg

    def _switches(self, motor_deg: float) -> tuple[bool, bool]:
        if FaultKind.LIMIT_DEAD in self._faults:
            return False, False
        return (
            motor_deg <= self._lower_switch_deg or FaultKind.LOWER_LIMIT_STUCK in self._faults,
            motor_deg >= self._upper_switch_deg or FaultKind.UPPER_LIMIT_STUCK in self._faults,
        )

    def _is_blocked(self) -> bool:
        return FaultKind.STALL in self._faults and not isinstance(self._command, Halt)

    def _goal(self, command: AxisCommand, motor_deg: float) -> tuple[float, float] | None:
        """Return true target and speed, None to come to rest."""
        reverse = FaultKind.WRONG_DIRECTION in self._faults
        match command:
            case Velocity(velocity_dps) if velocity_dps:
                forward = (velocity_dps > 0.0) is not reverse
                return (float("inf") if forward else float("-inf")), self._rated(abs(velocity_dps))
            case Position(position_deg, speed_dps) if speed_dps > 0.0:
                way_deg = position_deg - self._offset_deg - motor_deg
                return motor_deg + (-way_deg if reverse else way_deg), self._rated(speed_dps)
            case _:
                return None

    def _rated(self, speed_dps: float) -> float:
        return min(speed_dps, self._config.speed_dps)

    def _within_ends(self, target_deg: float, start: Phase) -> float:
        """Return the target within the ends of travel; a switch that is on bars the way towards it."""
        lowest = self._lower_switch_deg - self._mechanics.overrun_deg
        highest = self._upper_switch_deg + self._mechanics.overrun_deg
        braking_deg = braking_end_deg(start.position_deg, start.velocity_dps, self._config.acceleration_dps2)
        if FaultKind.LOWER_LIMIT_STUCK in self._faults:
            lowest = max(lowest, braking_deg)
        if FaultKind.UPPER_LIMIT_STUCK in self._faults:
            highest = min(highest, braking_deg)
        return min(highest, max(lowest, target_deg))

    def _slip(self, time_s: float) -> None:
        fault = self._faults.get(FaultKind.SLIP)
        if fault is None or time_s <= self._path.end_s:
            return
        slipped_deg = self._path.end_deg + fault.amount * (time_s - self._path.end_s)
        here = Phase(time_s, self._path.end_deg, 0.0)
        self._path = rest(time_s, self._within_ends(slipped_deg, here))
