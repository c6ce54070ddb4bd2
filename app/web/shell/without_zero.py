"""The trust in the zero in the words of the pages: what cannot be done without it."""

from app.base.message import N_
from app.tracker.access.interlocks import REQUIRED, Action, homed

NEEDS_ZERO: dict[Action, str] = {
    Action.TRACK: N_("follow the sun"),
    Action.STOW: N_("stow, not even against wind"),
    Action.PARK: N_("park"),
    Action.MOVE: N_("move to a direction"),
    Action.GO_TO_START: N_("go to the start of a show"),
    Action.RUN_SHOW: N_("show tracking movement"),
    Action.SET_LIMIT: N_("set a position as soft limit"),
}
"""What each action that needs a trusted zero does, after "it does not"."""


def blocked_without_zero() -> tuple[str, ...]:
    """Return everything that a tracker without a trusted zero does not do, by the table that forbids it."""
    return tuple(words for action, words in NEEDS_ZERO.items() if homed in REQUIRED[action])
