"""The words of control authority: who may move a tracker now, and who wants to."""

from dataclasses import dataclass
from datetime import datetime

from app.tracker.commands.commands import CommandRejected
from app.tracker.values.reason import Reason

PROGRAMS = frozenset({"token", "sunspec", "mqtt"})
"""How programs are known; everything else is a person."""
PROGRAM_RANK = -1


class ControlHeld(CommandRejected):
    """Somebody else has control of the tracker; the reasons name them and say how to ask."""


class ControlLost(CommandRejected):
    """The order was given under a control that has ended since; it is not carried out any more."""


CONTROL_HELD, CONTROL_LOST = "control_held", "control_lost"


def refusal(*reasons: Reason) -> CommandRejected:
    """Return the error for these reasons: `ControlHeld` or `ControlLost` where one is about control."""
    codes = {reason.code for reason in reasons}
    if CONTROL_LOST in codes:
        return ControlLost(*reasons)
    return ControlHeld(*reasons) if CONTROL_HELD in codes else CommandRejected(*reasons)


@dataclass(frozen=True, slots=True)
class Holder:
    """Somebody who has control or wants it: their name, how they are known, their rank among people."""

    name: str
    via: str
    rank: int = 0

    @property
    def is_person(self) -> bool:
        """Return whether this is not a program."""
        return self.via not in PROGRAMS

    @property
    def weight(self) -> int:
        """Return whose word counts more: 2 an engineer, 1 an operator, below all people programs."""
        return self.rank if self.is_person else PROGRAM_RANK

    def is_same(self, other: "Holder") -> bool:
        """Return whether both are the same person or program, on whatever page."""
        return (self.name, self.via) == (other.name, other.via)


@dataclass(frozen=True, slots=True)
class ControlRequest:
    """Somebody wants control: `takes` it at `until`, or only asks and waits until then; site time."""

    by: str
    via: str
    takes: bool
    reason: str
    until: datetime
    can_be_refused: bool


@dataclass(frozen=True, slots=True)
class ControlState:
    """Who has control of a tracker (None: nobody), since when and, unless renewed, until when; site time.

    `epoch` is the number that orders carry: it grows with every change and never comes back. `is_silent`
    says that the holder has not been heard for 5 s; `is_program` that the holder is no person.
    """

    epoch: int
    holder: str | None = None
    via: str = ""
    rank: int = 0
    is_program: bool = False
    since: datetime | None = None
    expires: datetime | None = None
    is_silent: bool = False
    request: ControlRequest | None = None
