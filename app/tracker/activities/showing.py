"""A show on the machine: go to its start, run, pause, go on, and end by itself or early."""

from dataclasses import replace
from datetime import timedelta

from app.tracker.activities.moving import not_arrived
from app.tracker.activity import HOLDING, AxisPair, Run, Showing
from app.tracker.announce import announce_if_remote, begins_at
from app.tracker.axis_demand import paced
from app.tracker.commands import CommandRejected, GoToStart, RunShow
from app.tracker.controller_state import HALTED, ControllerState, Turn
from app.tracker.interlocks import Action, demand, demand_drive, unmet
from app.tracker.motion import DriveCommand, Feedback, Position
from app.tracker.positioning import arrived, new_run
from app.tracker.programs.show import Course, ShowPlan, check_show, course_of
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind, ShowPhase
from app.tracker.transitions import end_show, fail, switch_tracking_off

LONGEST_TICK = timedelta(seconds=2)
"""A show's own clock does not run on through a longer gap between two ticks."""


def go_to_start(mind: ControllerState, command: GoToStart) -> None:
    """Move to where the panel stands at the start of a show, or raise `CommandRejected`."""
    feedback = demand_drive(mind, Action.GO_TO_START)
    course = _course(mind, command.plan)
    switch_tracking_off(mind, "a show was commanded.")
    announce_if_remote(mind, "The panel goes to the start of a show.")
    run = new_run(paced(mind), feedback, _start(course), begins_at(mind))
    mind.activity = Showing(course, ShowPhase.GOING_TO_START, run, timedelta(0), mind.now, mind.actor)
    mind.remember(show_moves=True)
    mind.say(EventKind.MOVE_STARTED, "Going to the start of the show.", show_id=command.plan.show_id)


def run_show(mind: ControllerState, command: RunShow) -> None:
    """Run a show from its start position, or raise `CommandRejected`."""
    course = _standing_course(mind, command.plan)
    if course is None:
        reasons = unmet(mind, Action.RUN_SHOW) or (_not_at_start(mind),)
        raise CommandRejected(*reasons)
    switch_tracking_off(mind, "a show was commanded.")
    announce_if_remote(mind, "A show begins.")
    mind.activity = Showing(course, ShowPhase.RUNNING, None, timedelta(0), begins_at(mind), mind.actor)
    mind.remember(showing=command.plan.show_id, show_moves=True)
    mind.say(EventKind.SHOW_STARTED, "The show has begun.", show_id=command.plan.show_id)


def pause_show(mind: ControllerState) -> None:
    """Hold the show where it is, or raise `CommandRejected`."""
    demand(mind, Action.PAUSE_SHOW)
    mind.warning = None
    _change_phase(mind, ShowPhase.PAUSED, EventKind.SHOW_PAUSED, "The show is paused.")


def resume_show(mind: ControllerState) -> None:
    """Go on with a paused show, or raise `CommandRejected`."""
    demand(mind, Action.RESUME_SHOW)
    announce_if_remote(mind, "The show continues.")
    _change_phase(mind, ShowPhase.RUNNING, EventKind.SHOW_RESUMED, "The show continues.")


def stop_show(mind: ControllerState) -> None:
    """End a show before its time, or raise `CommandRejected`."""
    demand(mind, Action.STOP_SHOW)
    if isinstance(mind.activity, Showing):
        end_show(mind, mind.activity, "The show was stopped by the operator.", "stopped")
        mind.activity = HOLDING


def step(mind: ControllerState, showing: Showing, feedback: Feedback) -> Turn:
    """Move the panel as the plan says for the time that has run; while it waits, hold."""
    match showing.phase:
        case ShowPhase.GOING_TO_START if showing.run is not None:
            return _going(mind, showing, showing.run, feedback)
        case ShowPhase.RUNNING:
            return _running(mind, showing)
        case _:
            seen = showing.course.at(showing.elapsed)
            return Turn(showing, HALTED, seen.target, seen.sun)


def _going(mind: ControllerState, showing: Showing, run: Run, feedback: Feedback) -> Turn:
    seen = showing.course.at(timedelta(0))
    if arrived(run.target, feedback, mind.config.in_position_deg):
        mind.say(
            EventKind.MOVE_ENDED,
            "The panel is at the start of the show.",
            outcome="in_position",
            show_id=showing.course.plan.show_id,
        )
        mind.remember(show_moves=False)
        return Turn(replace(showing, phase=ShowPhase.READY, run=None), HALTED, seen.target, seen.sun)
    if mind.now >= run.until:
        fail(mind, not_arrived(mind))
        return Turn(mind.activity)
    return Turn(showing, run.command, seen.target, seen.sun)


def _running(mind: ControllerState, showing: Showing) -> Turn:
    elapsed = showing.elapsed + min(mind.now - showing.at, LONGEST_TICK)
    seen = showing.course.at(elapsed)
    if elapsed >= showing.course.plan.duration:
        end_show(mind, showing, "The show has run to its end.", "completed")
        mind.activity = HOLDING
        return Turn(HOLDING, HALTED, seen.target, seen.sun)
    config = mind.config
    command = DriveCommand(
        Position(seen.axis_setpoint.azimuth_deg, config.azimuth.speed_dps),
        Position(seen.axis_setpoint.elevation_deg, config.elevation.speed_dps),
    )
    return Turn(replace(showing, elapsed=elapsed, at=mind.now), command, seen.target, seen.sun)


def _course(mind: ControllerState, plan: ShowPlan) -> Course:
    """Return the plan made ready for this tracker, or raise `CommandRejected` if it cannot be shown."""
    check = check_show(plan, mind.config, mind.memory.pointing)
    if check.reasons:
        raise CommandRejected(*check.reasons)
    return course_of(plan, mind.config, mind.memory.pointing)


def _standing_course(mind: ControllerState, plan: ShowPlan) -> Course | None:
    """Return the course of a plan at whose start the panel stands ready; None: it does not."""
    activity = mind.activity
    if isinstance(activity, Showing):
        ready = activity.phase is ShowPhase.READY and activity.course.plan == plan
        return activity.course if ready and not unmet(mind, Action.RUN_SHOW) else None
    if unmet(mind, Action.GO_TO_START) or activity is not HOLDING or mind.feedback is None:
        return None
    course = _course(mind, plan)
    return course if arrived(_start(course), mind.feedback, mind.config.in_position_deg) else None


def _change_phase(mind: ControllerState, phase: ShowPhase, kind: EventKind, message: str) -> None:
    if isinstance(mind.activity, Showing):
        mind.remember(show_moves=phase is ShowPhase.RUNNING)
        mind.activity = replace(mind.activity, phase=phase, at=begins_at(mind))
        mind.say(kind, message, show_id=mind.activity.course.plan.show_id)


def _start(course: Course) -> AxisPair:
    return AxisPair(course.start.azimuth_deg, course.start.elevation_deg)


def _not_at_start(mind: ControllerState) -> Reason:
    return Reason(
        "not_at_start",
        f"{mind.config.name} is not at the start of this show.",
        "Press Go to start position and wait until the panel is there.",
    )
