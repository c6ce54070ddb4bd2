"""One tracker's mind: `handle` and `tick` are the two ways in."""

from dataclasses import replace
from datetime import datetime, timedelta
from typing import NamedTuple, assert_never

from app.tracker import report
from app.tracker.activities import (
    faulted,
    homing,
    jogging,
    measuring,
    moving,
    showing,
    stowing,
    tracking,
)
from app.tracker.activity import (
    HOLDING,
    NAMES,
    AxisPair,
    Faulted,
    Holding,
    Homing,
    Jogging,
    Measuring,
    Moving,
    SettingHome,
    Showing,
    Stopping,
    Stowed,
    Stowing,
    Tracking,
)
from app.tracker.announce import is_announced
from app.tracker.approach import has_reached
from app.tracker.authority import watch_local, watch_service
from app.tracker.commands import Command
from app.tracker.commissioning import Standing
from app.tracker.config import TrackerConfig
from app.tracker.controller_state import HALTED, NOWHERE, STANDING, ControllerState, Turn
from app.tracker.drive_tests import Proofs
from app.tracker.home_shift import forget
from app.tracker.machine_guard import watch_machine
from app.tracker.memory import CommissioningLock, Confirmation, Pointing, Sighting, StepName, TrackerMemory
from app.tracker.motion import (
    AxisCommand,
    DriveCapabilities,
    DriveCommand,
    Feedback,
    Halt,
    Position,
    RequestKind,
)
from app.tracker.mount import upright
from app.tracker.mounts.missing_axes import as_mounted, for_drive
from app.tracker.observation import Observation
from app.tracker.orders import obey
from app.tracker.positioning import at_rest
from app.tracker.protect import check_following, found, miss, obey_switches, protect
from app.tracker.reason import Reason
from app.tracker.recovery import recover
from app.tracker.regions import bar
from app.tracker.snapshot import ActivityName, Event, EventKind, Snapshot
from app.tracker.transitions import leave, lose_home
from app.tracker.weather_protection import guarding, look

ANNOUNCED = (Tracking, Showing, Moving, Stowing)
"""Activities whose first motion may have to wait for its warning."""
RESUME_WITHIN = timedelta(seconds=10)
"""After a restart the drive must answer within this time; later it is a drive that came back."""


class Tick(NamedTuple):
    """What comes out of one tick: what the drive shall do, and what happened."""

    command: DriveCommand
    events: tuple[Event, ...]


