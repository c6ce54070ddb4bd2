"""One tracker living on a clock: read, decide, write, whenever the scheduler has it tick."""

import asyncio
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager, nullcontext
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Protocol

from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, NOTHING, say, told_by
from app.drives.drive import Drive, answers_at_once, check_fit, line_turn
from app.drives.register import ValueMisfit
from app.modbus.errors import DriveError, DriveRefused
from app.site.loop.line_pace import LinePace
from app.site.loop.link_quality import RoundTrips
from app.site.loop.scheduler import Scheduler, Slot
from app.site.loop.tick_lateness import TickCounter
from app.tracker.access.interlocks import Action
from app.tracker.access.location_change import Doing
from app.tracker.commands.commands import Command
from app.tracker.commissioning.steps import Standing, standing_of
from app.tracker.controller import Controller
from app.tracker.memory.memory import TrackerMemory, TrackerState
from app.tracker.memory.observation import Observation
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Snapshot
from app.tracker.supervision.home_shift import shifted, unshifted
from app.tracker.values.motion import HALT, AxisCommand, DriveCommand, Feedback, Velocity
from app.tracker.values.reason import Reason

STOP_WITHIN_S = 0.5
CLOSE_WITHIN_S = 1.0
MOST_REFUSALS = 3
"""So many commands may be refused before one that moves an axis is taken; then that is a fault."""
STANDSTILL = Velocity(0.0)
NEVER_FORBIDDEN = ("stop", "reset_fault")

log = get_logger()


class Surroundings(Protocol):
    """What a tracker shares with its site."""

    def observe(self, config: TrackerConfig, feedback: Feedback | None) -> Observation:
        """Return everything one tick may depend on."""


