"""A home position that was set by mistake is undone: what the drive counts from its zero is shifted back.

A drive forgets its former zero when it is told a new one. What it read just before is remembered instead, and
added to what it reads from then on, until the next zero or another drive.
"""

from dataclasses import replace

from app.base.message import N_
from app.tracker.access.interlocks import Action, demand_drive
from app.tracker.memory.memory import Confirmation, FormerHome, HomeShift, StepName
from app.tracker.motion.guards import axis_feedback
from app.tracker.settings.axes import Axis
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.home_trust import set_homed
from app.tracker.state.setpoints import forget_setpoints
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import hold
from app.tracker.supervision.machine_guard import forget_guards
from app.tracker.supervision.protect import forget_following
from app.tracker.values.motion import AxisCommand, AxisFeedback, DriveCommand, Feedback, Position

UNSHIFTED = HomeShift()


def shifted(shift: HomeShift, feedback: Feedback | None) -> Feedback | None:
    """Return a reading of the drive as one from the home position; as it is without a shift."""
    if feedback is None or shift == UNSHIFTED:
        return feedback
    return replace(
        feedback,
        azimuth=_seen(feedback.azimuth, shift.azimuth_deg),
        elevation=_seen(feedback.elevation, shift.elevation_deg),
    )


def unshifted(shift: HomeShift, command: DriveCommand) -> DriveCommand:
    """Return a command from the home position as one of the drive; as it is without a shift."""
    if shift == UNSHIFTED:
        return command
    return replace(
        command,
        azimuth=_told(command.azimuth, shift.azimuth_deg),
        elevation=_told(command.elevation, shift.elevation_deg),
    )


def _seen(seen: AxisFeedback, by_deg: float) -> AxisFeedback:
    return replace(seen, position_deg=seen.position_deg + by_deg)


def _told(told: AxisCommand, by_deg: float) -> AxisCommand:
    return replace(told, position_deg=told.position_deg - by_deg) if isinstance(told, Position) else told


def keep_former(state: ControllerState, axes: tuple[Axis, ...]) -> None:
    """Remember the home position that is about to be replaced, and count from the drive's own zero."""
    memory, feedback = state.memory, state.feedback
    if feedback is None:
        return
    read = {axis: axis_feedback(feedback, axis).position_deg for axis in axes}
    shift = memory.home_shift
    former = FormerHome(
        axes=axes,
        shift=HomeShift(
            read.get(Axis.AZIMUTH, shift.azimuth_deg), read.get(Axis.ELEVATION, shift.elevation_deg)
        ),
        boot_count=feedback.boot_count,
        home=memory.home,
        home_lost=memory.home_lost,
        home_lost_at=memory.home_lost_at,
        zeroed=tuple(state.zeroed),
        confirmation=memory.confirmations.get(StepName.HOMING),
    )
    state.remember(
        former_home=former,
        home_shift=HomeShift(
            0.0 if Axis.AZIMUTH in axes else shift.azimuth_deg,
            0.0 if Axis.ELEVATION in axes else shift.elevation_deg,
        ),
    )


def forget(state: ControllerState) -> None:
    """Count from the drive's own zero, and know no former home position."""
    state.remember(former_home=None, home_shift=UNSHIFTED)


def undo_home(state: ControllerState) -> None:
    """Bring back the home position as it was before it was set last, or raise `CommandRejected`."""
    feedback = demand_drive(state, Action.UNDO_HOME)
    former, shift = state.memory.former_home, state.memory.home_shift
    if former is None:
        return
    by = HomeShift(
        former.shift.azimuth_deg - shift.azimuth_deg, former.shift.elevation_deg - shift.elevation_deg
    )
    state.shift_reading(shifted(by, feedback))
    set_homed(state, frozenset(former.zeroed))
    forget_setpoints(state)
    forget_guards(state)
    forget_following(state)
    hold(state)
    state.remember(
        home_shift=former.shift,
        former_home=None,
        home=former.home,
        home_lost=former.home_lost,
        home_lost_at=former.home_lost_at,
        confirmations=_confirmations(state, former),
    )
    state.say(EventKind.HOME_POSITION_UNDONE, N_("The previous home position is in use again."))


def is_undone(state: ControllerState) -> bool:
    """Return whether the drive counts from a zero that was undone, with no trusted one before it."""
    return state.memory.home is None and state.memory.home_shift != UNSHIFTED


def _confirmations(state: ControllerState, former: FormerHome) -> dict[StepName, Confirmation]:
    confirmations = dict(state.memory.confirmations)
    confirmations.pop(StepName.HOMING, None)
    if former.confirmation is not None:
        confirmations[StepName.HOMING] = former.confirmation
    return confirmations
