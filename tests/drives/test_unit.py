"""What a device refuses once is not gone for ever, and not asked for again and again."""

from collections.abc import Sequence

from app.base.clock import VirtualClock
from app.drives.profile import load_profile
from app.drives.unit import Unit
from app.modbus.bus import Priority
from app.modbus.errors import DriveRefused
from app.simulation.devices.shelf import devices
from app.simulation.simulated import SimulatedDrive
from tests.drives.direct_link import GEAR_RATIO, DirectLink
from tests.drives.rigs import CONFIG, START

PROFILE = load_profile("kinco-cia402")


class MoodyLink(DirectLink):
    """Has one block answered with exception 2, illegal data address, while it is `moody`."""

    moody = True
    asked = 0

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        if address == PROFILE.registers["inputs"].address:
            self.asked += 1
            if self.moody:
                raise DriveRefused("There is no such register.")
        return await super().read(address, count, what=what, priority=priority)


def unit() -> tuple[Unit, MoodyLink]:
    clock = VirtualClock(START)
    found = devices(PROFILE, SimulatedDrive(CONFIG, clock, watchdog=None), clock, 1, GEAR_RATIO)
    link = MoodyLink(found[1])
    return Unit(PROFILE, link, "here"), link


async def polled(unit: Unit, names: Sequence[str] = ("position", "inputs")) -> set[str]:
    return set(await unit.poll(*names))


async def test_what_a_device_lacks_is_asked_for_once_a_connection() -> None:
    moody, link = unit()
    for _ in range(5):
        assert await polled(moody) == {"position"}
    assert (link.asked, moody.has("inputs")) == (1, False)
    link.renew()
    for _ in range(5):
        assert await polled(moody) == {"position"}
    assert (link.asked, moody.has("inputs")) == (2, False)


async def test_what_was_refused_in_a_moment_is_read_over_the_next_connection() -> None:
    moody, link = unit()
    assert await polled(moody) == {"position"}
    link.moody = False
    assert await polled(moody) == {"position"}
    link.renew()
    assert await polled(moody) == {"position", "inputs"}
    assert moody.has("inputs")
