"""Tests the connection to a drive that is set, or about to be: it is read, and nothing is changed."""

import asyncio
from typing import Protocol

from app.base.message import N_, say, with_format
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.drive_check import CheckOutcome, DriveCheck, DriveChoices, DriveReadings
from app.tracker.settings.config import DriveConfig
from app.tracker.values.reason import Reason

LOOK_WITHIN_S = 8.0
TOO_SLOW = DriveReadings(
    CheckOutcome.SILENT,
    say(
        "The drive was not read within {look_within_s} s. Check the line, its settings, and the address.",
        look_within_s=with_format(LOOK_WITHIN_S, "g"),
    ),
)
NOT_HERE = Reason(
    "no_drive_tools",
    N_("This controller cannot test drive connections."),
    N_("Use the controller's own service."),
)


class DriveTools(Protocol):
    """What looks at drives beside the trackers."""

    async def look(self, drive: DriveConfig) -> DriveReadings:
        """Return what a drive answers when it is only read."""

    def choices(self) -> DriveChoices:
        """Return the profiles and serial ports that there are; may touch the disk."""


class Checks:
    """The newest connection test of each tracker; they are not kept over a restart."""

    def __init__(self, tools: DriveTools | None = None) -> None:
        self._tools = tools
        self._newest: dict[str, DriveCheck] = {}

    def newest(self, tracker_id: str) -> DriveCheck | None:
        """Return the newest connection test of a tracker."""
        return self._newest.get(tracker_id)

    async def choices(self) -> DriveChoices:
        """Return what there is to choose from, read beside the loop."""
        return DriveChoices() if self._tools is None else await asyncio.to_thread(self._tools.choices)

    async def look(self, drive: DriveConfig) -> DriveReadings:
        """Return what a drive answers, within bounds; raise `CommandRejected` where nobody can look."""
        if self._tools is None:
            raise CommandRejected(NOT_HERE)
        try:
            async with asyncio.timeout(LOOK_WITHIN_S):
                return await self._tools.look(drive)
        except TimeoutError:
            return TOO_SLOW

    def keep(self, tracker_id: str, check: DriveCheck) -> None:
        """Keep the newest test of a tracker."""
        self._newest[tracker_id] = check
