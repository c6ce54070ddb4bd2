"""A drive that could not be made, because its profile is missing or wrong: it says so at every call."""

from datetime import datetime

from app.modbus.errors import DriveError
from app.tracker.values.motion import DriveCapabilities, DriveCommand, Feedback


class UnusableDrive:
    """Stands in for a drive whose configuration cannot be used, so that the rest of the site lives on."""

    def __init__(self, reason: str) -> None:
        self._reason = reason

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return that it can do nothing."""
        return DriveCapabilities(
            automatic_homing=False,
            watchdog_s=None,
            settable_clock=False,
            limit_switches=False,
            description=self._reason,
            verified=False,
        )

    async def read(self) -> Feedback:
        """Raise `DriveError` with the reason."""
        raise DriveError(self._reason)

    async def write(self, command: DriveCommand) -> None:
        """Raise `DriveError` with the reason."""
        raise DriveError(self._reason)

    async def stop(self) -> None:
        """Do nothing: nothing is connected that could move."""

    async def set_clock(self, at: datetime) -> None:
        """Do nothing: there is no clock to set."""

    async def close(self) -> None:
        """Do nothing: there is no connection."""
