"""A tracker whose axes have a drive each: two units of one bus behind the drive protocol."""

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from datetime import datetime

from app.base.clock import Clock
from app.base.message import N_
from app.drives.dialects.register_axis import AxisReading, RegisterAxis
from app.drives.plausibility import Plausibility
from app.drives.profile import Profile
from app.modbus.bus import Priority
from app.modbus.errors import DriveError
from app.modbus.line_turn import LineTurn
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.motion import (
    AxisCommand,
    DriveCapabilities,
    DriveCommand,
    DriveRequest,
    Feedback,
    Halt,
    RequestKind,
    Velocity,
)

BOOT_COUNT = 1
"""These drives do not count their starts: one that restarted shows it by having lost its zero."""
REQUESTED = {
    RequestKind.SET_HOME_AZIMUTH: (Axis.AZIMUTH,),
    RequestKind.SET_HOME_ELEVATION: (Axis.ELEVATION,),
    RequestKind.HOME: (Axis.AZIMUTH, Axis.ELEVATION),
    RequestKind.RESET_FAULT: (Axis.AZIMUTH, Axis.ELEVATION),
}


class TwoAxisDrive:
    """The drive protocol on two axes that know nothing of each other."""

    def __init__(
        self,
        config: TrackerConfig,
        profile: Profile,
        axes: Mapping[Axis, RegisterAxis],
        clock: Clock,
        where: str,
    ) -> None:
        self._profile = profile
        self._mounted = config.mount.axes
        self._axes = axes
        self._where = where
        self._plausibility = Plausibility(config, clock, {})
        self._number = 0
        self._pending: tuple[Axis, ...] = ()
        self._done = 0
        self._failed = False
        self._stops = 0
        self._homed: dict[Axis, bool] = {}

    @property
    def line_turn(self) -> LineTurn:
        """Return how the line of both axes is shared."""
        turns = [axis.unit.line_turn for axis in self._axes.values()]
        return turns[0]._replace(reckoned_s=sum(turn.reckoned_s for turn in turns))

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return what the profile offers."""
        watchdog = self._profile.watchdog
        has_switches = "inputs" in self._profile.bits
        return DriveCapabilities(
            automatic_homing=True,
            watchdog_s=watchdog.timeout_ms / 1000.0 if watchdog is not None else None,
            settable_clock=False,
            limit_switches=has_switches and all(axis.unit.has("inputs") for axis in self._axes.values()),
            description=f"{self._profile.title}, {self._where}",
            verified=self._profile.verified,
            watchdog_action=watchdog.action if watchdog is not None else "",
            unverified=self._profile.unverified,
        )

    def check_fit(self) -> None:
        """Raise `ValueMisfit` if the settings command a number that does not fit into its register."""
        for axis in self._mounted:
            self._axes[axis].check_fit(axis)

    async def read(self) -> Feedback:
        """Return one fresh reading of both axes, or raise `DriveError`."""
        feedback = await self._read()
        if self._plausibility.doubt(feedback) is not None:
            feedback = self._plausibility.settle(feedback, await self._read())
        self._plausibility.accept(feedback)
        return feedback

    async def write(self, command: DriveCommand) -> None:
        """Send what changed, or raise `DriveError`; nothing is sent twice.

        An axis that shall stand is told so even if the other one does not answer.
        """
        wanted = {Axis.AZIMUTH: command.azimuth, Axis.ELEVATION: command.elevation}
        for axis, told in wanted.items():
            self._axes[axis].unit.priority = _priority(told)
        if not all(axis.unit.is_fresh for axis in self._axes.values()):
            await self._stand(wanted)
            await self._look_again()
        if command.request is not None and command.request.number != self._number:
            await self._begin(command.request)
        await self._tell(wanted)

    async def stop(self) -> None:
        """Ramp both axes down ahead of everything that waits; raise `DriveError` after both were tried."""
        self._stops += 1
        stops = (axis.stop() for axis in self._axes.values())
        found = await asyncio.gather(*stops, return_exceptions=True)
        for error in found:
            if isinstance(error, BaseException):
                raise error

    async def set_clock(self, at: datetime) -> None:
        """Do nothing: these drives have no clock."""

    async def close(self) -> None:
        """Stop the axes if they can be reached, then let go of the bus."""
        try:
            if all(axis.unit.was_read for axis in self._axes.values()):
                with suppress(DriveError):
                    await self.stop()
        finally:
            for axis in self._axes.values():
                await axis.unit.close()

    async def _read(self) -> Feedback:
        try:
            readings = {axis: await one.read() for axis, one in self._axes.items()}
        except DriveError:
            self._forget()
            raise
        self._notice_lost_zero(readings)
        self._watch_request(readings)
        faults = [reading.fault_code for reading in readings.values() if reading.fault_code]
        return Feedback(
            azimuth=readings[Axis.AZIMUTH].feedback,
            elevation=readings[Axis.ELEVATION].feedback,
            boot_count=BOOT_COUNT,
            fault_code=faults[0] if faults else 0,
            homing=any(reading.homing for reading in readings.values()),
            request_done=self._done,
            request_failed=self._failed,
        )

    async def _look_again(self) -> None:
        """Read the state anew; raise `DriveError` if a stop came in between."""
        stops = self._stops
        self._forget()
        await self.read()
        if self._stops != stops:
            raise DriveError(N_("A stop had priority over this command; the command was not written."))

    def _forget(self) -> None:
        for axis in self._axes.values():
            axis.forget()

    async def _stand(self, wanted: Mapping[Axis, AxisCommand]) -> None:
        """Stop what shall stand, before a reading that may fail."""
        for axis, told in wanted.items():
            if isinstance(told, Halt):
                with suppress(DriveError):
                    await self._axes[axis].stand()

    async def _tell(self, wanted: Mapping[Axis, AxisCommand]) -> None:
        """Command both axes, those that shall stand first; raise `DriveError` once all of these were told."""
        failed: DriveError | None = None
        for axis, told in sorted(wanted.items(), key=lambda one: not isinstance(one[1], Halt)):
            if failed is not None and not isinstance(told, Halt):
                break
            try:
                await self._axes[axis].write(told)
            except DriveError as error:
                failed = failed or error
        if failed is not None:
            raise failed

    async def _begin(self, request: DriveRequest) -> None:
        """Begin a request on its axes; it has failed if one of them was never told of it."""
        self._number = request.number
        self._pending = REQUESTED[request.kind]
        untold = [self._axes[axis] for axis in self._pending]
        try:
            while untold:
                await untold.pop(0).begin(request.kind)
        finally:
            for one in untold:
                one.give_up()

    def _watch_request(self, readings: Mapping[Axis, AxisReading]) -> None:
        """Answer a request once every axis that it concerns has ended it."""
        outcomes = [readings[axis].outcome for axis in self._pending]
        if not outcomes:
            return
        if None not in outcomes:
            self._done, self._failed, self._pending = self._number, not all(outcomes), ()

    def _notice_lost_zero(self, readings: Mapping[Axis, AxisReading]) -> None:
        """Forget the requests of the life that a drive has lost with its zero, unless it is homing."""
        homed = {axis: reading.feedback.homed for axis, reading in readings.items()}
        lost = any(self._homed.get(axis, False) and not homed[axis] for axis in homed)
        if lost and not self._pending:
            self._done, self._failed = 0, False
        self._homed = homed


def _priority(command: AxisCommand) -> Priority:
    return Priority.JOG if isinstance(command, Velocity | Halt) else Priority.COMMAND