class Controller:
    """Decides for one tracker; pure: reads no clock and no drive, knows only what it is told."""

    def __init__(
        self,
        config: TrackerConfig,
        memory: TrackerMemory,
        capabilities: DriveCapabilities,
        *,
        resumes: bool = True,
    ) -> None:
        self._mind = ControllerState(config, memory, capabilities)
        self._resumes = resumes
        if not resumes and (memory.stow is not None or memory.show_moves):
            self._mind.wait = _BEGUN_ANEW
        if memory.fault_code is not None:
            self._mind.activity = Faulted(Reason(memory.fault_code, memory.fault_text, _RESET_HINT))

    @property
    def config(self) -> TrackerConfig:
        """Return what the engineer set."""
        return self._mind.config

    @property
    def memory(self) -> TrackerMemory:
        """Return what must survive a power cut; a new object whenever it changed."""
        return self._mind.memory

    @property
    def activity(self) -> ActivityName:
        """Return what the tracker is doing."""
        return NAMES[type(self._mind.activity)]

    @property
    def is_silent(self) -> bool:
        """Return whether the drive is to be told nothing at all, so that its watchdog is not fed."""
        return measuring.is_silent(self._mind)

    def handle(
        self, command: Command, now: datetime, actor: str = "operator", via: str = ""
    ) -> tuple[Event, ...]:
        """Obey a command and return what happened, or raise `CommandRejected` with all unmet conditions.

        `now` is the machine's steady time, as in `Observation.now`. The drive hears of it at the next tick.
        `via` is how whoever ordered was known, as in `Order`: what a program starts is announced.
        """
        mind = self._mind
        mind.site_time = mind.seen.site_time + (now - mind.seen.now) if mind.seen else now
        mind.now, mind.actor, mind.via = now, actor, via
        obey(mind, command)
        mind.aftermath = None
        return mind.drain()

    def tick(self, seen: Observation) -> Tick:
        """Return what the drive shall do from now on and what happened since the last tick."""
        mind = self._mind
        if mind.config.mount.single_axis:
            seen = seen._replace(feedback=as_mounted(mind.config, seen.feedback))
        mind.now, mind.site_time, mind.seen, mind.actor = seen.now, seen.site_time, seen, "machine"
        mind.via = ""
        mind.ticks += 1
        if mind.started_at is None:
            self._start(seen.now)
        look(mind, seen)
        command = self._blind(seen) if seen.feedback is None else self._see(seen, seen.feedback)
        mind.command = command = for_drive(mind.config, command)
        if mind.alarmed is not None or guarding(mind).stow is not None:
            self._note_not_stowed()
        horn = mind.warning is not None and mind.feedback is not None
        return Tick(replace(command, horn=True) if horn else command, mind.drain())

    def snapshot(self, at: datetime, now: datetime | None = None, *, asked: bool = True) -> Snapshot:
        """Return everything known after the last tick, stamped `at`.

        `now` is the machine's steady time, to which ages are counted; without it, that of the last tick.
        Unless `asked`, `actions` are left out.
        """
        return report.snapshot(self._mind, at, now or self._mind.now, asked=asked)

    @property
    def standing(self) -> Standing:
        """Return what the five steps go by of how the tracker stands."""
        return report.standing(self._mind)

    def frame(self) -> tuple[float, ...]:
        """Return the last tick as one row of `recording.COLUMNS`; the first two columns are NaN."""
        return report.frame(self._mind)

    def deadline(self) -> datetime | None:
        """Return the instant by which `tick` must be called again, else None.

        That is when a jog's lease ends, and soon again while it is measured how an axis comes to rest.
        """
        activity = self._mind.activity
        if isinstance(activity, Measuring) and activity.asked is not None:
            return self._mind.now + measuring.LOOK_EVERY
        return activity.until if isinstance(activity, Jogging) else None

    def configure(self, config: TrackerConfig, capabilities: DriveCapabilities) -> None:
        """Take over a new configuration; the caller sees to it that the tracker stands still.

        Another drive is another zero: trust in the old one is lost.
        """
        mind = self._mind
        leave(mind, "the configuration was changed.")
        if config.drive != mind.config.drive:
            mind.feedback = mind.feedback_at = None
            lose_home(mind, Reason("drive_changed", "another drive was configured."))
            forget(mind)
        mind.config, mind.capabilities = config, capabilities
        mind.setpoint, mind.target, mind.watches = NOWHERE, None, {}
        mind.corrected = None
        if mind.memory.rejected:
            mind.remember(rejected=())

    def know(self, capabilities: DriveCapabilities) -> None:
        """Take over what the drive is able to do as it was read last: its watchdog may be off, or another."""
        if capabilities != self._mind.capabilities:
            self._mind.capabilities = capabilities

    def set_pointing(self, pointing: Pointing) -> None:
        """Take over a correction from sightings; what the light sensors found goes with the old one."""
        self._mind.remember(pointing=pointing)
        self._mind.corrected = None

    def confirm(self, step: StepName, confirmation: Confirmation) -> None:
        """Remember that the operator said a step is right."""
        confirmations = {**self._mind.memory.confirmations, step: confirmation}
        self._mind.remember(confirmations=confirmations)

    def set_proofs(self, proofs: Proofs) -> None:
        """Take over what somebody said about the drive."""
        self._mind.remember(proofs=proofs)

    def set_control_epoch(self, epoch: int) -> None:
        """Remember the newest epoch of control, so that no later life gives it again."""
        self._mind.remember(control_epoch=epoch)

    def set_settings_lock(self, lock: CommissioningLock | None) -> None:
        """Take over who locked the settings, None where nobody did."""
        self._mind.remember(settings_lock=lock)

    def set_sightings(self, sightings: tuple[Sighting, ...]) -> None:
        """Keep these sightings and forget all others."""
        self._mind.remember(sightings=sightings)

    def _start(self, now: datetime) -> None:
        mind = self._mind
        mind.started_at = now
        if mind.memory.showing is not None:
            show_id = mind.memory.showing
            mind.remember(showing=None)
            message = "The show was interrupted: the controller restarted."
            mind.say(EventKind.SHOW_ENDED, message, outcome="interrupted", show_id=show_id)

    def _blind(self, seen: Observation) -> DriveCommand:
        """Go on for one failed reading, then stop: absence of information is a reason to stop."""
        mind = self._mind
        miss(mind, seen.now, seen.silence)
        mind.sun = seen.sun
        if isinstance(mind.activity, Jogging) and seen.now >= mind.activity.until:
            jogging.end(mind, mind.activity, "the jog command was not renewed in time.", "expired")
        if mind.lost or isinstance(mind.activity, Holding | Stopping | Faulted | Stowed):
            return STANDING if mind.command is STANDING or _may_search(mind) else HALTED
        return mind.command

    def _see(self, seen: Observation, feedback: Feedback) -> DriveCommand:
        mind = self._mind
        before, before_at = mind.feedback, mind.feedback_at
        if mind.misses:
            found(mind, feedback)
        mind.feedback, mind.feedback_at = feedback, seen.now
        watch_local(mind, before, feedback)
        protect(mind, before, feedback, seen.now - (before_at or seen.now))
        watch_service(mind)
        watch_machine(mind, before, feedback)
        if mind.watches or mind.command is not HALTED:
            check_following(mind, feedback, seen.now)
        if before is None and mind.started_at is not None and seen.now - mind.started_at <= RESUME_WITHIN:
            self._first_reading()
        recover(mind, feedback)
        stowing.guard(mind, feedback)
        turn = self._step(feedback, seen)
        mind.reached = has_reached(mind, turn, feedback)
        mind.activity, mind.target = turn.activity, upright(turn.target)
        mind.sun = seen.sun if turn.sun is None else turn.sun
        if turn.command is HALTED:
            return STANDING if feedback.homing and not isinstance(turn.activity, Homing) else HALTED
        return self._note(bar(mind, obey_switches(mind, turn.command, feedback), feedback))

    def _first_reading(self) -> None:
        """Decide once whether tracking goes on after a restart."""
        if self._resumes and isinstance(self._mind.activity, Holding | Faulted):
            tracking.resume(self._mind)

    def _note_not_stowed(self) -> None:
        """Say once that the panel is not stowed though it should be, and remember why."""
        mind = self._mind
        before, mind.alarmed = mind.alarmed, stowing.not_stowed(mind)
        if mind.alarmed is not None and before is None:
            mind.say(EventKind.NOT_STOWED, mind.alarmed.message, hint=mind.alarmed.hint)

    def _step(self, feedback: Feedback, seen: Observation) -> Turn:
        """Return the activity's turn; a motion that is being announced waits."""
        mind = self._mind
        if mind.warning is not None and self._waits():
            return Turn(mind.activity, HALTED, mind.target, seen.sun)
        activity = mind.activity
        match activity:
            case Tracking():
                return tracking.step(mind, activity, feedback, seen)
            case Holding() | Stopping():
                return Turn(HOLDING if at_rest(feedback) else activity)
            case Showing():
                return showing.step(mind, activity, feedback)
            case Jogging() | Moving() | Measuring() | Stowing() | Stowed():
                return _step_by_order(mind, activity, feedback)
            case SettingHome() | Homing():
                return homing.step(mind, activity, feedback)
            case Faulted():
                return faulted.step(mind, activity, feedback)
        assert_never(activity)

    def _waits(self) -> bool:
        """Return whether the motion is still being announced; what does not move needs no warning."""
        if isinstance(self._mind.activity, ANNOUNCED):
            return is_announced(self._mind)
        self._mind.warning = None
        return False

    def _note(self, command: DriveCommand) -> DriveCommand:
        """Keep in mind where the axes were told to go."""
        before = self._mind.setpoint
        self._mind.setpoint = AxisPair(
            _setpoint_deg(command.azimuth, before.azimuth_deg),
            _setpoint_deg(command.elevation, before.elevation_deg),
        )
        return command


def _step_by_order(
    mind: ControllerState, activity: Jogging | Moving | Measuring | Stowing | Stowed, feedback: Feedback
) -> Turn:
    match activity:
        case Jogging():
            return jogging.step(mind, activity, feedback)
        case Moving():
            return moving.step(mind, activity, feedback)
        case Measuring():
            return measuring.step(mind, activity, feedback)
        case Stowing() | Stowed():
            return stowing.step(mind, activity, feedback)
    assert_never(activity)


def _may_search(mind: ControllerState) -> bool:
    """Return whether the drive may still pursue its origin switches, as far as is known."""
    request = mind.command.request
    told = request is not None and request.kind is RequestKind.HOME
    return told or (mind.feedback is not None and mind.feedback.homing)


def _setpoint_deg(command: AxisCommand, before_deg: float | None) -> float | None:
    match command:
        case Position():
            return command.position_deg
        case Halt():
            return before_deg
        case _:
            return None


_BEGUN_ANEW = Reason(
    "operator_needed",
    "The controller restarted after an unexpected error.",
    "Press Stow, or Start tracking.",
)
_RESET_HINT = "Remove the cause, then reset the fault."
