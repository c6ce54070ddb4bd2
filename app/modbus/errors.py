"""Why a device did not do what it was asked."""

from app.base.errors import Foreseen


class DriveError(Foreseen):
    """A drive could not be read or written; the text says what happened and what to do."""


class DriveSilent(DriveError):
    """Nothing came back in time, or there is no connection."""


class DriveRefused(DriveError):
    """The drive answered that it will not do this; asking again will not help."""
