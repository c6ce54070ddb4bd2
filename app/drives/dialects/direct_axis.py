"""An axis on a drive with direct data operation: one frame holds the whole motion and starts it."""

from collections.abc import Mapping

from app.base.message import say
from app.drives.dialects.dialect import AxisStatus, flag, input_flags
from app.drives.dialects.gearing import Gearing
from app.drives.unit import Unit
from app.modbus.errors import DriveError


class DirectAxis:
    """Speaks the direct data block and an input command whose bits are set and cleared again."""

    def __init__(self, unit: Unit, gearing: Gearing, acceleration_dps2: float) -> None:
        profile = unit.profile
        self._unit = unit
        self._gearing = gearing
        self._ramp = gearing.ramp(acceleration_dps2, profile.registers["direct_acceleration"].unit)
        self._types = profile.enums["direct_type"]
        self._inputs = profile.enums["input_command"]
        self._current = profile.enums["direct_current"]["full"]
        self._start = profile.enums["direct_trigger"]["start"]
        self._bits = profile.bits["output"]
        self._input_bits = profile.bits.get("inputs", {})

    polled = ("output",)

    def status(self, values: Mapping[str, float]) -> AxisStatus:
        """Return what the driver's output word and inputs say; it powers the motor by itself."""
        word = values["output"]
        return AxisStatus(
            fault=flag(self._bits, "alarm", word),
            enabled=not flag(self._bits, "alarm", word),
            moving=flag(self._bits, "moving", word),
            homed=flag(self._bits, "homed", word),
            **input_flags(self._input_bits, values),
        )

    async def enable(self) -> None:
        """Take away a stop input that is still on: nothing starts under it."""
        await self._unit.put({"input_command": 0})

    def moving(self, target: int, speed_dps: float) -> Mapping[str, float]:
        """Return the direct data of a move to a position."""
        speed = self._gearing.speed(speed_dps, self._unit.profile.registers["direct_speed"].unit)
        return self._data("absolute", target, speed)

    def turning(self, velocity_dps: float) -> Mapping[str, float]:
        """Return the direct data of continuous motion at a signed speed."""
        speed = self._gearing.velocity(velocity_dps, self._unit.profile.registers["direct_speed"].unit)
        return self._data("continuous", 0, speed)

    async def move(self, target: int, speed_dps: float, *, confirmed: bool) -> None:
        """Go to a position: one frame of sixteen registers."""
        await self._unit.put(self.moving(target, speed_dps), renewed=True)
        if confirmed:
            self._unit.expect({"direct_position": target})

    async def turn(self, velocity_dps: float) -> None:
        """Run continuously at a signed speed."""
        await self._unit.put(self.turning(velocity_dps), renewed=True)

    async def halt(self) -> None:
        """Give the stop input."""
        await self._pulse("stop")

    async def home(self) -> None:
        """Give the input that begins the return to home."""
        await self._pulse("home")

    async def set_home(self) -> None:
        """Preset the present position to zero, or raise `DriveError` if the profile has no way to."""
        if "set_home" not in self._unit.profile.sequences:
            raise DriveError(say("Profile {name} has no sequence set_home.", name=self._unit.profile.name))
        await self._unit.play("set_home")

    async def reset(self) -> None:
        """Give the input that resets the alarm."""
        await self._pulse("alarm_reset")

    async def stop(self) -> None:
        """Give the stop input ahead of everything that waits; the next command takes it away."""
        await self._unit.stop({"input_command": self._inputs["stop"]})

    async def _pulse(self, name: str) -> None:
        for word in (self._inputs[name], 0):
            await self._unit.put({"input_command": word}, renewed=True)

    def _data(self, kind: str, position: int, speed: float) -> Mapping[str, float]:
        return {
            "direct_data_number": 0,
            "direct_type": self._types[kind],
            "direct_position": position,
            "direct_speed": speed,
            "direct_acceleration": self._ramp,
            "direct_deceleration": self._ramp,
            "direct_current": self._current,
            "direct_trigger": self._start,
        }
