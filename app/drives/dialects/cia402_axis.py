"""An axis on a CiA 402 drive."""

from collections.abc import Mapping

from app.base.message import say
from app.drives.dialects import cia402
from app.drives.dialects.cia402 import Homing, Mode, ProfilePosition, ProfileVelocity, State
from app.drives.dialects.dialect import AxisStatus, flag, input_flags
from app.drives.dialects.gearing import Gearing
from app.drives.unit import Unit


class Cia402Axis:
    """Speaks controlword and statusword. Halt is set in every controlword that has no valid target."""

    def __init__(self, unit: Unit, gearing: Gearing, acceleration_dps2: float) -> None:
        self._unit = unit
        self._gearing = gearing
        self._acceleration_dps2 = acceleration_dps2
        self._status_bits = unit.profile.bits["statusword"]
        self._input_bits = unit.profile.bits.get("inputs", {})
        self._methods = unit.profile.enums["homing_method"]

    polled = ("statusword",)

    def status(self, values: Mapping[str, float]) -> AxisStatus:
        """Return what statusword and inputs say."""
        statusword = int(values["statusword"])
        state = cia402.state_of(statusword)
        return AxisStatus(
            fault=state in cia402.FAULTY,
            enabled=state is State.ENABLED,
            moving=state is State.ENABLED and not statusword & cia402.TARGET_REACHED,
            homed=flag(self._status_bits, "homed", statusword),
            **input_flags(self._input_bits, values),
        )

    async def enable(self) -> None:
        """Walk the transitions to operation enabled with halt set, or raise `DriveError`."""
        state = await self._state()
        for _ in range(cia402.MOST_TRANSITIONS):
            if state is State.ENABLED:
                return
            controlword = cia402.TOWARDS_ENABLED.get(state)
            if controlword is None:
                break
            await self._unit.put({"controlword": controlword}, renewed=True)
            state = await self._state()
        if state is not State.ENABLED:
            raise self._unit.not_taken(
                say("it is in state {state}, not {enabled}", state=state, enabled=State.ENABLED)
            )

    def moving(self, target: int, speed_dps: float) -> Mapping[str, float]:
        """Return the ramps, and target and speed of profile position mode."""
        return self._ramps() | self._position(target, speed_dps).values()

    def turning(self, velocity_dps: float) -> Mapping[str, float]:
        """Return the ramps, and the speed of profile velocity mode."""
        return self._ramps() | self._velocity(velocity_dps).values()

    async def move(self, target: int, speed_dps: float, *, confirmed: bool) -> None:
        """Go to a position in profile position mode."""
        await self._run(self._position(target, speed_dps), confirmed=confirmed)

    async def turn(self, velocity_dps: float) -> None:
        """Turn in profile velocity mode."""
        await self._run(self._velocity(velocity_dps), confirmed=False)

    async def halt(self) -> None:
        """Set the halt bit: the drive ramps down and holds."""
        await self._unit.put({"controlword": cia402.HALTED})

    async def home(self) -> None:
        """Search the reference by the method that the profile calls `home`."""
        await self._run(Homing(self._methods["home"]), confirmed=False)

    async def set_home(self) -> None:
        """Home by the method that takes the present position as the reference."""
        await self._run(Homing(self._methods["set_home"]), confirmed=False)

    async def reset(self) -> None:
        """Give the rising edge that clears a fault; the drive is enabled again by the next motion."""
        for controlword in (cia402.DISABLE_VOLTAGE, cia402.FAULT_RESET):
            await self._unit.put({"controlword": controlword}, renewed=True)

    async def stop(self) -> None:
        """Set the halt bit ahead of everything that waits."""
        await self._unit.stop({"controlword": cia402.HALTED})

    async def _run(self, mode: Mode, *, confirmed: bool) -> None:
        await self._unit.put(self._ramps() | {"mode": mode.number})
        await self._unit.put(mode.values(), confirmed=confirmed)
        for controlword in mode.controlwords:
            await self._unit.put({"controlword": controlword})

    async def _state(self) -> State:
        return cia402.state_of(int((await self._unit.poll("statusword"))["statusword"]))

    def _position(self, target: int, speed_dps: float) -> ProfilePosition:
        return ProfilePosition(target, self._gearing.speed(speed_dps, self._speed_unit("profile_velocity")))

    def _velocity(self, velocity_dps: float) -> ProfileVelocity:
        return ProfileVelocity(self._gearing.velocity(velocity_dps, self._speed_unit("target_velocity")))

    def _ramps(self) -> dict[str, float]:
        ramps = ("profile_acceleration", "profile_deceleration")
        return {name: self._ramp(name) for name in ramps if self._unit.has(name)}

    def _ramp(self, name: str) -> float:
        return self._gearing.ramp(self._acceleration_dps2, self._unit.profile.registers[name].unit)

    def _speed_unit(self, name: str) -> str:
        return self._unit.profile.registers[name].unit
