"""Which command is whose: one call each, to the activity that begins with it."""

from typing import assert_never

from app.tracker.activities import (
    drive_testing,
    faulted,
    homing,
    jogging,
    measuring,
    moving,
    showing,
    stowing,
    tracking,
)
from app.tracker.activity import STOPPING, Faulted, Showing
from app.tracker.authority import begin_service_mode, confirm_area_clear, end_service_mode
from app.tracker.commands import (
    BeginServiceMode,
    Command,
    CommandRejected,
    ConfirmAreaClear,
    EndJog,
    EndServiceMode,
    GoToStart,
    Home,
    Jog,
    Move,
    Park,
    PauseShow,
    ReleaseInhibit,
    ResetFault,
    Resume,
    ResumeShow,
    RunCommunicationLossTest,
    RunDirectionTest,
    RunScaleTest,
    RunShow,
    RunStopTest,
    SelectMode,
    SetHome,
    SetInhibit,
    Step,
    Stop,
    StopShow,
    Stow,
    Track,
    UndoHome,
)
from app.tracker.controller_state import NOWHERE, ControllerState
from app.tracker.home_shift import undo_home
from app.tracker.maintenance_inhibit import release_inhibit, set_inhibit
from app.tracker.mounts.missing_axes import absent_axis
from app.tracker.selection import select_mode
from app.tracker.snapshot import EventKind
from app.tracker.transitions import leave, switch_tracking_off


def obey(mind: ControllerState, command: Command) -> None:
    """Change the tracker's mind, or raise `CommandRejected` and change nothing but a refused press."""
    _refuse_absent_axis(mind, command)
    _hand_on(mind, command)
    if mind.memory.show_moves and not isinstance(mind.activity, Showing):
        mind.remember(show_moves=False)


def _hand_on(mind: ControllerState, command: Command) -> None:
    match command:
        case Stop():
            stop(mind)
        case Jog() | EndJog() | Step() | SetHome() | UndoHome() | Home() | SelectMode():
            _obey_by_hand(mind, command)
        case Move() | Park() | Track() | ResetFault():
            _obey_automatic(mind, command)
        case Stow() | Resume() | SetInhibit() | ReleaseInhibit():
            _obey_guard(mind, command)
        case BeginServiceMode() | ConfirmAreaClear() | EndServiceMode():
            _obey_service(mind, command)
        case GoToStart() | RunShow() | PauseShow() | ResumeShow() | StopShow():
            _obey_show(mind, command)
        case RunDirectionTest() | RunScaleTest() | RunStopTest() | RunCommunicationLossTest():
            _obey_proof(mind, command)
        case _:
            assert_never(command)


def stop(mind: ControllerState) -> None:
    """Stop both axes, end everything, switch tracking off. Never refused; a fault stays a fault."""
    switch_tracking_off(mind, "the tracker was stopped.")
    leave(mind, "the tracker was stopped.")
    mind.setpoint = NOWHERE
    if not isinstance(mind.activity, Faulted):
        mind.activity = STOPPING
    mind.say(EventKind.STOPPED, f"{mind.config.name} was stopped.")


def _refuse_absent_axis(mind: ControllerState, command: Command) -> None:
    """Raise `CommandRejected` for an axis that the mount does not have."""
    by_axis = Jog | Step | RunDirectionTest | RunScaleTest | RunStopTest | RunCommunicationLossTest
    if isinstance(command, by_axis) and command.axis not in mind.config.mount.axes:
        raise CommandRejected(absent_axis(mind.config))


def _obey_by_hand(
    mind: ControllerState, command: Jog | EndJog | Step | SetHome | UndoHome | Home | SelectMode
) -> None:
    match command:
        case Jog():
            jogging.jog(mind, command)
        case EndJog():
            jogging.end_jog(mind, command)
        case Step():
            moving.step_by(mind, command)
        case SetHome():
            homing.set_home(mind, command)
        case UndoHome():
            undo_home(mind)
        case Home():
            homing.home(mind)
        case SelectMode():
            select_mode(mind, command)
        case _:
            assert_never(command)


def _obey_automatic(mind: ControllerState, command: Move | Park | Track | ResetFault) -> None:
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


def _obey_guard(mind: ControllerState, command: Stow | Resume | SetInhibit | ReleaseInhibit) -> None:
    match command:
        case Stow():
            stowing.stow(mind, command)
        case Resume():
            stowing.resume(mind)
        case SetInhibit():
            set_inhibit(mind, command)
        case ReleaseInhibit():
            release_inhibit(mind)
        case _:
            assert_never(command)


def _obey_service(
    mind: ControllerState, command: BeginServiceMode | ConfirmAreaClear | EndServiceMode
) -> None:
    match command:
        case BeginServiceMode():
            begin_service_mode(mind, command)
        case ConfirmAreaClear():
            confirm_area_clear(mind)
        case EndServiceMode():
            end_service_mode(mind)
        case _:
            assert_never(command)


def _obey_show(
    mind: ControllerState, command: GoToStart | RunShow | PauseShow | ResumeShow | StopShow
) -> None:
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


def _obey_proof(
    mind: ControllerState, command: RunDirectionTest | RunScaleTest | RunStopTest | RunCommunicationLossTest
) -> None:
    match command:
        case RunDirectionTest():
            drive_testing.test_direction(mind, command)
        case RunScaleTest():
            drive_testing.test_scale(mind, command)
        case RunStopTest():
            measuring.test_stop(mind, command)
        case RunCommunicationLossTest():
            measuring.test_communication_loss(mind, command)
        case _:
            assert_never(command)