class TrackerLoop:
    """Runs one controller on one drive; what happened in a tick is handed to `on_tick`."""

    def __init__(
        self,
        state: TrackerState,
        drive: Drive,
        clock: Clock,
        surroundings: Surroundings,
        scheduler: Scheduler,
        *,
        period: timedelta,
        on_tick: Callable[["TrackerLoop", Observation, tuple[Event, ...]], None],
    ) -> None:
        self.drive = drive
        self.controller = Controller(state.config, state.memory, drive.capabilities)
        self.counter = TickCounter()
        self.round_trips = RoundTrips()
        self.feedback: Feedback | None = None
        self.broken: Reason | None = None
        self.answers_at_once = answers_at_once(drive)
        self._clock = clock
        self._surroundings = surroundings
        self._scheduler = scheduler
        self._line = LinePace(state.config.drive.kind, period)
        self._period = period
        self._on_tick = on_tick
        self._trouble: Reason | None = None
        self._write_failed = False
        self._was_read = False
        self._refusals: tuple[Reason, ...] = ()
        self._ending = False
        self._stored_memory = state.memory
        self._last_snapshot: Snapshot | None = None
        self._slot: Slot | None = None

    @property
    def config(self) -> TrackerConfig:
        """Return the tracker's configuration."""
        return self.controller.config

    @property
    def memory(self) -> TrackerMemory:
        """Return the tracker's latches."""
        return self.controller.memory

    @property
    def state(self) -> TrackerState:
        """Return what is stored about this tracker."""
        return TrackerState(self.controller.config, self.controller.memory)

    @property
    def moving(self) -> bool:
        """Return whether an axis turns."""
        seen = self.feedback
        return seen is not None and (seen.azimuth.moving or seen.elevation.moving)

    @property
    def trouble(self) -> Reason | None:
        """Return what went wrong when the drive was read or told last."""
        return self._trouble

    @property
    def activity(self) -> ActivityName:
        """Return what the tracker is doing; a broken one is faulted."""
        return ActivityName.FAULTED if self.broken is not None else self.controller.activity

    @property
    def doing(self) -> Doing:
        """Return what the tracker does, and whether it goes on tracking with nobody asked."""
        continues = self.broken is None and self.controller.continues
        return Doing(self.activity, self.memory.tracking_on, continues)

    def take_changed(self) -> bool:
        """Return whether the latches changed since this was last asked."""
        changed = self.memory is not self._stored_memory
        self._stored_memory = self.memory
        return changed

    def start(self) -> None:
        """Begin to tick."""
        self._slot = self._scheduler.add(self)

    async def close(self) -> None:
        """Stop the drive, end ticking and let go of the drive."""
        slot, self._slot = self._slot, None
        if slot is not None:
            await self._scheduler.remove(slot)
        await self.stop_drive()
        try:
            async with asyncio.timeout(CLOSE_WITHIN_S):
                await self.drive.close()
        except (DriveError, TimeoutError) as error:
            log.warning("drive_not_closed", tracker=self.config.tracker_id, reason=str(error))

    def wake(self) -> None:
        """Tick now: something was asked."""
        if self._slot is not None:
            self._scheduler.ask(self._slot)

    def handle(self, command: Command, actor: str, via: str = "") -> tuple[Event, ...]:
        """Have the controller obey, as `Controller.handle`; whatever deadline it has then is watched."""
        try:
            return self.controller.handle(command, self._clock.now(), actor, via)
        finally:
            if self._slot is not None:
                self._scheduler.look(self._slot)

    async def stop_drive(self) -> bool:
        """Ramp both axes down beside the controller; return whether the drive took it."""
        try:
            async with asyncio.timeout(STOP_WITHIN_S):
                await self.drive.stop()
        except (DriveError, TimeoutError) as error:
            log.error("stop_not_taken", tracker=self.config.tracker_id, reason=str(error))
            return False
        except Exception:
            log.exception("stop_failed", tracker=self.config.tracker_id)
            return False
        return True

    async def stop_for_good(self) -> None:
        """Ramp both axes down and command no motion any more: this life of the machine is about to end."""
        self._ending = True
        await self.stop_drive()

    def repair(self) -> None:
        """Begin again with a new state after an unexpected error; tracking waits for the operator."""
        memory = replace(self.memory, fault_code=None, fault_text=NOTHING)
        self.controller = Controller(self.config, memory, self.drive.capabilities, resumes=False)
        self.broken = None
        self.wake()

    def snapshot(self, at: datetime, *, asked: bool = True) -> Snapshot:
        """Return the tracker as everyone sees it; a broken one shows its fault.

        Unless it is `asked` what is allowed now, and why not, `actions` are left out.
        """
        if self.broken is not None and self._last_snapshot is not None:
            return _broken_snapshot(self._last_snapshot, at, self.broken, asked=asked)
        shown = self.controller.snapshot(at, self._clock.now(), asked=asked)
        said = tuple(filter(None, (self._trouble, self._line.notice(self.config.name))))
        if said:
            shown = replace(shown, notices=(*shown.notices, *said))
        self._last_snapshot = shown
        return shown

    @property
    def standing(self) -> Standing:
        """Return what the five steps go by of how the tracker stands."""
        if self.broken is None:
            return self.controller.standing
        return standing_of(self.snapshot(self._clock.now(), asked=False))

    def deadline(self) -> datetime | None:
        """Return the instant by which it must tick again, such as the end of a jog's lease."""
        return None if self.broken is not None else self.controller.deadline()

    async def outlasted(self) -> None:
        """Stop the drive beside a tick that is still in flight although the lease of a jog has ended."""
        until = self.deadline() if self.activity is ActivityName.JOGGING else None
        if until is not None and until <= self._clock.now():
            await self.stop_drive()

    async def tick(self, scheduled: datetime | None) -> None:
        """Tick, whatever goes wrong; how late that is counts where it was scheduled."""
        if scheduled is not None and self._is_others_turn(scheduled):
            return
        if scheduled is not None:
            self.counter.late(self._scheduler.late(scheduled))
        if self.broken is not None:
            await self.stop_drive()
            return
        try:
            await self._tick()
        except Exception as error:
            log.exception("tick_failed", tracker=self.config.tracker_id)
            await self._break_off(error)

    def _is_others_turn(self, scheduled: datetime) -> bool:
        """Return whether this instant is the others' on the line; what has a deadline is not put off."""
        every, slot = self._line.pace.every, self._slot
        if every == 1 or slot is None or self.broken is not None or self.deadline() is not None:
            return False
        return (int(scheduled.timestamp() / self._period.total_seconds()) + slot.number) % every != 0

    def _keep_pace(self) -> None:
        """Follow the turn of the line that the drive shares."""
        turn = line_turn(self.drive)
        if turn is not None:
            shared = turn.devices > 1
            self._line.follow(turn, self.drive.capabilities.watchdog_s if shared else None)

    async def _tick(self) -> None:
        """Read, decide, write; after a write that failed nothing moves until one was taken and judged."""
        self.counter.ticks += 1
        unheard = self._write_failed
        if not self.answers_at_once:
            self._keep_pace()
        raw = await self._read()
        self.controller.know(self.drive.capabilities)
        self.feedback = shifted(self.memory.home_shift, raw)
        seen = self._surroundings.observe(self.config, self.feedback)
        pace = self._line.pace
        refused = self._refusals[-1] if len(self._refusals) >= MOST_REFUSALS else None
        link = self.round_trips.quality(pace.within_s)
        seen = seen._replace(link=link, silence=pace.silence, refused=refused)
        tick = self.controller.tick(seen)
        if not self.controller.is_silent:
            told = _unmoved(tick.command) if unheard or self._ending else tick.command
            await self._write(unshifted(self.memory.home_shift, told))
            if not self._write_failed and (_moves(told) or self.activity is ActivityName.FAULTED):
                self._refusals = ()
        self._on_tick(self, seen, tick.events)

    def _in_time(self) -> AbstractAsyncContextManager[object]:
        return nullcontext() if self.answers_at_once else asyncio.timeout(self._line.pace.within_s)

    async def _read(self) -> Feedback | None:
        asked_at, self._was_read = self._clock.now(), False
        try:
            async with self._in_time():
                feedback = await self.drive.read()
            if not feedback.is_possible:
                raise DriveError(N_("The drive reports a number that is impossible."))
        except (DriveError, TimeoutError) as error:
            self.counter.read_failures += 1
            self._trouble = _trouble(error)
            return None
        self._was_read = True
        self.round_trips.count(self._clock.now() - asked_at)
        if self._write_failed:
            return None
        self._trouble = None
        return feedback

    async def _write(self, command: DriveCommand) -> None:
        try:
            async with self._in_time():
                await self.drive.write(command)
            self._write_failed = False
        except (DriveError, TimeoutError) as error:
            self.counter.write_failures += 1
            self._write_failed = True
            self._trouble = _trouble(error)
            if self._was_read and isinstance(error, DriveRefused):
                times = MOST_REFUSALS if isinstance(error, ValueMisfit) else 1
                refusals = (*self._refusals, *[_refused(self.config, _advised(self.drive, error))] * times)
                self._refusals = refusals[-MOST_REFUSALS:]

    async def _break_off(self, error: Exception) -> None:
        """Stop this tracker for good after an error that nobody foresaw; the others go on."""
        name = self.config.tracker_id
        self.broken = Reason(
            "internal_error",
            say(
                "{name} was stopped: the controller met an unexpected error ({name2}).",
                name=name,
                name2=type(error).__name__,
            ),
            N_("Keep the log for the manufacturer, then reset the fault."),
        )
        memory = replace(self.memory, fault_code=self.broken.code, fault_text=self.broken.message)
        self.controller = Controller(self.config, memory, self.drive.capabilities)
        await self.stop_drive()
        seen = self._surroundings.observe(self.config, None)
        event = Event(seen.site_time, EventKind.FAULT_RAISED, name, self.broken.message)
        self._on_tick(self, seen, (event,))


