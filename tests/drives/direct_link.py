"""A way to a simulated device without a bus between, on which a test decides what becomes of each request."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from app.base.clock import VirtualClock
from app.drives.dialects.cia402_axis import Cia402Axis
from app.drives.dialects.dialect import Dialect
from app.drives.dialects.direct_axis import DirectAxis
from app.drives.dialects.gearing import Gearing, gearing_of
from app.drives.dialects.pr_axis import PrAxis
from app.drives.dialects.register_axis import RegisterAxis
from app.drives.dialects.sunspec import SunSpecDrive
from app.drives.dialects.two_axes import TwoAxisDrive
from app.drives.profile import Adapter, load_profile
from app.drives.unit import Unit
from app.modbus.bus import Priority
from app.modbus.errors import DriveError, DriveSilent
from app.modbus.line_turn import LineTurn
from app.modbus.server import Device
from app.simulation.devices.shelf import devices
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import AxisDrive
from tests.drives.rigs import CONFIG, START, Rig

GEAR_RATIO = 36.0
CONTROLWORD, STATUSWORD, STATUSWORD_ENABLED = 0x3100, 0x3200, 0x27
DIALECTS: Mapping[Adapter, Callable[[Unit, Gearing, float], Dialect]] = {
    Adapter.CIA402: Cia402Axis,
    Adapter.PR: PrAxis,
    Adapter.DIRECT: DirectAxis,
}


class DirectLink:
    """Carries requests out at once; `holds` says whose reply waits for `release`, `loses` whose is lost."""

    line_turn = LineTurn(1, 0.0, 0.0)

    def __init__(self, device: Device) -> None:
        self.device = device
        self.silent = False
        self.holds: Callable[[str], bool] = lambda request: False
        self.loses: Callable[[str], bool] = lambda request: False
        self.held = asyncio.Event()
        self._released = asyncio.Event()
        self._stops = 0
        self._lost = 0

    @property
    def ticket(self) -> int:
        return self._stops + self._lost

    def release(self) -> None:
        self._released.set()

    def renew(self) -> None:
        """Have a new connection: what was read over the old one does not count any more."""
        self._lost += 1

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        self._answer_or_not()
        words = list(self.device.read_registers(3, address, count))
        await self._reply(f"read {what}")
        return words

    async def write(
        self,
        address: int,
        words: Sequence[int],
        *,
        what: str,
        ticket: int | None,
        priority: Priority = Priority.COMMAND,
    ) -> None:
        self._answer_or_not()
        if ticket is not None and ticket != self.ticket:
            raise DriveError(f"{what} was issued before a stop or a lost reply.")
        self.device.write_registers(address, words)
        await self._reply(f"write {what}")

    async def stop(self, address: int, words: Sequence[int], *, what: str) -> None:
        self._stops += 1
        self._answer_or_not()
        self.device.write_registers(address, words)

    async def close(self) -> None:
        self.silent = True

    def _answer_or_not(self) -> None:
        if self.silent:
            self._lost += 1
            raise DriveSilent("There is no answer.")

    async def _reply(self, request: str) -> None:
        if self.loses(request):
            self._lost += 1
            raise DriveSilent("The reply was lost.")
        if self.holds(request):
            self.held.set()
            await self._released.wait()


@dataclass
class LinkedRig(Rig):
    """A tracker with a drive on each axis, and the two ways to them."""

    links: dict[Axis, DirectLink] = field(default_factory=dict)

    def switch_off(self, axis: Axis) -> None:
        """Switch a CiA 402 motor off, as somebody else would."""
        self.links[axis].device.write_registers(CONTROLWORD, [0])

    def statusword(self, axis: Axis) -> int:
        """Return what a CiA 402 drive says about itself."""
        return self.links[axis].device.read_registers(3, STATUSWORD, 1)[0]

    def another_drive(self, profile_name: str) -> TwoAxisDrive:
        """Return a drive that knows nothing of what was commanded before, as after a restart."""
        profile = load_profile(profile_name)
        axes: dict[Axis, RegisterAxis] = {}
        for axis, link in self.links.items():
            unit = Unit(profile, link, str(axis))
            gearing = gearing_of(profile, AxisDrive(gear_ratio=GEAR_RATIO))
            settings = CONFIG.axis(axis)
            dialect = DIALECTS[profile.adapter](unit, gearing, settings.acceleration_dps2)
            axes[axis] = RegisterAxis(dialect, unit, gearing, settings, self.clock)
        return TwoAxisDrive(CONFIG, profile, axes, self.clock, "here")


def linked_rig(profile_name: str) -> LinkedRig:
    """Return the drive of a profile with a direct link to the simulated device of each axis."""
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock, watchdog=None)
    found = devices(load_profile(profile_name), machine, clock, 1, GEAR_RATIO)
    links = {axis: DirectLink(found[unit]) for axis, unit in zip(Axis, (1, 2), strict=True)}
    rig = LinkedRig(machine, machine, clock, devices=found, links=links)
    rig.drive = rig.another_drive(profile_name)
    return rig


def linked_controller() -> LinkedRig:
    """Return another tracker controller, which moves both axes, with a direct link to it."""
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock, watchdog=None)
    found = devices(load_profile("sunspec-601"), machine, clock, 1)
    rig = LinkedRig(machine, machine, clock, devices=found, links={Axis.AZIMUTH: DirectLink(found[1])})
    rig.drive = another_controller_drive(rig)
    return rig


def another_controller_drive(rig: LinkedRig) -> SunSpecDrive:
    """Return a drive on that controller that knows nothing of what was commanded before."""
    profile = load_profile("sunspec-601")
    return SunSpecDrive(CONFIG, profile, rig.links[Axis.AZIMUTH], rig.clock, "here")
