"""Which axes have a home position since the last doubt, and the end of the trust in it."""

from collections.abc import Set as AbstractSet

from app.base.message import N_, Message, say
from app.tracker.settings.axes import Axis
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.setpoints import forget_correction
from app.tracker.state.snapshot import EventKind
from app.tracker.values.reason import Reason

SEARCH_BEGUN = N_("a search for the home switches was started.")
SEARCH_UNFINISHED = N_("the search for the home switches was not finished.")


def set_homed(state: ControllerState, axes: AbstractSet[Axis]) -> None:
    """Take these axes, and no others, for homed."""
    state.zeroed = frozenset(axes)


def lose_home(state: ControllerState, reason: Reason) -> None:
    """Stop believing the zero, and whatever needed it."""
    state.remember(former_home=None)
    set_homed(state, frozenset())
    forget_correction(state)
    if state.memory.home is None:
        return
    doubt_zero(state, reason.message)
    state.say(
        EventKind.HOME_LOST, say("Home reference lost: {message}", message=reason.message), code=reason.code
    )


def doubt_zero(state: ControllerState, why: Message) -> None:
    """Remember since when and why there is no zero that is trusted."""
    state.remember(home=None, home_lost=why, home_lost_at=state.site_time)


def give_up_search(state: ControllerState) -> None:
    """Say of a search for the home switches that has begun that it was not finished; it is over now."""
    if state.memory.home is None and state.memory.home_lost == SEARCH_BEGUN:
        state.remember(home_lost=SEARCH_UNFINISHED)
