"""One tracker's state: `handle` and `tick` are the two ways in."""

from dataclasses import replace
from datetime import datetime, timedelta
from typing import NamedTuple, assert_never

from app.base.message import N_
from app.tracker.access.authority import watch_local, watch_service
from app.tracker.access.continuing import goes_on
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
from app.tracker.activities.approach import has_reached
from app.tracker.commands.commands import Command
from app.tracker.commissioning.steps import Standing
from app.tracker.memory.drive_tests import Proofs
from app.tracker.memory.memory import (
    CommissioningLock,
    Confirmation,
    Pointing,
    Sighting,
    StepName,
    TrackerMemory,
)
from app.tracker.memory.observation import Observation
from app.tracker.mounts.missing_axes import as_mounted, for_drive
from app.tracker.mounts.mount import upright
from app.tracker.orders import HANDLERS, refuse_absent_axis
from app.tracker.recovery import recover
from app.tracker.report import report
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.activity import (
    HOLDING,
    NAMES,
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
from app.tracker.state.announce import call_off, is_announced
from app.tracker.state.controller_state import HALTED, STANDING, ControllerState, Turn
from app.tracker.state.home_trust import give_up_search, lose_home
from app.tracker.state.positioning import at_rest
from app.tracker.state.setpoints import forget_correction, forget_setpoints, note_setpoint
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Snapshot
from app.tracker.state.transitions import begin, leave
from app.tracker.state.waiting import wait_for
from app.tracker.supervision.home_shift import forget
from app.tracker.supervision.machine_guard import is_silent, watch_machine
from app.tracker.supervision.protect import (
    check_following,
    forget_aftermath,
    forget_following,
    found,
    miss,
    obey_switches,
    protect,
)
from app.tracker.supervision.regions import bar
from app.tracker.supervision.weather_protection import guarding, look
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.motion import (
    DriveCapabilities,
    DriveCommand,
    Feedback,
    RequestKind,
)
from app.tracker.values.reason import Reason

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
        self._state = ControllerState(config, memory, capabilities)
        self._resumes = resumes
        if not resumes and (memory.stow is not None or memory.show_moves):
            wait_for(self._state, _BEGUN_ANEW)
        if memory.fault_code is not None:
            begin(self._state, Faulted(Reason(memory.fault_code, memory.fault_text, _RESET_HINT)))

    @property
    def config(self) -> TrackerConfig:
        """Return what the engineer set."""
        return self._state.config

    @property
    def memory(self) -> TrackerMemory:
        """Return what must survive a power cut; a new object whenever it changed."""
        return self._state.memory

    @property
    def activity(self) -> ActivityName:
        """Return what the tracker is doing."""
        return NAMES[type(self._state.activity)]

    @property
    def is_silent(self) -> bool:
        """Return whether the drive is to be told nothing at all, so that its watchdog is not fed."""
        return is_silent(self._state)

    def handle(
        self, command: Command, now: datetime, actor: str = "operator", via: str = ""
    ) -> tuple[Event, ...]:
        """Obey a command and return what happened, or raise `CommandRejected` with all unmet conditions.

        `now` is the machine's steady time, as in `Observation.now`. The drive hears of it at the next tick.
        `via` is how whoever ordered was known, as in `Order`: what a program starts is announced.
        """
        state = self._state
        state.site_time = state.seen.site_time + (now - state.seen.now) if state.seen else now
        state.now, state.actor, state.via = now, actor, via
        refuse_absent_axis(state, command)
        HANDLERS[type(command)](state, command)
        if state.memory.show_moves and not isinstance(state.activity, Showing):
            state.remember(show_moves=False)
        forget_aftermath(state)
        return state.drain()

    def tick(self, seen: Observation) -> Tick:
        """Return what the drive shall do from now on and what happened since the last tick."""
        state = self._state
        if state.config.mount.single_axis:
            seen = seen._replace(feedback=as_mounted(state.config, seen.feedback))
        state.now, state.site_time, state.seen, state.actor = seen.now, seen.site_time, seen, CONTROLLER
        state.via = ""
        state.ticks += 1
        if state.started_at is None:
            self._start(seen.now)
        look(state, seen)
        command = self._blind(seen) if seen.feedback is None else self._see(seen, seen.feedback)
        state.command = command = for_drive(state.config, command)
        if state.alarmed is not None or guarding(state).stow is not None:
            self._note_not_stowed()
        horn = state.countdowns.motion is not None and state.feedback is not None
        return Tick(replace(command, horn=True) if horn else command, state.drain())

    def snapshot(self, at: datetime, now: datetime | None = None, *, asked: bool = True) -> Snapshot:
        """Return everything known after the last tick, stamped `at`.

        `now` is the machine's steady time, to which ages are counted; without it, that of the last tick.
        Unless `asked`, `actions` are left out.
        """
        return report.snapshot(self._state, at, now or self._state.now, asked=asked)

    @property
    def continues(self) -> bool:
        """Return whether tracking goes on with nobody asked."""
        return goes_on(self._state)

    @property
    def standing(self) -> Standing:
        """Return what the five steps go by of how the tracker stands."""
        return report.standing(self._state)

    def frame(self) -> tuple[float, ...]:
        """Return the last tick as one row of `recording.COLUMNS`; the first two columns are NaN."""
        return report.frame(self._state)

    def deadline(self) -> datetime | None:
        """Return the instant by which `tick` must be called again, else None.

        That is when a jog's lease ends, and soon again while it is measured how an axis comes to rest.
        """
        activity = self._state.activity
        if isinstance(activity, Measuring) and activity.asked is not None:
            return self._state.now + measuring.LOOK_EVERY
        return activity.until if isinstance(activity, Jogging) else None

    def configure(self, config: TrackerConfig, capabilities: DriveCapabilities) -> None:
        """Take over a new configuration; the caller sees to it that the tracker stands still.

        Another drive is another zero: trust in the old one is lost.
        """
        state = self._state
        leave(state, N_("the configuration was changed."))
        if config.drive != state.config.drive:
            state.feedback = state.feedback_at = None
            lose_home(state, Reason("drive_changed", N_("another drive was configured.")))
            forget(state)
        state.config, state.capabilities = config, capabilities
        forget_setpoints(state)
        forget_following(state)
        state.target = None
        if state.memory.rejected:
            state.remember(rejected=())

    def know(self, capabilities: DriveCapabilities) -> None:
        """Take over what the drive is able to do as it was read last: its watchdog may be off, or another."""
        if capabilities != self._state.capabilities:
            self._state.capabilities = capabilities

    def set_pointing(self, pointing: Pointing) -> None:
        """Take over a correction from sightings; what the light sensors found goes with the old one."""
        self._state.remember(pointing=pointing)
        forget_correction(self._state)

    def confirm(self, step: StepName, confirmation: Confirmation) -> None:
        """Remember that the operator said a step is right."""
        confirmations = {**self._state.memory.confirmations, step: confirmation}
        self._state.remember(confirmations=confirmations)

    def set_proofs(self, proofs: Proofs) -> None:
        """Take over what somebody said about the drive."""
        self._state.remember(proofs=proofs)

    def set_control_epoch(self, epoch: int) -> None:
        """Remember the newest epoch of control, so that no later life gives it again."""
        self._state.remember(control_epoch=epoch)

    def set_settings_lock(self, lock: CommissioningLock | None) -> None:
        """Take over who locked the settings, None where nobody did."""
        self._state.remember(settings_lock=lock)

    def set_sightings(self, sightings: tuple[Sighting, ...]) -> None:
        """Keep these sightings and forget all others."""
        self._state.remember(sightings=sightings)

    def _start(self, now: datetime) -> None:
        state = self._state
        state.started_at = now
        give_up_search(state)
        if state.memory.showing is not None:
            show_id = state.memory.showing
            state.remember(showing=None)
            message = N_("The show was interrupted: the controller restarted.")
            state.say(EventKind.SHOW_ENDED, message, outcome="interrupted", show_id=show_id)

    def _blind(self, seen: Observation) -> DriveCommand:
        """Go on for one failed reading, then stop: absence of information is a reason to stop."""
        state = self._state
        miss(state, seen.now, seen.silence)
        state.sun = seen.sun
        if isinstance(state.activity, Jogging) and seen.now >= state.activity.until:
            jogging.end(state, state.activity, N_("the jog command was not renewed in time."), "expired")
        if state.connection.lost or isinstance(state.activity, Holding | Stopping | Faulted | Stowed):
            return STANDING if state.command is STANDING or _may_search(state) else HALTED
        return state.command

    def _see(self, seen: Observation, feedback: Feedback) -> DriveCommand:
        state = self._state
        before, before_at = state.feedback, state.feedback_at
        if state.connection.misses:
            found(state, feedback)
        state.feedback, state.feedback_at = feedback, seen.now
        watch_local(state, before, feedback)
        protect(state, before, feedback, seen.now - (before_at or seen.now))
        watch_service(state)
        watch_machine(state, before, feedback)
        if state.watches or state.command is not HALTED:
            check_following(state, feedback, seen.now)
        if before is None and state.started_at is not None and seen.now - state.started_at <= RESUME_WITHIN:
            self._first_reading()
        recover(state, feedback)
        stowing.guard(state, feedback)
        turn = self._step(feedback, seen)
        state.reached = has_reached(state, turn, feedback)
        if turn.activity is not state.activity:
            begin(state, turn.activity)
        state.target = upright(turn.target)
        state.sun = seen.sun if turn.sun is None else turn.sun
        if turn.command is HALTED:
            return STANDING if feedback.homing and not isinstance(turn.activity, Homing) else HALTED
        command = bar(state, obey_switches(state, turn.command, feedback), feedback)
        note_setpoint(state, command)
        return command

    def _first_reading(self) -> None:
        """Decide once whether tracking goes on after a restart."""
        if self._resumes and isinstance(self._state.activity, Holding | Faulted):
            tracking.resume(self._state)

    def _note_not_stowed(self) -> None:
        """Say once that the panel is not stowed though it should be, and remember why."""
        state = self._state
        before, state.alarmed = state.alarmed, stowing.not_stowed(state)
        if state.alarmed is not None and before is None:
            state.say(EventKind.NOT_STOWED, state.alarmed.message, hint=state.alarmed.hint)

    def _step(self, feedback: Feedback, seen: Observation) -> Turn:
        """Return the activity's turn; a motion that is being announced waits."""
        state = self._state
        if state.countdowns.motion is not None and self._waits():
            return Turn(state.activity, HALTED, state.target, seen.sun)
        activity = state.activity
        match activity:
            case Tracking():
                return tracking.step(state, activity, feedback, seen)
            case Holding() | Stopping():
                return Turn(HOLDING if at_rest(feedback) else activity)
            case Showing():
                return showing.step(state, activity, feedback)
            case Jogging() | Moving() | Measuring() | Stowing() | Stowed():
                return _step_by_order(state, activity, feedback)
            case SettingHome() | Homing():
                return homing.step(state, activity, feedback)
            case Faulted():
                return faulted.step(state, activity, feedback)
        assert_never(activity)

    def _waits(self) -> bool:
        """Return whether the motion is still being announced; what does not move needs no warning."""
        if isinstance(self._state.activity, ANNOUNCED):
            return is_announced(self._state)
        call_off(self._state)
        return False


def _step_by_order(
    state: ControllerState, activity: Jogging | Moving | Measuring | Stowing | Stowed, feedback: Feedback
) -> Turn:
    match activity:
        case Jogging():
            return jogging.step(state, activity, feedback)
        case Moving():
            return moving.step(state, activity, feedback)
        case Measuring():
            return measuring.step(state, activity, feedback)
        case Stowing() | Stowed():
            return stowing.step(state, activity, feedback)
    assert_never(activity)


def _may_search(state: ControllerState) -> bool:
    """Return whether the drive may still pursue its origin switches, as far as is known."""
    request = state.command.request
    told = request is not None and request.kind is RequestKind.HOME
    return told or (state.feedback is not None and state.feedback.homing)


_BEGUN_ANEW = Reason(
    "operator_needed",
    N_("The controller restarted after an unexpected error."),
    N_("Press Stow, or Start tracking."),
)
_RESET_HINT = N_("Remove the cause, then reset the fault.")
