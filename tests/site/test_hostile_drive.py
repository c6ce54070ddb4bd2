"""A drive that reports numbers which no machine can have: its tracker holds, and nothing else follows."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, nan
from typing import Any

import pytest

from app.drives.drive import Drive
from app.tracker.commands.commands import Stop, Track
from app.tracker.values.motion import Feedback, LightPair, LightReading
from tests.amount import amount
from tests.fault_result import BY_ITSELF, FaultResult
from tests.site.plant import Begun, Plant
from tests.site.tracking_field import homed
from tests.site.wrapped_drive import WrappedDrive

NUMBERS = amount((nan, -inf, 1e308, -1e7), (nan, inf, -inf, 1e308, -1e308, 1e20, -1e7))
COUNTS = amount((-1, 2**70), (-1, 2**31, 2**63, 2**70))
REFUSED = "The drive reports a number that is impossible."
Change = Callable[[Feedback], Feedback]


@dataclass
class LyingDrive(WrappedDrive):
    """A drive whose report is changed on the way."""

    change: Change | None = None

    async def read(self) -> Feedback:
        seen = await self.inner.read()
        return seen if self.change is None else self.change(seen)


def of_axis(axis: str, name: str, number: float) -> Change:
    return lambda seen: replace(seen, **{axis: replace(getattr(seen, axis), **{name: number})})


def of_all(**values: Any) -> Change:
    return lambda seen: replace(seen, **values)


IMPOSSIBLE = {
    f"{axis} {name} {number}": of_axis(axis, name, number)
    for axis in ("azimuth", "elevation")
    for name in ("position_deg", "velocity_dps")
    for number in NUMBERS
} | {
    f"{name} {number}": of_all(**{name: value})
    for number in NUMBERS
    for name, value in (
        ("supply_v", number),
        ("light", LightReading(LightPair(number, 1.0), LightPair(1.0, 2.0))),
    )
}
ODD = {
    f"{name} {count}": of_all(**{name: count})
    for name in ("boot_count", "fault_code", "request_done")
    for count in COUNTS
}


def lying(drive: Drive) -> LyingDrive:
    return LyingDrive(drive)


async def report(plant: Plant, change: Change, refused: bool, name: str) -> None:
    """Have the drive report a number, stop, and report well again; the controller goes on all the while."""
    drive = plant.drives["T1"]
    assert isinstance(drive, LyingDrive)
    drive.change = change
    await plant.forward(seconds=0.5)
    assert plant.site.alive, name
    assert plant.site.model.tracker("T1").broken is None, name
    assert (REFUSED in notices(plant)) is refused, name
    await plant.ask(Stop())
    drive.change = None
    await plant.forward(seconds=0.5)
    assert plant.site.alive, name
    assert REFUSED not in notices(plant), name


def notices(plant: Plant) -> list[str]:
    return [one.message for one in plant.tracker().notices]


@pytest.mark.fault(98)
@pytest.mark.parametrize("tracks", [False, True], ids=["at rest", "tracking"])
async def test_no_number_of_a_drive_ends_the_controller(
    tracks: bool, fault: FaultResult, begun: Begun
) -> None:
    """One controller meets what is impossible, one after the other; a code that is odd may be a fault."""
    plant = await begun(homed(tracks=tracks, wrap=lying))
    await plant.forward(seconds=0.5)
    for name, change in IMPOSSIBLE.items():
        await report(plant, change, True, name)
        if tracks:
            await plant.ask(Track())
            await plant.forward(seconds=0.3)
    for name, change in ODD.items():
        plant = await begun(homed(tracks=tracks, wrap=lying))
        await plant.forward(seconds=0.5)
        await report(plant, change, False, name)
        await plant.close()
    fault.shows(REFUSED)
    fault.recovers(BY_ITSELF)
