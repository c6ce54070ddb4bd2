"""One axis of a tracker on a drive of its own, whatever the drive speaks."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import assert_never

from app.base.clock import Clock
from app.base.message import say
from app.drives.dialects.dialect import AxisStatus, Dialect
from app.drives.dialects.extremes import check_encoded, extremes
from app.drives.dialects.gearing import Gearing
from app.drives.unit import Unit
from app.modbus.errors import DriveError
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.values.motion import AxisCommand, AxisFeedback, Halt, Position, RequestKind, Velocity

DISABLED = 0xFFFF
"""The fault code of this program for a motor that somebody else has switched off."""
UNNAMED = 0xFFFE
"""The fault code of this program for a fault to which the drive gives no code."""
LEASE_S = 0.24
"""The longest a step of hand motion turns, where the drive has no watchdog that would end it."""
PATIENCE = timedelta(seconds=1)
HOME_WITHIN_DEG = 0.5
ZERO_WITHIN_DEG = 0.05


@dataclass(frozen=True, slots=True)
class AxisReading:
    """What one axis reports; `task` is the request that was begun, `outcome` whether it succeeded."""

    feedback: AxisFeedback
    fault_code: int
    homing: bool
    outcome: bool | None


@dataclass(frozen=True, slots=True)
class _Task:
    kind: RequestKind
    begun_at: datetime
    seen_moving: bool = False


class RegisterAxis:
    """Reads and commands one axis through a dialect; a motion is written only when it changes.

    A motor that was switched off by somebody else (emergency stop, enable input) is a fault until it is
    reset, so that nothing moves by itself when it is switched on again. One that lost its zero as well has
    restarted: it reports no zero.
    """

    def __init__(
        self, dialect: Dialect, unit: Unit, gearing: Gearing, config: AxisConfig, clock: Clock
    ) -> None:
        self.unit = unit
        self._dialect = dialect
        self._gearing = gearing
        self._config = config
        self._clock = clock
        self._has_watchdog = unit.profile.watchdog is not None
        self._last: AxisFeedback | None = None
        self._doing: AxisCommand | None = None
        self._was_enabled = False
        self._may_turn = False
        self._is_disabled = False
        self._is_faulty = False
        self._task: _Task | None = None
        self._outcome: bool | None = None

    def check_fit(self, axis: Axis) -> None:
        """Raise `ValueMisfit` if the settings command a number that does not fit into its register."""
        for command in extremes(self._config):
            for values in self._encoded(command):
                check_encoded(axis, self.unit.profile.registers, values)

    async def read(self) -> AxisReading:
        """Return one fresh reading, or raise `DriveError`."""
        await self._confirm()
        values = await self.unit.look("position", "velocity", "inputs", *self._dialect.polled)
        status = self._dialect.status(values)
        position_deg = self._gearing.degrees(values["position"])
        velocity_dps = self._velocity_dps(values)
        self._notice(status)
        fault_code = await self._fault_code(status)
        self._is_faulty = fault_code != 0
        self._watch_task(status, position_deg)
        turned = self._gearing.direction < 0
        self._last = AxisFeedback(
            position_deg=position_deg,
            velocity_dps=velocity_dps,
            moving=status.moving,
            homed=status.homed,
            at_lower_limit=status.at_upper_limit if turned else status.at_lower_limit,
            at_upper_limit=status.at_lower_limit if turned else status.at_upper_limit,
            at_origin=status.at_origin,
        )
        return AxisReading(self._last, fault_code, self._is_homing, self._outcome)

    async def write(self, command: AxisCommand) -> None:
        """Make the axis do this from now on, or raise `DriveError`. Homing goes on under a halt."""
        if self._is_faulty or (self._task is not None and isinstance(command, Halt)):
            return
        if self._task is not None:
            self.abort()
        match command:
            case Halt():
                await self._halt()
            case Position(position_deg, speed_dps):
                await self._move(command, position_deg, speed_dps)
            case Velocity(velocity_dps):
                await self._turn(command, velocity_dps)
            case _ as never:
                assert_never(never)

    async def begin(self, kind: RequestKind) -> None:
        """Begin a request; its outcome shows in a later reading, at once where it cannot be begun."""
        self._outcome = None
        self._doing = None
        self._task = _Task(kind, self._clock.now())
        if kind is RequestKind.RESET_FAULT:
            await self._reset()
            return
        if self._is_faulty or self._last is None or self._last.moving:
            self.abort()
            return
        await self._enable()
        if kind is RequestKind.HOME:
            await self._dialect.home()
        else:
            await self._dialect.set_home()

    async def stop(self) -> None:
        """Ramp down ahead of everything that waits, and give up a request that is under way."""
        self.abort()
        self._doing = None
        await self._dialect.stop()
        self._may_turn = False

    async def stand(self) -> None:
        """Ramp down if it was told to move, without a reading first; a search for the origin goes on."""
        if self._may_turn and self._task is None:
            await self.stop()

    def abort(self) -> None:
        """Call the request that is under way failed."""
        if self._task is not None:
            self.give_up()

    def give_up(self) -> None:
        """Call a request failed, also one that never began; what an earlier one brought counts no more."""
        self._end(succeeded=False)

    def forget(self) -> None:
        """Write the next command in full."""
        self._doing = None
        self.unit.forget()

    @property
    def _is_homing(self) -> bool:
        return self._task is not None and self._task.kind is RequestKind.HOME

    async def _confirm(self) -> None:
        """Read back what was written; what the drive did not take is written again by the next command."""
        try:
            await self.unit.confirm()
        except DriveError:
            self._doing = None
            raise

    async def _enable(self) -> None:
        await self._dialect.enable()
        self._was_enabled = True

    async def _reset(self) -> None:
        """Clear a fault; a drive without one is left alone, as a reset may switch its motor off."""
        if not self._is_faulty:
            self._end(succeeded=True)
            return
        self._is_disabled = False
        await self._dialect.reset()

    async def _halt(self) -> None:
        """Ramp down, also from a motion that somebody else, or a life before this one, has begun."""
        moves = self._last is not None and self._last.moving
        if self._doing != Halt() and (self._was_enabled or moves):
            await self._dialect.halt()
            self._doing = Halt()
            self._may_turn = False

    async def _move(self, command: Position, position_deg: float, speed_dps: float) -> None:
        if command == self._doing:
            return
        if speed_dps <= 0.0:
            await self._halt()
            return
        self._doing, self._may_turn = None, True
        await self._enable()
        confirmed = self._last is not None and not self._last.moving
        await self._dialect.move(self._gearing.steps(position_deg), speed_dps, confirmed=confirmed)
        self._doing = command

    async def _turn(self, command: Velocity, velocity_dps: float) -> None:
        if velocity_dps == 0.0:
            await self._halt()
            return
        if self._has_watchdog and command == self._doing:
            return
        self._doing, self._may_turn = None, True
        await self._enable()
        if self._has_watchdog:
            await self._dialect.turn(velocity_dps)
        else:
            await self._step(velocity_dps)
        self._doing = command

    async def _step(self, velocity_dps: float) -> None:
        """Go as far as the axis would come if its lease ended now: that long at speed, then ramping down."""
        if self._last is None:
            raise DriveError(
                say("The drive at {where} has not been read yet; it is not moved.", where=self.unit.where)
            )
        target, speed_dps = self._stepped(self._last.position_deg, velocity_dps)
        await self._dialect.move(target, speed_dps, confirmed=False)

    def _stepped(self, from_deg: float, velocity_dps: float) -> tuple[int, float]:
        """Return target and speed of a step of hand motion."""
        speed_dps = min(abs(velocity_dps), self._config.speed_dps)
        reach_deg = speed_dps * LEASE_S + speed_dps**2 / (2.0 * self._config.acceleration_dps2)
        return self._gearing.steps(from_deg + (reach_deg if velocity_dps > 0.0 else -reach_deg)), speed_dps

    def _encoded(self, command: Position | Velocity) -> Iterator[Mapping[str, float]]:
        """Yield the registers of a command; without a watchdog a turn is a step, here from either limit."""
        match command:
            case Position(position_deg, speed_dps):
                yield self._dialect.moving(self._gearing.steps(position_deg), speed_dps)
            case Velocity(velocity_dps) if self._has_watchdog:
                yield self._dialect.turning(velocity_dps)
            case Velocity(velocity_dps):
                for from_deg in (self._config.minimum_deg, self._config.maximum_deg):
                    yield self._dialect.moving(*self._stepped(from_deg, velocity_dps))

    def _notice(self, status: AxisStatus) -> None:
        """Note that the motor was switched off, and by what: a restart, or somebody else."""
        if not self._was_enabled or status.enabled:
            return
        self._was_enabled = False
        self.forget()
        lost_zero = self._last is not None and self._last.homed and not status.homed
        self._is_disabled = not status.fault and not lost_zero
        if lost_zero:
            self.abort()

    async def _fault_code(self, status: AxisStatus) -> int:
        if self._is_disabled:
            return DISABLED
        if not status.fault:
            return 0
        found = await self.unit.poll("fault_code")
        return int(found.get("fault_code", 0)) or UNNAMED

    def _velocity_dps(self, values: dict[str, float]) -> float:
        register = self.unit.profile.registers["velocity"]
        return self._gearing.velocity_dps(values.get("velocity", 0.0), register.unit)

    def _watch_task(self, status: AxisStatus, position_deg: float) -> None:
        """End a request that is done or failed."""
        task = self._task
        if task is None:
            return
        if status.moving and not self._is_faulty:
            self._task = _Task(task.kind, task.begun_at, seen_moving=True)
        elif task.kind is not RequestKind.RESET_FAULT:
            self._watch_reference(task, status, position_deg)
        elif not self._is_faulty:
            self._end(succeeded=True)
        if self._task is not None and not status.moving and self._clock.now() - task.begun_at > PATIENCE:
            self._end(succeeded=False)

    def _watch_reference(self, task: _Task, status: AxisStatus, position_deg: float) -> None:
        """End a search or a zero whose axis stands still."""
        if not self._is_faulty and status.homed and self._is_at_zero(task, position_deg):
            self._end(succeeded=True)
        elif self._is_faulty or task.seen_moving:
            self._end(succeeded=False)

    def _is_at_zero(self, task: _Task, position_deg: float) -> bool:
        """Return whether the axis stands at zero, after a search that was seen or had time to begin."""
        if task.kind is RequestKind.HOME:
            waited = task.seen_moving or self._clock.now() - task.begun_at > PATIENCE / 2
            return waited and abs(position_deg) <= HOME_WITHIN_DEG
        return abs(position_deg) <= ZERO_WITHIN_DEG

    def _end(self, *, succeeded: bool) -> None:
        self._task, self._outcome = None, succeeded
