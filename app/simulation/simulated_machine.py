"""The machine of a simulated tracker: both axes, watchdog, requests, faults and position memory."""

from dataclasses import replace
from datetime import datetime, timedelta

from app.base.clock import Clock
from app.simulation.cabinet import CABINET_FAULTS, Cabinet
from app.simulation.faults import LIGHT_FAULTS, LINK_FAULTS, Fault, FaultKind
from app.simulation.position_memory import UNKNOWN_OFFSET, Keeper, Memory, PositionMemory
from app.simulation.simulated_axis import STANDARD, Mechanics, SimulatedAxis
from app.simulation.sunlight import Sunlight
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.motion import (
    HALT,
    AxisCommand,
    DriveCommand,
    DriveRequest,
    Feedback,
    Halt,
    RequestKind,
)

WATCHDOG = timedelta(milliseconds=500)
SETTLED = timedelta(seconds=1)
STOP_ALL = DriveCommand()


class SimulatedMachine:
    """Everything happens by calling it: a call brings the machine forward to the clock's present first."""

    def __init__(
        self,
        config: TrackerConfig,
        clock: Clock,
        *,
        memory: Memory | None = None,
        watchdog: timedelta | None = WATCHDOG,
        mechanics: Mechanics = STANDARD,
        light: Sunlight | None = None,
    ) -> None:
        self._clock = clock
        self._light = light
        self._started_at = clock.now()
        self._watchdog_s = watchdog.total_seconds() if watchdog is not None else None
        self._keeper = Keeper(memory, config)
        known = self._keeper.known
        self._boot_count = known.boot_count
        self._azimuth = SimulatedAxis(config.azimuth, mechanics, known.azimuth)
        self._elevation = SimulatedAxis(config.elevation, mechanics, known.elevation)
        self._mounted = (self._azimuth,) if config.mount.single_axis else (self._azimuth, self._elevation)
        self._rested_at_s = 0.0
        self._command = STOP_ALL
        self._fed_at_s: float | None = None
        self._tripped = False
        self._trip_was_read = False
        self._fault_code = 0
        self._homing: int | None = None
        self._request_seen = 0
        self._request_done = 0
        self._request_failed = False
        self._link_fault: FaultKind | None = None
        self._ignores_writes = False
        self._cabinet = Cabinet()
        self._clock_offset = timedelta(0)
        self._steady: Feedback | None = None

    @property
    def true_orientation(self) -> Orientation:
        """Return where the panel really points, whatever the encoders say."""
        now_s = self._advance()
        return Orientation(self._azimuth.true_deg(now_s), self._elevation.true_deg(now_s))

    @property
    def link_fault(self) -> FaultKind | None:
        """Return the fault of the connection that is being played, if any."""
        return self._link_fault

    @property
    def command(self) -> DriveCommand:
        """Return what the drive was told and has taken."""
        self._advance()
        return self._command

    @property
    def is_resting(self) -> bool:
        """Return whether both axes stand still."""
        return self._resting(self._advance())

    @property
    def uptime(self) -> timedelta:
        """Return for how long the drive has run."""
        return self._clock.now() - self._started_at

    @property
    def watchdog(self) -> timedelta | None:
        """Return the time-out of the communication watchdog, None without one."""
        return timedelta(seconds=self._watchdog_s) if self._watchdog_s is not None else None

    @property
    def ignores_writes(self) -> bool:
        """Return whether commands are acknowledged and not taken."""
        return self._ignores_writes

    @property
    def boot_count(self) -> int:
        """Return how often the drive has started."""
        return self._boot_count

    @property
    def wall_clock(self) -> datetime:
        """Return what the drive's own clock shows."""
        return self._clock.now() + self._clock_offset

    def observe(self, *, told: bool = True) -> Feedback:
        """Return the reading of this instant; `told` says that the master gets to know it."""
        feedback = self._moved(told=told)
        if self._light is None:
            return feedback
        return replace(feedback, light=self._light.reading(self.true_orientation))

    def _moved(self, *, told: bool) -> Feedback:
        """Return the reading without the light; the same object while nothing changes."""
        now_s = self._advance()
        if told:
            self._trip_was_read = self._tripped
        if self._steady is not None:
            return self._steady
        resting = self._resting(now_s)
        feedback = Feedback(
            azimuth=self._azimuth.feedback(now_s),
            elevation=self._elevation.feedback(now_s),
            boot_count=self._boot_count,
            fault_code=self._fault_code,
            homing=self._homing is not None,
            watchdog_tripped=self._tripped,
            request_done=self._request_done,
            request_failed=self._request_failed,
            local=self._cabinet.local,
            supply_v=self._cabinet.supply_v,
        )
        if resting and self._keeper.true:
            self._steady = feedback
        return feedback

    def obey(self, command: DriveCommand, *, alive: bool = True) -> None:
        """Do this from now on; a request with a new number is carried out. `alive` feeds the watchdog.

        After the watchdog has tripped nothing is obeyed until somebody has read that it did.
        """
        now_s = self._advance()
        if alive:
            self._fed_at_s = now_s
            self._clear_trip()
        self._do(command, now_s)
        self._count(now_s)

    def _do(self, command: DriveCommand, now_s: float) -> None:
        if command is self._command or command == self._command or self._ignores_writes or self._tripped:
            return
        self._change(now_s)
        self._take_request(command.request, now_s)
        if self._homing is not None and _is_halt(command):
            self._command = command
            return
        self._end_homing(failed=True)
        self._turn(command, now_s)

    def turn(self, axis: Axis, command: AxisCommand) -> None:
        """Make one axis do this from now on, as a drive of its own would; the other goes on."""
        now_s = self._advance()
        self._change(now_s)
        azimuth, elevation = self._command.azimuth, self._command.elevation
        if axis is Axis.AZIMUTH:
            self._command = DriveCommand(command, elevation)
        else:
            self._command = DriveCommand(azimuth, command)
        self._axis(axis).obey(HALT if self._fault_code else command, now_s)

    def seek_origin(self, axis: Axis) -> None:
        """Send one axis to its origin switch, whatever the encoder says."""
        now_s = self._advance()
        self._change(now_s)
        self._axis(axis).seek_origin(now_s)

    def set_home(self, axis: Axis) -> bool:
        """Call the present position of one axis zero; return whether it stood still, as it must."""
        now_s = self._advance()
        self._change(now_s)
        return self._set_zero(self._axis(axis), now_s)

    def reset_fault(self) -> None:
        """Clear a drive fault; both axes stay where they are."""
        now_s = self._advance()
        self._change(now_s)
        self._fault_code = 0
        self._turn(STOP_ALL, now_s)

    def halt(self) -> None:
        """Ramp both axes down now and end homing."""
        now_s = self._advance()
        self._fed_at_s = now_s
        self._change(now_s)
        self._end_homing(failed=True)
        self._turn(STOP_ALL, now_s)

    def remember_rest(self) -> None:
        """Ramp down and write the position memory at once: where both axes come to rest is known already."""
        self.halt()
        end_s = max(self._advance(), self._azimuth.end_s, self._elevation.end_s)
        self._keeper.settle(self._known(end_s))

    def set_wall_clock(self, at: datetime) -> None:
        """Make the drive's own clock show `at` now."""
        self._clock_offset = at - self._clock.now()

    def inject(self, fault: Fault) -> None:
        """Suffer a fault from now on, until `end_injected_faults`; a drive fault also ends by a reset."""
        now_s = self._advance()
        self._change(now_s)
        match fault.kind:
            case kind if kind in LINK_FAULTS:
                self._link_fault = kind
            case kind if kind in LIGHT_FAULTS:
                if self._light is not None:
                    self._light.inject(fault)
            case FaultKind.IGNORED_WRITES:
                self._ignores_writes = True
            case FaultKind.DRIVE_FAULT:
                self._fault_code = int(fault.amount) or 1
                self._end_homing(failed=True)
                self._turn(self._command, now_s)
            case FaultKind.POWER_LOSS:
                self._lose_power(now_s)
            case kind if kind in CABINET_FAULTS:
                self._cabinet.inject(fault)
                self._turn(self._command, now_s)
            case _:
                self._inject_axes(fault, now_s)

    def _inject_axes(self, fault: Fault, now_s: float) -> None:
        for axis, one in ((Axis.AZIMUTH, self._azimuth), (Axis.ELEVATION, self._elevation)):
            if fault.hits(axis):
                one.inject(fault, now_s)

    def end_injected_faults(self) -> None:
        """Be sound again and do what was commanded. A drive fault still waits for its reset."""
        now_s = self._advance()
        self._change(now_s)
        self._link_fault = None
        self._ignores_writes = False
        self._cabinet = Cabinet()
        if self._light is not None:
            self._light.clear()
        self._azimuth.end_injected_faults(now_s)
        self._elevation.end_injected_faults(now_s)

    def _axis(self, axis: Axis) -> SimulatedAxis:
        return self._azimuth if axis is Axis.AZIMUTH else self._elevation

    def _advance(self) -> float:
        """Let everything happen that the time since the last call brings, and return the time in seconds."""
        now_s = (self._clock.now() - self._started_at).total_seconds()
        if self._watchdog_s is not None and self._fed_at_s is not None and not self._tripped:
            self._watch(now_s, self._fed_at_s + self._watchdog_s)
        if self._homing is not None and self._resting(now_s):
            self._finish_homing(now_s)
        if not self._keeper.true:
            self._keep(now_s)
        return now_s

    def _watch(self, now_s: float, deadline_s: float) -> None:
        """Stop both axes at the deadline if no command has come until then."""
        if now_s <= deadline_s:
            return
        self._tripped = True
        self._steady = None
        if not self._resting(deadline_s):
            self._end_homing(failed=True)
            self._turn(STOP_ALL, deadline_s)

    def _clear_trip(self) -> None:
        if self._tripped and self._trip_was_read:
            self._tripped = self._trip_was_read = False
            self._steady = None

    def _turn(self, command: DriveCommand, now_s: float) -> None:
        self._command = command
        barred = self._fault_code != 0 or self._cabinet.local
        first, second = self._cabinet.wired(command)
        self._azimuth.obey(HALT if barred else first, now_s)
        self._elevation.obey(HALT if barred else second, now_s)

    def _change(self, now_s: float) -> None:
        """Note that the next reading differs and the position memory is no longer true."""
        self._steady = None
        self._keeper.disturb(self._known(now_s))

    def _resting(self, now_s: float) -> bool:
        return self._azimuth.resting(now_s) and self._elevation.resting(now_s)

    def _keep(self, now_s: float) -> None:
        """Leave a trusted position memory once the axes have stood still for a while."""
        if not self._resting(now_s):
            self._rested_at_s = now_s
            return
        if now_s - self._rested_at_s >= SETTLED.total_seconds():
            self._keeper.settle(self._known(now_s))

    def _known(self, now_s: float) -> PositionMemory:
        """Return what the drive knows at a time."""
        azimuth, elevation = self._azimuth.memory(now_s), self._elevation.memory(now_s)
        return PositionMemory(azimuth, elevation, self._boot_count, trusted=True)

    def _count(self, now_s: float) -> None:
        """Keep what the drive will know if no command comes any more: its watchdog stops the axes."""
        if not self._keeper.counts:
            return
        fed_at_s = now_s if self._fed_at_s is None else self._fed_at_s
        alone_s = fed_at_s + (self._watchdog_s or 0.0)
        azimuth, elevation = self._azimuth.left_alone(alone_s), self._elevation.left_alone(alone_s)
        self._keeper.follow(PositionMemory(azimuth, elevation, self._boot_count, trusted=True))

    def _take_request(self, request: DriveRequest | None, now_s: float) -> None:
        if request is None or request.number == self._request_seen:
            return
        self._request_seen = request.number
        match request.kind:
            case RequestKind.SET_HOME_AZIMUTH:
                self._answer(done=self._set_zero(self._azimuth, now_s))
            case RequestKind.SET_HOME_ELEVATION:
                self._answer(done=self._set_zero(self._elevation, now_s))
            case RequestKind.RESET_FAULT:
                self._fault_code = 0
                self._answer(done=True)
            case RequestKind.HOME:
                self._begin_homing(request.number, now_s)

    def _answer(self, *, done: bool) -> None:
        self._request_done = self._request_seen
        self._request_failed = not done

    def _set_zero(self, axis: SimulatedAxis, now_s: float) -> bool:
        if not axis.resting(now_s):
            return False
        axis.set_home(now_s)
        return True

    def _begin_homing(self, number: int, now_s: float) -> None:
        if self._fault_code:
            self._answer(done=False)
            return
        self._homing = number
        for axis in self._mounted:
            axis.seek_origin(now_s)

    def _finish_homing(self, now_s: float) -> None:
        found = all(axis.feedback(now_s).at_origin for axis in self._mounted)
        if found:
            for axis in self._mounted:
                axis.set_home(now_s)
        self._end_homing(failed=not found)

    def _end_homing(self, *, failed: bool) -> None:
        if self._homing is not None:
            self._homing = None
            self._steady = None
            self._answer(done=not failed)

    def _lose_power(self, now_s: float) -> None:
        self._boot_count += 1
        self._homing = None
        self._fault_code = 0
        self._request_seen = self._request_done = 0
        self._request_failed = False
        self._command = STOP_ALL
        self._fed_at_s = None
        self._azimuth.lose_power(now_s, UNKNOWN_OFFSET.azimuth_deg)
        self._elevation.lose_power(now_s, UNKNOWN_OFFSET.elevation_deg)


def _is_halt(command: DriveCommand) -> bool:
    axes: tuple[AxisCommand, AxisCommand] = (command.azimuth, command.elevation)
    return all(isinstance(axis, Halt) for axis in axes)
