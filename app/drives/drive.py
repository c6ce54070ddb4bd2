"""The small protocol behind which every drive, simulated or real, stands."""

from datetime import datetime
from typing import Protocol, runtime_checkable

from app.modbus.line_turn import LineTurn
from app.tracker.values.motion import DriveCapabilities, DriveCommand, Feedback


class Drive(Protocol):
    """Two axes that can be read, commanded and stopped. Every call is bounded in time."""

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return what this drive can do."""

    async def read(self) -> Feedback:
        """Return a fresh reading, or raise `DriveError`; never an old value."""

    async def write(self, command: DriveCommand) -> None:
        """Make the axes do this from now on and feed the watchdog, or raise `DriveError`."""

    async def stop(self) -> None:
        """Ramp both axes down at once, ahead of anything queued, or raise `DriveError`."""

    async def set_clock(self, at: datetime) -> None:
        """Set the drive's own clock where `capabilities.settable_clock`, else do nothing."""

    async def close(self) -> None:
        """Let go of the connection; the axes are stopped first if that is possible."""


@runtime_checkable
class PromptDrive(Protocol):
    """A drive that can tell whether it lives in this process, so that reading and writing never wait."""

    @property
    def answers_at_once(self) -> bool:
        """Return whether reading and writing never wait."""


@runtime_checkable
class SharingDrive(Protocol):
    """A drive that can tell how it shares its line with others."""

    @property
    def line_turn(self) -> LineTurn | None:
        """Return how the line is shared, None where there is none."""


@runtime_checkable
class EncodingDrive(Protocol):
    """A drive whose commands are numbers in registers, which can be tried without a connection."""

    def check_fit(self) -> None:
        """Raise `DriveError` for a number that the settings can command and a register cannot hold."""


def check_fit(drive: Drive) -> None:
    """Raise `DriveError` if the settings of a drive command a number that does not fit into its register."""
    if isinstance(drive, EncodingDrive):
        drive.check_fit()


def line_turn(drive: Drive) -> LineTurn | None:
    """Return how a drive shares its line with others, None where it has none or does not tell."""
    return drive.line_turn if isinstance(drive, SharingDrive) else None


def answers_at_once(drive: Drive) -> bool:
    """Return whether reading and writing this drive never wait; one that does not tell may wait."""
    return isinstance(drive, PromptDrive) and drive.answers_at_once
