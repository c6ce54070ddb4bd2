"""What pages and API ask about strategies alike: a day by any of them, and programs kept by a tracker."""

from dataclasses import dataclass, replace
from datetime import datetime

from app.base.message import say
from app.base.startup import late
from app.link.messages import TrackerDetail
from app.show.strategy_told import StrategyDay
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.capabilities import default_mode
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Stepped, Strategy
from app.tracker.values.mode import Mode
from app.web.http.errors import NotFound


@dataclass(frozen=True, slots=True)
class DayQuestion:
    """One day of one tracker by one strategy, from `begin` to `end`."""

    config: TrackerConfig
    pointing: Pointing
    location: Location
    mode: Mode
    held: Orientation
    begin: datetime
    end: datetime


def asked_day(
    tracker: TrackerDetail, strategy: Strategy, location: Location, begin: datetime, end: datetime
) -> DayQuestion:
    """Return the question for a tracker with another strategy; a fixed panel is asked with all axes free."""
    memory = tracker.state.memory
    config = replace(tracker.state.config, strategy=strategy)
    mode = default_mode(config.mount) if memory.mode in (None, Mode.FIXED) else memory.mode
    return DayQuestion(config, memory.pointing, location, mode, memory.orientation, begin, end)


def day_of(question: DayQuestion) -> StrategyDay:
    """Return what the tracker does that day, in the worker; raises `ValueError` for what cannot be."""
    told: StrategyDay = late("app.show.strategy_day").strategy_day(
        question.config,
        question.pointing,
        question.location,
        question.mode,
        question.held,
        question.begin,
        question.end,
    )
    return told


def kept_program(tracker: TrackerDetail) -> StepProgram:
    """Return the step program that a tracker follows, or raise `NotFound`."""
    config = tracker.state.config
    if not isinstance(config.strategy, Stepped):
        raise NotFound(say("{name} does not follow a step program.", name=config.name))
    return config.strategy.program
