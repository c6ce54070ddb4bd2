"""Stored settings that were not accepted at the start: nothing moves until a person has looked at them."""

from app.base.message import N_, join, say
from app.tracker.state.controller_state import ControllerState
from app.tracker.values.reason import Reason


def accepted(state: ControllerState) -> Reason | None:
    """Return that stored settings were rejected and others are used in their place."""
    rejected = state.memory.rejected
    if not rejected:
        return None
    values = join(
        "; ",
        (
            say("{what} was {stored}, used is {used}", what=one.what, stored=one.stored, used=one.used)
            for one in rejected
        ),
    )
    return Reason(
        "config_rejected",
        say(
            "The stored settings of {name} were rejected at startup: {values}.",
            name=state.config.name,
            values=values,
        ),
        N_(
            "Compare the settings on the tracker's Settings page, correct them, and save. Then the "
            "tracker may move again."
        ),
    )
