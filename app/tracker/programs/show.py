"""A show: a stretch of any day, run accelerated on the real machine."""

from app.tracker.programs.course import ShowAim, ShowCourse
from app.tracker.programs.plan import ShowCheck, ShowPath, ShowPlan
from app.tracker.programs.show_check import check_show

__all__ = ["ShowAim", "ShowCheck", "ShowCourse", "ShowPath", "ShowPlan", "check_show"]
