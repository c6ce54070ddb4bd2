"""Another tracker controller as a drive: SunSpec model 601, of which one tracker is moved.

Source: SunSpec Information Model 601 (Tracker Controller, draft 2): control unit and repeating tracker
block; targets and positions in degrees times ten to the power of `Dgr_SF`.
"""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from math import copysign
from typing import assert_never

from app.base.clock import Clock
from app.base.message import N_, say, with_format
from app.drives.dialects.azimuth_range import AzimuthRange
from app.drives.dialects.register_axis import LEASE_S
from app.drives.dialects.sunspec_models import MapSearch, located
from app.drives.plausibility import Plausibility
from app.drives.profile import Profile
from app.drives.register import RANGES, WordType
from app.drives.unit import Link, Unit
from app.modbus.errors import DriveError, DriveRefused
from app.modbus.line_turn import LineTurn
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.values.motion import (
    AxisCommand,
    AxisFeedback,
    DriveCapabilities,
    DriveCommand,
    DriveRequest,
    Feedback,
    Halt,
    Position,
    RequestKind,
    Velocity,
)

NOT_IMPLEMENTED = -0x8000_0000
NOT_IMPLEMENTED_BITS = 0xFFFF
SCALES = range(-10, 11)
"""The powers of ten that the type `sunssf` allows."""
FARTHEST_DEG = 720.0
"""No axis stands farther from its home position."""
LONG_WAY_DEG, STRIDE_DEG, AHEAD_DEG = 170.0, 120.0, 60.0
"""A way as long as half a turn is gone in strides: the other controller may take the shorter one. The next
stride is given before the one before it has ended.
"""
CIRCLING = (MountKind.AZIMUTH_ELEVATION, MountKind.VERTICAL_SINGLE_AXIS)
"""Mounts whose first axis turns through the azimuths."""
BOOT_COUNT = 1
BEGINNING = timedelta(milliseconds=500)
"""How long after a new target the axes count as moving although no motion shows yet."""
LATELY = timedelta(milliseconds=500)
READ = (
    "alarms", "scale", "elevation_position", "azimuth_position", "control", "tracker_alarms",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Seen:
    """A reading in degrees; `read_deg` is the azimuth as the controller counts it, in steps of `step_deg`."""

    at: datetime
    azimuth_deg: float
    elevation_deg: float
    azimuth_dps: float
    elevation_dps: float
    read_deg: float
    step_deg: float


class SunSpecDrive:
    """Gives targets in manual control; the other controller keeps its own reference, speeds and limits.

    It has no watchdog: what it was told last it goes on doing, so hand motion is made of short steps.
    """

    def __init__(self, config: TrackerConfig, profile: Profile, link: Link, clock: Clock, where: str) -> None:
        self._config = config
        self._profile = profile
        self._link = link
        self._clock = clock
        self._where = where
        self._unit = Unit(profile, link, where)
        self._controls = profile.enums["control"]
        self._plausibility = Plausibility(config, clock, {})
        circles = config.mount.kind in CIRCLING
        target = profile.registers["azimuth_target"]
        self._range = AzimuthRange(config.azimuth, target) if circles else None
        self._search = MapSearch(profile.registers["sunspec_id"].address)
        self._stride_deg: float | None = None
        self._is_found = False
        self._aimed_deg: tuple[float, float] | None = None
        self._control = 0
        self._last: _Seen | None = None
        self._told_at: datetime | None = None
        self._doing: DriveCommand | None = None
        self._request: DriveRequest | None = None
        self._number = self._done = self._stops = 0
        self._failed = False

    @property
    def line_turn(self) -> LineTurn:
        """Return how its line is shared."""
        return self._link.line_turn

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return what model 601 offers."""
        return DriveCapabilities(
            automatic_homing=True,
            watchdog_s=None,
            settable_clock=False,
            limit_switches=False,
            description=f"{self._profile.title}, {self._where}",
            verified=self._profile.verified,
            unverified=self._profile.unverified,
        )

    async def read(self) -> Feedback:
        """Return one fresh reading, or raise `DriveError`."""
        if not self._is_found:
            found = await located(self._profile, self._link, self._where, self._search)
            self._unit = Unit(found, self._link, self._where)
            self._is_found = True
        feedback, seen = await self._read()
        if self._plausibility.doubt(feedback) is not None:
            again, seen = await self._read()
            feedback = self._plausibility.settle(feedback, again)
        self._plausibility.accept(feedback)
        self._last = seen
        if self._range is not None:
            self._range.learn(seen.read_deg, seen.azimuth_deg)
        return feedback

    async def write(self, command: DriveCommand) -> None:
        """Send new targets if there are any, or raise `DriveError`."""
        if not self._unit.is_fresh:
            await self._look_again()
        if command.request is not None and command.request.number != self._number:
            await self._begin(command.request)
        halted = isinstance(command.azimuth, Halt) and isinstance(command.elevation, Halt)
        if self._request is not None and halted:
            return
        command = replace(command, request=None)
        if command == self._doing and not (_is_stepped(command) or self._has_stridden()):
            return
        if self._doing is None and halted and self._control != self._controls["manual"]:
            self._doing = command
            return
        self._give_up()
        await self._aim(command)

    async def stop(self) -> None:
        """Make the nearest point of rest the target, ahead of everything that waits."""
        self._stops += 1
        self._give_up()
        self._doing = None
        seen = await self._seen_lately()
        azimuth_deg = self._rest_deg(Axis.AZIMUTH, seen.azimuth_deg, seen.azimuth_dps)
        elevation_deg = self._rest_deg(Axis.ELEVATION, seen.elevation_deg, seen.elevation_dps)
        self._stride_deg = None
        targets = self._targets(azimuth_deg, elevation_deg, seen.step_deg)
        lowest, highest = RANGES[WordType.INT32]
        await self._unit.stop({name: min(highest, max(lowest, count)) for name, count in targets.items()})

    async def set_clock(self, at: datetime) -> None:
        """Do nothing: model 601 shows a clock and has none to set."""

    async def close(self) -> None:
        """Stop the axes, which stay in manual control where they are, then let go of the connection."""
        try:
            if self._unit.was_read and self._last is not None:
                with suppress(DriveError):
                    await self.stop()
        finally:
            await self._unit.close()

    async def _read(self) -> tuple[Feedback, _Seen]:
        try:
            await self._unit.confirm()
        except DriveError:
            self._doing = None
            raise
        values = await self._unit.look(*READ)
        if values["scale"] not in SCALES:
            raise DriveError(
                say("The tracker controller at {where} gives no scale for its degrees.", where=self._where)
            )
        seen = self._seen(values, 10.0 ** values["scale"])
        azimuth = self._axis(seen.azimuth_deg, seen.azimuth_dps)
        elevation = self._axis(seen.elevation_deg, seen.elevation_dps)
        fault_code = _alarm_bits(values["alarms"]) | _alarm_bits(values["tracker_alarms"])
        self._control = int(values["control"])
        self._watch_request(fault_code, moving=azimuth.moving or elevation.moving)
        feedback = Feedback(
            azimuth=azimuth,
            elevation=elevation,
            boot_count=BOOT_COUNT,
            fault_code=fault_code,
            homing=self._control == self._controls["calibrate"],
            request_done=self._done,
            request_failed=self._failed,
        )
        return feedback, seen

    def _degrees(self, values: Mapping[str, float], name: str, step_deg: float) -> float:
        if values[name] == NOT_IMPLEMENTED:
            raise DriveError(
                say(
                    "The tracker controller at {where} does not report {name}. It cannot move both axes.",
                    where=self._where,
                    name=name,
                )
            )
        degrees = round(values[name] * step_deg, 9)
        if abs(degrees) > FARTHEST_DEG:
            raise DriveError(
                say(
                    "The tracker controller at {where} reports {degrees} degrees as {name}, which is "
                    "impossible. Check the device.",
                    where=self._where,
                    degrees=with_format(degrees, "g"),
                    name=name,
                )
            )
        return degrees

    def _seen(self, values: Mapping[str, float], step_deg: float) -> _Seen:
        """Return what was read, with speeds from the way since the reading before."""
        at, last = self._clock.now(), self._last
        read_deg = azimuth_deg = self._degrees(values, "azimuth_position", step_deg)
        elevation_deg = self._degrees(values, "elevation_position", step_deg)
        if self._range is not None:
            last_deg = None if last is None else last.azimuth_deg
            azimuth_deg = round(self._range.position_deg(read_deg, last_deg), 9)
        seen = _Seen(at, azimuth_deg, elevation_deg, 0.0, 0.0, read_deg, step_deg)
        if last is None:
            return seen
        elapsed_s = (at - last.at).total_seconds()
        if elapsed_s <= 0.0:
            return replace(seen, azimuth_dps=last.azimuth_dps, elevation_dps=last.elevation_dps)
        return replace(
            seen,
            azimuth_dps=(azimuth_deg - last.azimuth_deg) / elapsed_s,
            elevation_dps=(elevation_deg - last.elevation_deg) / elapsed_s,
        )

    def _axis(self, position_deg: float, velocity_dps: float) -> AxisFeedback:
        just_told = self._told_at is not None and self._clock.now() - self._told_at < BEGINNING
        return AxisFeedback(position_deg, velocity_dps, moving=velocity_dps != 0.0 or just_told, homed=True)

    def _rest_deg(self, axis: Axis, position_deg: float, velocity_dps: float) -> float:
        """Return where an axis comes to rest if it ramps down now, as the tracker's settings say it can."""
        settings = self._config.axis(axis)
        braking_deg = velocity_dps**2 / (2.0 * settings.acceleration_dps2)
        rest_deg = position_deg + (braking_deg if velocity_dps > 0.0 else -braking_deg)
        low_deg, high_deg = min(settings.minimum_deg, position_deg), max(settings.maximum_deg, position_deg)
        return min(high_deg, max(low_deg, rest_deg))

    async def _seen_lately(self) -> _Seen:
        """Return where the axes are; an old reading is made anew, or a stop would turn them back there.

        Where that fails it is reckoned how far they have come towards their targets.
        """
        last = self._last
        if last is not None and self._clock.now() - last.at <= LATELY:
            return last
        with suppress(DriveError):
            await self.read()
        if self._last is None:
            raise DriveError(
                say(
                    "The tracker controller at {where} cannot be stopped: its position was never read. "
                    "Use its own stop.",
                    where=self._where,
                )
            )
        return self._last if self._last is not last else self._reckoned(self._last)

    def _reckoned(self, last: _Seen) -> _Seen:
        elapsed_s = (self._clock.now() - last.at).total_seconds()
        azimuth_deg, elevation_deg = self._aimed_deg or (last.azimuth_deg, last.elevation_deg)
        return replace(
            last,
            azimuth_deg=_between(last.azimuth_deg, azimuth_deg, last.azimuth_dps * elapsed_s),
            elevation_deg=_between(last.elevation_deg, elevation_deg, last.elevation_dps * elapsed_s),
            azimuth_dps=0.0,
            elevation_dps=0.0,
        )

    async def _look_again(self) -> None:
        stops = self._stops
        self._unit.forget()
        self._doing = None
        await self.read()
        if self._stops != stops:
            raise DriveError(N_("A stop had priority over this command; the command was not written."))

    async def _begin(self, request: DriveRequest) -> None:
        """Begin calibration; what the model has no way for is answered as failed at once."""
        self._number, self._request = request.number, request
        match request.kind:
            case RequestKind.HOME:
                self._told_at = self._clock.now()
                self._control = self._controls["calibrate"]
                await self._unit.put({"control": self._control}, renewed=True)
            case RequestKind.SET_HOME_AZIMUTH | RequestKind.SET_HOME_ELEVATION:
                self._give_up()
            case RequestKind.RESET_FAULT:
                pass
            case _ as never:
                assert_never(never)

    def _give_up(self) -> None:
        if self._request is not None:
            self._request, self._done, self._failed = None, self._number, True

    def _watch_request(self, fault_code: int, *, moving: bool) -> None:
        """End calibration when the controller has gone back to automatic, a reset when no alarm is left."""
        if self._request is None or (self._request.kind is RequestKind.HOME and moving and not fault_code):
            return
        if self._control != self._controls["calibrate"] or fault_code:
            self._request, self._done, self._failed = None, self._number, fault_code != 0

    async def _aim(self, command: DriveCommand) -> None:
        seen = self._last
        if seen is None:
            raise DriveError(
                say("The tracker controller at {where} was not read yet; it is not moved.", where=self._where)
            )
        azimuth_deg = self._target(Axis.AZIMUTH, command.azimuth, seen.azimuth_deg, seen.azimuth_dps)
        elevation_deg = self._target(
            Axis.ELEVATION, command.elevation, seen.elevation_deg, seen.elevation_dps
        )
        confirmed = not _is_stepped(command)
        azimuth_deg = self._strided(azimuth_deg, seen.azimuth_deg)
        self._doing = None
        try:
            await self._give(azimuth_deg, elevation_deg, seen, confirmed=confirmed)
        except DriveRefused:
            if self._range is None or not self._range.take_other(azimuth_deg):
                raise
            await self._give(azimuth_deg, elevation_deg, seen, confirmed=confirmed)
        self._doing, self._told_at = command, self._clock.now()

    async def _give(self, azimuth_deg: float, elevation_deg: float, seen: _Seen, *, confirmed: bool) -> None:
        self._aimed_deg = azimuth_deg, elevation_deg
        targets = self._targets(azimuth_deg, elevation_deg, seen.step_deg)
        await self._unit.put(targets, renewed=True, confirmed=confirmed)

    def _strided(self, target_deg: float, here_deg: float) -> float:
        """Return the target, or the end of the next stride where another way is the shorter one."""
        way_deg = target_deg - here_deg
        if self._range is None or abs(way_deg) <= LONG_WAY_DEG:
            self._stride_deg = None
            return target_deg
        self._stride_deg = here_deg + copysign(STRIDE_DEG, way_deg)
        return self._stride_deg

    def _has_stridden(self) -> bool:
        """Return whether the next stride is due."""
        stride_deg, seen = self._stride_deg, self._last
        return stride_deg is not None and seen is not None and abs(stride_deg - seen.azimuth_deg) < AHEAD_DEG

    def _target(self, axis: Axis, command: AxisCommand, here_deg: float, here_dps: float) -> float:
        match command:
            case Position(position_deg, speed_dps) if speed_dps > 0.0:
                return position_deg
            case Velocity(velocity_dps):
                acceleration_dps2 = self._config.axis(axis).acceleration_dps2
                reach_deg = abs(velocity_dps) * LEASE_S + velocity_dps**2 / (2.0 * acceleration_dps2)
                return here_deg + (reach_deg if velocity_dps > 0.0 else -reach_deg)
            case _:
                return self._rest_deg(axis, here_deg, here_dps)

    def _targets(self, azimuth_deg: float, elevation_deg: float, step_deg: float) -> dict[str, int]:
        azimuth = self._range.count(azimuth_deg, step_deg) if self._range else round(azimuth_deg / step_deg)
        return {
            "elevation_target": round(elevation_deg / step_deg),
            "azimuth_target": azimuth,
            "control": self._controls["manual"],
        }


def _between(from_deg: float, to_deg: float, way_deg: float) -> float:
    """Return where an axis has come on its way, at most to the end of it."""
    low_deg, high_deg = min(from_deg, to_deg), max(from_deg, to_deg)
    return min(high_deg, max(low_deg, from_deg + way_deg))


def _alarm_bits(word: float) -> int:
    return 0 if word == NOT_IMPLEMENTED_BITS else int(word)


def _is_stepped(command: DriveCommand) -> bool:
    return isinstance(command.azimuth, Velocity) or isinstance(command.elevation, Velocity)
