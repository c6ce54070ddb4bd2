"""Which command is whose: one call each, to the activity that begins with it."""

from typing import assert_never

from app.tracker.activities import (
    faulted,
    jogging,
    measuring,
    moving,
    proving,
    showing,
    stowing,
    tracking,
    zeroing,
)
from app.tracker.activity import STOPPING, Faulted, Showing
from app.tracker.authority import begin_service, confirm_clear, end_service
from app.tracker.commands import (
    BeginService,
    Command,
    CommandRejected,
    ConfirmClear,
    EndJog,
    EndService,
    GoToStart,
    Home,
    Jog,
    LockOut,
    MeasureLinkLoss,
    MeasureStop,
    Move,
    Park,
    PauseShow,
    ProveDirection,
    ProveScale,
    ReleaseLock,
    ResetFault,
    Resume,
    ResumeShow,
    RunShow,
    SelectMode,
    SetZero,
    Step,
    Stop,
    StopShow,
    Stow,
    Track,
    UndoZero,
)
from app.tracker.home_shift import undo_zero
from app.tracker.lockout import lock_out, release_lock
from app.tracker.mind import NOWHERE, Mind
from app.tracker.mounts.absent import absent_axis
from app.tracker.selection import select_mode
from app.tracker.snapshot import EventKind
from app.tracker.transitions import leave, switch_tracking_off


def obey(mind: Mind, command: Command) -> None:
    """Change the tracker's mind, or raise `CommandRejected` and change nothing but a refused press."""
    _refuse_absent_axis(mind, command)
    _hand_on(mind, command)
    if mind.memory.show_moves and not isinstance(mind.activity, Showing):
        mind.remember(show_moves=False)


def _hand_on(mind: Mind, command: Command) -> None:
    match command:
        case Stop():
            stop(mind)
        case Jog() | EndJog() | Step() | SetZero() | UndoZero() | Home() | SelectMode():
            _obey_by_hand(mind, command)
        case Move() | Park() | Track() | ResetFault():
            _obey_automatic(mind, command)
        case Stow() | Resume() | LockOut() | ReleaseLock():
            _obey_guard(mind, command)
        case BeginService() | ConfirmClear() | EndService():
            _obey_service(mind, command)
        case GoToStart() | RunShow() | PauseShow() | ResumeShow() | StopShow():
            _obey_show(mind, command)
        case ProveDirection() | ProveScale() | MeasureStop() | MeasureLinkLoss():
            _obey_proof(mind, command)
        case _:
            assert_never(command)


def stop(mind: Mind) -> None:
    """Stop both axes, end everything, switch tracking off. Never refused; a fault stays a fault."""
    switch_tracking_off(mind, "the tracker was stopped.")
    leave(mind, "the tracker was stopped.")
    mind.setpoint = NOWHERE
    if not isinstance(mind.activity, Faulted):
        mind.activity = STOPPING
    mind.say(EventKind.STOPPED, f"{mind.config.name} was stopped.")


def _refuse_absent_axis(mind: Mind, command: Command) -> None:
    """Raise `CommandRejected` for an axis that the mount does not have."""
    by_axis = Jog | Step | ProveDirection | ProveScale | MeasureStop | MeasureLinkLoss
    if isinstance(command, by_axis) and command.axis not in mind.config.mount.axes:
        raise CommandRejected(absent_axis(mind.config))


def _obey_by_hand(mind: Mind, command: Jog | EndJog | Step | SetZero | UndoZero | Home | SelectMode) -> None:
    match command:
        case Jog():
            jogging.jog(mind, command)
        case EndJog():
            jogging.end_jog(mind, command)
        case Step():
            moving.step_by(mind, command)
        case SetZero():
            zeroing.set_zero(mind, command)
        case UndoZero():
            undo_zero(mind)
        case Home():
            zeroing.home(mind)
        case SelectMode():
            select_mode(mind, command)
        case _:
            assert_never(command)


def _obey_automatic(mind: Mind, command: Move | Park | Track | ResetFault) -> None:
    match command:
        case Move():
            moving.move(mind, command)
        case Park():
            moving.park(mind)
        case Track():
            tracking.track(mind)
        case ResetFault():
            faulted.reset_fault(mind)
        case _:
            assert_never(command)


def _obey_guard(mind: Mind, command: Stow | Resume | LockOut | ReleaseLock) -> None:
    match command:
        case Stow():
            stowing.stow(mind, command)
        case Resume():
            stowing.resume(mind)
        case LockOut():
            lock_out(mind, command)
        case ReleaseLock():
            release_lock(mind)
        case _:
            assert_never(command)


def _obey_service(mind: Mind, command: BeginService | ConfirmClear | EndService) -> None:
    match command:
        case BeginService():
            begin_service(mind, command)
        case ConfirmClear():
            confirm_clear(mind)
        case EndService():
            end_service(mind)
        case _:
            assert_never(command)


def _obey_show(mind: Mind, command: GoToStart | RunShow | PauseShow | ResumeShow | StopShow) -> None:
    match command:
        case GoToStart():
            showing.go_to_start(mind, command)
        case RunShow():
            showing.run_show(mind, command)
        case PauseShow():
            showing.pause_show(mind)
        case ResumeShow():
            showing.resume_show(mind)
        case StopShow():
            showing.stop_show(mind)
        case _:
            assert_never(command)


def _obey_proof(mind: Mind, command: ProveDirection | ProveScale | MeasureStop | MeasureLinkLoss) -> None:
    match command:
        case ProveDirection():
            proving.prove_direction(mind, command)
        case ProveScale():
            proving.prove_scale(mind, command)
        case MeasureStop():
            measuring.measure_stop(mind, command)
        case MeasureLinkLoss():
            measuring.measure_link_loss(mind, command)
        case _:
            assert_never(command)
