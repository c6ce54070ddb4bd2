"""How far a tracker is in its step program."""

from app.tracker.programs.schedule import Moment, hour_of
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Stepped
from app.tracker.state.activity import Showing, Tracking
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import StepProgress


def step_progress(state: ControllerState) -> StepProgress | None:
    """Return which step is held and when the next one comes; None while no program is followed."""
    found = _followed(state)
    if found is None:
        return None
    program, moment = found
    hour = hour_of(program, moment)
    index = program.index_at(hour)
    step = program.steps[index]
    return StepProgress(
        name=program.name,
        time_base=program.time_base.value,
        frame=program.frame.value,
        hour=hour,
        step=index + 1,
        steps=len(program.steps),
        from_h=step.from_h,
        next_h=program.next_h(hour),
        first_deg=step.first_deg,
        second_deg=step.second_deg,
    )


def _followed(state: ControllerState) -> tuple[StepProgram, Moment] | None:
    sun, seen = state.sun, state.seen
    strategy = state.config.strategy
    if sun is None or seen is None or seen.location is None:
        return None
    if isinstance(state.activity, Tracking) and isinstance(strategy, Stepped):
        return strategy.program, Moment(seen.site_time, sun, seen.location)
    if isinstance(state.activity, Showing):
        plan = state.activity.course.plan
        if isinstance(plan.schedule, Stepped):
            at = plan.sun_time(state.activity.elapsed)
            return plan.schedule.program, Moment(at, sun, plan.location)
    return None
