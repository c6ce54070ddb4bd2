"""Other tracker controllers with SunSpec model 601, as a site meets them: each with a range of its own."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime

from app.base.angles import wrap180
from app.base.clock import VirtualClock
from app.drives.dialects.sunspec import SunSpecDrive
from app.drives.drive import Drive
from app.drives.profile import load_profile
from app.modbus.bus import Priority
from app.modbus.device_exceptions import refusal
from app.modbus.server import ILLEGAL_VALUE, Refusal
from app.simulation.devices.sunspec import AZIMUTH_MANUAL, AZIMUTH_POSITION, SunSpecTracker
from app.simulation.simulated import SimulatedDrive
from app.simulation.simulated_machine import SimulatedMachine
from app.site.site import Site, SiteOptions
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.motion import AxisFeedback, Position
from tests.drives.direct_link import DirectLink
from tests.site.plant import Plant

RANGES = {"0 to 360": (0.0, 360.0), "-180 to 180": (-180.0, 180.0), "turns": (-540.0, 540.0)}


class FarController(SunSpecTracker):
    """A controller with a range, which refuses targets outside it; `spoiled` words are read instead."""

    def __init__(self, machine: SimulatedMachine, clock: VirtualClock, range_name: str) -> None:
        self.low_deg, self.high_deg = RANGES[range_name]
        self.spoiled: dict[int, int] = {}
        self.refuses_all = False
        self.written_deg: list[float] = []
        super().__init__(machine, clock)

    @property
    def counts_turns(self) -> bool:
        return self.high_deg - self.low_deg > 360.0

    def refresh(self, feedback: AxisFeedback, fault_code: int) -> None:
        super().refresh(feedback, fault_code)
        azimuth_deg = self.machine.observe().azimuth.position_deg
        if self.counts_turns:
            self.put_wide(AZIMUTH_POSITION, self.steps(azimuth_deg))
        elif self.low_deg < 0.0:
            self.put_wide(AZIMUTH_POSITION, self.steps(wrap180(azimuth_deg)))

    def act(self, written: Collection[int]) -> None:
        super().act(written)
        if self.counts_turns and AZIMUTH_MANUAL in written:
            self.machine.turn(Axis.AZIMUTH, Position(self.wide(AZIMUTH_MANUAL) / self.steps_per_deg, 6.0))

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        words = super().read_registers(function, address, count)
        return [self.spoiled.get(address + place, word) for place, word in enumerate(words)]

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        place = AZIMUTH_MANUAL - address
        if 0 <= place < len(words) - 1:
            value = words[place] << 16 | words[place + 1]
            azimuth_deg = (value - (value >> 31 << 32)) / self.steps_per_deg
            if self.refuses_all or not self.low_deg <= azimuth_deg <= self.high_deg:
                raise Refusal(ILLEGAL_VALUE)
            self.written_deg.append(azimuth_deg)
        super().write_registers(address, words)


class FarLink(DirectLink):
    """The way to it: what it refuses comes back as over Modbus."""

    def __str__(self) -> str:
        return "10.0.0.7:502 unit 1"

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        try:
            return await super().read(address, count, what=what, priority=priority)
        except Refusal as refused:
            raise refusal(refused.code, self, what) from refused

    async def write(
        self,
        address: int,
        words: Sequence[int],
        *,
        what: str,
        ticket: int | None,
        priority: Priority = Priority.COMMAND,
    ) -> None:
        try:
            await super().write(address, words, what=what, ticket=ticket, priority=priority)
        except Refusal as refused:
            raise refusal(refused.code, self, what) from refused

    async def stop(self, address: int, words: Sequence[int], *, what: str) -> None:
        try:
            await super().stop(address, words, what=what)
        except Refusal as refused:
            raise refusal(refused.code, self, what) from refused


@dataclass
class FarPlant(Plant):
    """A site with one tracker that another controller moves."""

    controller: FarController | None = None

    @property
    def far(self) -> FarController:
        assert self.controller is not None
        return self.controller


def far_drive(
    config: TrackerConfig, clock: VirtualClock, range_name: str
) -> tuple[SunSpecDrive, FarController]:
    """Return a drive on a controller of its own; the machine is as wide as it can be."""
    wide = replace(config.azimuth, minimum_deg=-700.0, maximum_deg=700.0)
    machine = SimulatedDrive(replace(config, azimuth=wide), clock, watchdog=None)
    controller = FarController(machine, clock, range_name)
    link = FarLink(controller)
    return SunSpecDrive(config, load_profile("sunspec-601"), link, clock, str(link)), controller


def far_plant(config: TrackerConfig, start: datetime, range_name: str) -> FarPlant:
    """Return the site of such a tracker, on the virtual clock."""
    clock = VirtualClock(start)
    drive, controller = far_drive(config, clock, range_name)
    make: Callable[[TrackerConfig], Drive] = lambda _: drive  # noqa: E731
    state = TrackerState(config, TrackerMemory())
    site = Site(clock, make, SiteState(), (state,), options=SiteOptions())
    drives: Mapping[str, Drive] = {"T1": drive}
    return FarPlant(clock, site, dict(drives), controller=controller)
