"""The frozen parts of the controller's state; each is replaced as a whole, by its one owner."""

from datetime import UTC, datetime
from typing import NamedTuple

from app.tracker.motion.hybrid import Corrected
from app.tracker.state.activity import AxisPair
from app.tracker.values.reason import Reason

NOWHERE = AxisPair(None, None)
LONG_AGO = datetime(1970, 1, 1, tzinfo=UTC)


class Setpoints(NamedTuple):
    """Where the axes were told to go last, and what the light sensors add to that. Owner: `setpoints`."""

    axes: AxisPair = NOWHERE
    correction: Corrected | None = None


NO_SETPOINTS = Setpoints()


class Waiting(NamedTuple):
    """Why a tracker that is to move by itself does not. Owner: `waiting`.

    `untouched`: it was to go on by itself and nobody has touched it since, so the weather may stow it.
    """

    reason: Reason | None = None
    untouched: bool = False


NOT_WAITING = Waiting()


class Warned(NamedTuple):
    """A motion that was announced: it begins at `until`, steady time."""

    until: datetime
    reason: Reason


class Countdowns(NamedTuple):
    """What is counted down: to a motion, and to the end of one by hand. Owner: `announce`."""

    motion: Warned | None = None
    by_hand: datetime | None = None


NO_COUNTDOWN = Countdowns()


class Connection(NamedTuple):
    """How the drive answers. Owner: `protect`.

    `misses` readings in a row failed; `aftermath` is what it did while it did not answer, until a command.
    """

    misses: int = 0
    lost: bool = False
    aftermath: Reason | None = None


ANSWERS = Connection()


class Recovery(NamedTuple):
    """The fault that is to be reset automatically, since when, and the resets so far. Owner: `recovery`.

    `goes_on`: tracking goes on once the fault is gone.
    """

    fault: str | None = None
    since: datetime = LONG_AGO
    resets: tuple[datetime, ...] = ()
    goes_on: bool = False


NO_FAULT = Recovery()
