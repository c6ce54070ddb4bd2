"""Stored settings that were not accepted at the start: nothing moves until a person has looked at them."""

from app.tracker.controller_state import ControllerState
from app.tracker.reason import Reason


def accepted(mind: ControllerState) -> Reason | None:
    """Return that stored settings were rejected and others are used in their place."""
    rejected = mind.memory.rejected
    if not rejected:
        return None
    values = "; ".join(f"{one.what} was {one.stored}, used is {one.used}" for one in rejected)
    return Reason(
        "config_rejected",
        f"The stored settings of {mind.config.name} were rejected at startup: {values}.",
        (
            "Compare the settings on the tracker's Settings page, correct them, and save. Then the "
            "tracker may move again."
        ),
    )
