"""An axis on a pulse drive with path tables: path 0 is written and triggered in one frame."""

from collections.abc import Mapping
from dataclasses import dataclass

from app.base.message import N_
from app.drives.dialects.dialect import AxisStatus, flag, input_flags
from app.drives.dialects.gearing import Gearing
from app.drives.unit import Unit


@dataclass(frozen=True, slots=True)
class PathBlock:
    """Path 0 and its trigger: position in steps, speed in rpm, ramps in ms for 1000 rpm, pause in ms."""

    mode: int
    position: int
    speed: float
    acceleration: float
    deceleration: float
    trigger: int
    pause: int = 0

    def values(self) -> dict[str, float]:
        """Return the eight registers in the order of the block."""
        return {
            "path_mode": self.mode,
            "path_position": self.position,
            "path_speed": self.speed,
            "path_acceleration": self.acceleration,
            "path_deceleration": self.deceleration,
            "path_pause": self.pause,
            "path_trigger": self.trigger,
        }


class PrAxis:
    """Speaks path blocks, the path trigger and the control word of the profile's sequences."""

    def __init__(self, unit: Unit, gearing: Gearing, acceleration_dps2: float) -> None:
        profile = unit.profile
        self._unit = unit
        self._gearing = gearing
        self._ramp = gearing.ramp(acceleration_dps2, profile.registers["path_acceleration"].unit)
        self._modes = profile.enums["path_mode"]
        self._triggers = profile.enums["trigger"]
        self._start = profile.enums["path_trigger"]["start"]
        self._bits = profile.bits["status"]
        self._input_bits = profile.bits.get("inputs", {})

    polled = ("status",)

    def status(self, values: Mapping[str, float]) -> AxisStatus:
        """Return what the motion status and the inputs say."""
        word = values["status"]
        return AxisStatus(
            fault=flag(self._bits, "fault", word),
            enabled=flag(self._bits, "enabled", word),
            moving=flag(self._bits, "running", word),
            homed=flag(self._bits, "homed", word),
            **input_flags(self._input_bits, values),
        )

    async def enable(self) -> None:
        """Enable by software, or raise `DriveError` if the drive does not report that it is enabled."""
        if await self._is_enabled():
            return
        await self._unit.play("enable")
        if not await self._is_enabled():
            raise self._unit.not_taken(N_("the motor is not enabled"))

    def moving(self, target: int, speed_dps: float) -> Mapping[str, float]:
        """Return the path block of a move to a position."""
        speed = self._gearing.speed(speed_dps, self._unit.profile.registers["path_speed"].unit)
        return self._path("absolute", target, speed)

    def turning(self, velocity_dps: float) -> Mapping[str, float]:
        """Return the path block of the velocity mode, whose speed is signed."""
        speed = self._gearing.velocity(velocity_dps, self._unit.profile.registers["path_speed"].unit)
        return self._path("velocity", 0, speed)

    async def move(self, target: int, speed_dps: float, *, confirmed: bool) -> None:
        """Go to a position: one frame of eight registers."""
        await self._unit.put(self.moving(target, speed_dps), renewed=True)
        if confirmed:
            self._unit.expect({"path_position": target})

    async def turn(self, velocity_dps: float) -> None:
        """Run the velocity mode of path 0."""
        await self._unit.put(self.turning(velocity_dps), renewed=True)

    async def halt(self) -> None:
        """Trigger the stop."""
        await self._unit.put({"trigger": self._triggers["stop"]}, renewed=True)

    async def home(self) -> None:
        """Trigger the search for the origin."""
        await self._unit.put({"trigger": self._triggers["home"]}, renewed=True)

    async def set_home(self) -> None:
        """Trigger the zero at the present position."""
        await self._unit.put({"trigger": self._triggers["set_home"]}, renewed=True)

    async def reset(self) -> None:
        """Reset the alarm."""
        await self._unit.play("reset_fault")

    async def stop(self) -> None:
        """Trigger the stop ahead of everything that waits."""
        await self._unit.stop({"trigger": self._triggers["stop"]})

    def _path(self, mode: str, target: int, speed: float) -> Mapping[str, float]:
        path = PathBlock(self._modes[mode], target, speed, self._ramp, self._ramp, self._start)
        return path.values()

    async def _is_enabled(self) -> bool:
        return flag(self._bits, "enabled", (await self._unit.poll("status"))["status"])
