"""A show on the machine: go to its start, run, pause, go on, and end by itself or early."""

from dataclasses import replace
from datetime import timedelta

from app.base.message import N_, Message, say
from app.tracker.access.interlocks import Action, demand, demand_drive, unmet
from app.tracker.activities.moving import not_arrived
from app.tracker.commands.commands import CommandRejected, GoToStart, RunShow
from app.tracker.programs.show import Course, ShowPlan, check_show, course_of
from app.tracker.state.activity import HOLDING, AxisPair, Run, Showing
from app.tracker.state.announce import announce_if_remote, begins_at, call_off
from app.tracker.state.axis_demand import paced
from app.tracker.state.controller_state import HALTED, ControllerState, Turn
from app.tracker.state.positioning import arrived, new_run
from app.tracker.state.snapshot import EventKind, ShowPhase
from app.tracker.state.transitions import begin, end_show, fail, hold, switch_tracking_off
from app.tracker.values.motion import DriveCommand, Feedback, Position
from app.tracker.values.reason import Reason

LONGEST_TICK = timedelta(seconds=2)
"""A show's own clock does not run on through a longer gap between two ticks."""


def go_to_start(state: ControllerState, command: GoToStart) -> None:
    """Move to where the panel stands at the start of a show, or raise `CommandRejected`."""
    feedback = demand_drive(state, Action.GO_TO_START)
    course = _course(state, command.plan)
    switch_tracking_off(state, N_("a show was commanded."))
    announce_if_remote(state, N_("The panel goes to the start of a show."))
    run = new_run(paced(state), feedback, _start(course), begins_at(state))
    begin(state, Showing(course, ShowPhase.GOING_TO_START, run, timedelta(0), state.now, state.actor))
    state.remember(show_moves=True)
    state.say(EventKind.MOVE_STARTED, N_("Going to the start of the show."), show_id=command.plan.show_id)


def run_show(state: ControllerState, command: RunShow) -> None:
    """Run a show from its start position, or raise `CommandRejected`."""
    course = _standing_course(state, command.plan)
    if course is None:
        reasons = unmet(state, Action.RUN_SHOW) or (_not_at_start(state),)
        raise CommandRejected(*reasons)
    switch_tracking_off(state, N_("a show was commanded."))
    announce_if_remote(state, N_("A show begins."))
    begin(state, Showing(course, ShowPhase.RUNNING, None, timedelta(0), begins_at(state), state.actor))
    state.remember(showing=command.plan.show_id, show_moves=True)
    state.say(EventKind.SHOW_STARTED, N_("The show has begun."), show_id=command.plan.show_id)


def pause_show(state: ControllerState) -> None:
    """Hold the show where it is, or raise `CommandRejected`."""
    demand(state, Action.PAUSE_SHOW)
    call_off(state)
    _change_phase(state, ShowPhase.PAUSED, EventKind.SHOW_PAUSED, N_("The show is paused."))


def resume_show(state: ControllerState) -> None:
    """Go on with a paused show, or raise `CommandRejected`."""
    demand(state, Action.RESUME_SHOW)
    announce_if_remote(state, N_("The show continues."))
    _change_phase(state, ShowPhase.RUNNING, EventKind.SHOW_RESUMED, N_("The show continues."))


def stop_show(state: ControllerState) -> None:
    """End a show before its time, or raise `CommandRejected`."""
    demand(state, Action.STOP_SHOW)
    if isinstance(state.activity, Showing):
        end_show(state, state.activity, N_("The show was stopped by the operator."), "stopped")
        hold(state)


def step(state: ControllerState, showing: Showing, feedback: Feedback) -> Turn:
    """Move the panel as the plan says for the time that has run; while it waits, hold."""
    match showing.phase:
        case ShowPhase.GOING_TO_START if showing.run is not None:
            return _going(state, showing, showing.run, feedback)
        case ShowPhase.RUNNING:
            return _running(state, showing)
        case _:
            seen = showing.course.at(showing.elapsed)
            return Turn(showing, HALTED, seen.target, seen.sun)


def _going(state: ControllerState, showing: Showing, run: Run, feedback: Feedback) -> Turn:
    seen = showing.course.at(timedelta(0))
    if arrived(run.target, feedback, state.config.in_position_deg):
        state.say(
            EventKind.MOVE_ENDED,
            N_("The panel is at the start of the show."),
            outcome="in_position",
            show_id=showing.course.plan.show_id,
        )
        state.remember(show_moves=False)
        return Turn(replace(showing, phase=ShowPhase.READY, run=None), HALTED, seen.target, seen.sun)
    if state.now >= run.until:
        fail(state, not_arrived(state))
        return Turn(state.activity)
    return Turn(showing, run.command, seen.target, seen.sun)


def _running(state: ControllerState, showing: Showing) -> Turn:
    elapsed = showing.elapsed + min(state.now - showing.at, LONGEST_TICK)
    seen = showing.course.at(elapsed)
    if elapsed >= showing.course.plan.duration:
        end_show(state, showing, N_("The show has run to its end."), "completed")
        hold(state)
        return Turn(HOLDING, HALTED, seen.target, seen.sun)
    config = state.config
    command = DriveCommand(
        Position(seen.axis_setpoint.azimuth_deg, config.azimuth.speed_dps),
        Position(seen.axis_setpoint.elevation_deg, config.elevation.speed_dps),
    )
    return Turn(replace(showing, elapsed=elapsed, at=state.now), command, seen.target, seen.sun)


def _course(state: ControllerState, plan: ShowPlan) -> Course:
    """Return the plan made ready for this tracker, or raise `CommandRejected` if it cannot be shown."""
    check = check_show(plan, state.config, state.memory.pointing)
    if check.reasons:
        raise CommandRejected(*check.reasons)
    return course_of(plan, state.config, state.memory.pointing)


def _standing_course(state: ControllerState, plan: ShowPlan) -> Course | None:
    """Return the course of a plan at whose start the panel stands ready; None: it does not."""
    activity = state.activity
    if isinstance(activity, Showing):
        ready = activity.phase is ShowPhase.READY and activity.course.plan == plan
        return activity.course if ready and not unmet(state, Action.RUN_SHOW) else None
    if unmet(state, Action.GO_TO_START) or activity is not HOLDING or state.feedback is None:
        return None
    course = _course(state, plan)
    return course if arrived(_start(course), state.feedback, state.config.in_position_deg) else None


def _change_phase(state: ControllerState, phase: ShowPhase, kind: EventKind, message: Message) -> None:
    if isinstance(state.activity, Showing):
        state.remember(show_moves=phase is ShowPhase.RUNNING)
        begin(state, replace(state.activity, phase=phase, at=begins_at(state)))
        state.say(kind, message, show_id=state.activity.course.plan.show_id)


def _start(course: Course) -> AxisPair:
    return AxisPair(course.start.azimuth_deg, course.start.elevation_deg)


def _not_at_start(state: ControllerState) -> Reason:
    return Reason(
        "not_at_start",
        say("{name} is not at the start of this show.", name=state.config.name),
        N_("Press Go to start position and wait until the panel is there."),
    )
