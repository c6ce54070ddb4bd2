"""Whether a clock is likely to be wrong: it differs from that of the device at hand."""

from datetime import datetime, timedelta

from app.base.message import NOTHING, Message, say
from app.web.shell.formats import duration

MOST_APART = timedelta(minutes=1)
"""The sun moves by a quarter of a degree in this time."""


def clock_doubt(clock: datetime, device: datetime | None) -> Message:
    """Return the question before a clock is trusted, nothing where the device agrees or is not known."""
    if device is None or abs(clock - device) <= MOST_APART:
        return NOTHING
    length = duration(abs(clock - device) / timedelta(seconds=1))
    if clock > device:
        return say(
            "The controller's clock is {length} ahead of this device's clock. Which one is right?",
            length=length,
        )
    return say(
        "The controller's clock is {length} behind this device's clock. Which one is right?", length=length
    )
