"""A show: a stretch of any day, run accelerated on the real machine."""

from app.base.message import N_
from app.tracker.memory.memory import Pointing
from app.tracker.programs.plan import ShowCheck, ShowPath, ShowPlan
from app.tracker.programs.schedule_check import check_schedule
from app.tracker.programs.schedule_course import ScheduleCourse
from app.tracker.programs.show_check import check_show as check_smooth
from app.tracker.programs.trajectory import ShowAim, ShowCourse
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.strategy import Interval, Schedule, Stepped, Strategy
from app.tracker.values.mode import Mode

__all__ = [
    N_("Course"),
    "ShowAim",
    "ShowCheck",
    "ShowCourse",
    "ShowPath",
    "ShowPlan",
    "check_show",
    "course_of",
    "schedule_of",
]

Course = ShowCourse | ScheduleCourse


def schedule_of(strategy: Strategy) -> Schedule | None:
    """Return what of a tracker's strategy a show follows: a schedule; any other is shown smoothly."""
    return strategy if isinstance(strategy, Interval | Stepped) else None


def check_show(plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing = Pointing()) -> ShowCheck:
    """Return what the plan needs of this tracker, every reason against it, and the shortest duration."""
    if plan.schedule is None or plan.mode is Mode.FIXED:
        return check_smooth(plan, tracker, pointing)
    return check_schedule(plan, plan.schedule, tracker, pointing)


def course_of(plan: ShowPlan, tracker: TrackerConfig, pointing: Pointing = Pointing()) -> Course:
    """Return the plan made ready for one tracker."""
    if plan.schedule is None or plan.mode is Mode.FIXED:
        return ShowCourse(plan, tracker, pointing)
    return ScheduleCourse(plan, plan.schedule, tracker, pointing)