def _unmoved(command: DriveCommand) -> DriveCommand:
    """Return a command without its motion and its request; what ends a search for the origin stays."""
    return DriveCommand(_still(command.azimuth), _still(command.elevation))


def _still(axis: AxisCommand) -> AxisCommand:
    return axis if axis == STANDSTILL else HALT


def _moves(command: DriveCommand) -> bool:
    return any(axis not in (HALT, STANDSTILL) for axis in (command.azimuth, command.elevation))


def _advised(drive: Drive, refusal: DriveRefused) -> DriveRefused:
    """Return a refusal with what to change in the settings where a number of theirs does not fit."""
    if isinstance(refusal, ValueMisfit):
        try:
            check_fit(drive)
        except ValueMisfit as misfit:
            return misfit
    return refusal


def _refused(config: TrackerConfig, error: DriveRefused) -> Reason:
    return Reason(
        "command_refused",
        say(
            "The drive of {name} was not given its command: {refusal}",
            name=config.name,
            refusal=told_by(error),
        ),
        N_("Correct the settings or the drive as described, then reset the fault."),
    )


def _trouble(error: DriveError | TimeoutError) -> Reason:
    text = told_by(error) or N_(
        "The drive did not answer in time: it is off, frozen, or busy, or its cable is cut."
    )
    return Reason("drive_trouble", text, N_("Check the drive's supply, cable, and address."))


def _broken_snapshot(last: Snapshot, at: datetime, broken: Reason, *, asked: bool) -> Snapshot:
    """Return what is still known of a tracker whose controller broke: nothing that was measured is live."""
    forbidden: dict[str, tuple[Reason, ...]] = {
        action.value: () if action in NEVER_FORBIDDEN else (broken,) for action in Action
    }
    age_s = last.position_age_s
    return replace(
        last,
        at=at,
        activity=ActivityName.FAULTED,
        activity_text=broken.message,
        fault=broken,
        target=None,
        setpoint=None,
        measured=None,
        position_age_s=None if age_s is None else age_s + (at - last.at).total_seconds(),
        following_error_deg=None,
        off_sun_deg=None,
        in_position=False,
        approaching=False,
        continues=False,
        azimuth=None,
        elevation=None,
        show=None,
        actions=forbidden if asked else {},
        unreachable=None,
    )
