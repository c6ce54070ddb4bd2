"""The five steps: done, to do or to be confirmed, each with its reasons."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from app.tracker.memory import StepName
from app.tracker.reason import Reason


class StepStatus(StrEnum):
    """Where a step stands."""

    TO_DO = "to_do"
    TO_BE_CONFIRMED = "to_be_confirmed"
    DONE = "done"


@dataclass(frozen=True, slots=True)
class Step:
    """One of the five steps as the wizard and the API show it."""

    name: StepName
    status: StepStatus
    reasons: tuple[Reason, ...]
    confirmed_at: datetime | None
    confirmed_by: str
