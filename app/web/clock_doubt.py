"""Whether a clock is likely to be wrong: it differs from that of the device at hand."""

from datetime import datetime, timedelta

from app.web.ui.formats import duration

MOST_APART = timedelta(minutes=1)
"""The sun moves by a quarter of a degree in this time."""


def clock_doubt(clock: datetime, device: datetime | None) -> str:
    """Return the question before a clock is trusted, nothing where the device agrees or is not known."""
    if device is None or abs(clock - device) <= MOST_APART:
        return ""
    length = duration(abs(clock - device) / timedelta(seconds=1))
    if clock > device:
        return f"The controller's clock is {length} ahead of this device's clock. Which one is right?"
    return f"The controller's clock is {length} behind this device's clock. Which one is right?"
