"""Which command is whose: one look-up, of the function that begins what it asks for."""

from collections.abc import Callable
from typing import Any, TypeVar

from app.base.message import N_, say
from app.tracker.access.authority import begin_service_mode, confirm_area_clear, end_service_mode
from app.tracker.access.maintenance_inhibit import release_inhibit, set_inhibit
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
from app.tracker.commands.commands import (
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
from app.tracker.commissioning.selection import select_mode
from app.tracker.mounts.missing_axes import absent_axis
from app.tracker.state import transitions
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import EventKind
from app.tracker.supervision.home_shift import undo_home

Asked = TypeVar("Asked", bound=Command)
Handler = Callable[[ControllerState, Any], None]
BY_AXIS = (Jog, Step, RunDirectionTest, RunScaleTest, RunStopTest, RunCommunicationLossTest)


def stop(state: ControllerState) -> None:
    """Stop both axes, end everything, switch tracking off. Never refused; a fault stays a fault."""
    transitions.stop(state, N_("the tracker was stopped."))
    state.say(EventKind.STOPPED, say("{name} was stopped.", name=state.config.name))


def refuse_absent_axis(state: ControllerState, command: Command) -> None:
    """Raise `CommandRejected` for an axis that the mount does not have."""
    if isinstance(command, BY_AXIS) and command.axis not in state.config.mount.axes:
        raise CommandRejected(absent_axis(state.config))


def _given(
    kind: type[Asked], do: Callable[[ControllerState, Asked], None]
) -> tuple[type[Asked], Callable[[ControllerState, Asked], None]]:
    """Return an entry whose function takes the command's values."""
    return kind, do


def _plain(kind: type[Asked], do: Callable[[ControllerState], None]) -> tuple[type[Asked], Handler]:
    """Return an entry for a command without values."""
    return kind, lambda state, _: do(state)


HANDLERS: dict[type[Command], Handler] = dict(
    (
        _plain(Stop, stop),
        _given(Jog, jogging.jog),
        _given(EndJog, jogging.end_jog),
        _given(Step, moving.step_by),
        _given(SetHome, homing.set_home),
        _plain(UndoHome, undo_home),
        _plain(Home, homing.home),
        _given(SelectMode, select_mode),
        _given(Move, moving.move),
        _plain(Park, moving.park),
        _plain(Track, tracking.track),
        _plain(ResetFault, faulted.reset_fault),
        _given(Stow, stowing.stow),
        _plain(Resume, stowing.resume),
        _given(SetInhibit, set_inhibit),
        _plain(ReleaseInhibit, release_inhibit),
        _given(BeginServiceMode, begin_service_mode),
        _plain(ConfirmAreaClear, confirm_area_clear),
        _plain(EndServiceMode, end_service_mode),
        _given(GoToStart, showing.go_to_start),
        _given(RunShow, showing.run_show),
        _plain(PauseShow, showing.pause_show),
        _plain(ResumeShow, showing.resume_show),
        _plain(StopShow, showing.stop_show),
        _given(RunDirectionTest, drive_testing.test_direction),
        _given(RunScaleTest, drive_testing.test_scale),
        _given(RunStopTest, measuring.test_stop),
        _given(RunCommunicationLossTest, measuring.test_communication_loss),
    )
)
"""What every command begins; each changes the controller's state or raises `CommandRejected`."""
