"""Another controller whose azimuth comes round: passing north is no jump, no number is out of its range."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import product

import pytest

from app.base.angles import wrap180
from app.base.clock import VirtualClock
from app.drives.dialects.azimuth_range import AzimuthRange
from app.drives.profile import PROFILES, parse_profile
from app.link.messages import ReleaseControl, SetClock, SetLocation
from app.sun.position import Location
from app.tracker.commands.commands import Home, Move, ResetFault, SelectMode, Stop, Track
from app.tracker.settings.axes import AZIMUTH_DEFAULT
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCommand, Position
from tests.amount import amount
from tests.site.far_controllers import RANGES, FarPlant, far_drive, far_plant
from tests.site.plant import SAMSUN

LIMITS = {"-170 to 170": (-170.0, 170.0), "0 to 360": (0.0, 360.0), "-200 to 200": (-200.0, 200.0)}
CAPE_TOWN = Location(-33.92, 18.42, 10.0)
SITES = {
    "south": (CAPE_TOWN, datetime(2027, 12, 21, 10, 41, tzinfo=UTC), 0.0),
    "north": (SAMSUN, datetime(2027, 6, 21, 9, 34, tzinfo=UTC), 180.0),
}
"""A site, an instant some minutes before its noon, and where the sun stands at noon."""
WAYS = amount([*zip(LIMITS, RANGES, strict=True)], [*product(LIMITS, RANGES)])
TICK = timedelta(milliseconds=100)


def config_of(limits: tuple[float, float]) -> TrackerConfig:
    axis = replace(AZIMUTH_DEFAULT, minimum_deg=limits[0], maximum_deg=limits[1])
    return TrackerConfig("T1", "Tracker 1", azimuth=axis, park=Orientation(0.0, 90.0))


@pytest.mark.parametrize(("limits", "range_name"), WAYS)
async def test_every_way_within_the_limits_is_gone_without_a_jump(limits: str, range_name: str) -> None:
    clock = VirtualClock(datetime(2027, 6, 21, tzinfo=UTC))
    config = config_of(LIMITS[limits])
    drive, controller = far_drive(config, clock, range_name)
    before = (await drive.read()).azimuth.position_deg
    low, high = LIMITS[limits]
    for target_deg in (low, high, low + 5.0, (low + high) / 2.0, high - 1.0, low, 0.0):
        for _ in range(900):
            await drive.write(DriveCommand(azimuth=Position(target_deg, 6.0)))
            clock.advance(TICK)
            seen = (await drive.read()).azimuth
            assert abs(seen.position_deg - before) <= 1.0, (before, seen.position_deg, target_deg)
            before = seen.position_deg
            if abs(before - target_deg) < 0.01 and not seen.moving:
                break
        assert before == pytest.approx(target_deg, abs=0.01)
    assert all(controller.low_deg <= one <= controller.high_deg for one in controller.written_deg)
    await drive.close()


NOONS = [
    (site, limits, range_name)
    for site, part in (("south", 5), ("north", 6))
    for limits, range_name in [*product(LIMITS, ("0 to 360", "-180 to 180"))][:: amount(part, 1)]
]


@pytest.mark.parametrize(("site", "limits", "range_name"), NOONS)
async def test_a_tracker_tracks_over_noon(site: str, limits: str, range_name: str) -> None:
    location, start, noon_deg = SITES[site]
    plant = far_plant(config_of(LIMITS[limits]), start, range_name)
    await plant.start()
    await commissioned(plant, location)
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    sides = set()
    for _ in range(30):
        await plant.forward(seconds=10)
        seen = plant.tracker()
        assert seen.fault is None
        assert seen.activity is ActivityName.TRACKING, seen
        assert seen.homed
        sides.add(wrap180(plant.far.machine.observe().azimuth.position_deg - noon_deg) > 0.0)
    assert sides == {False, True}, "noon was passed"
    assert plant.site.alive
    assert plant.far.low_deg <= min(plant.far.written_deg)
    assert max(plant.far.written_deg) <= plant.far.high_deg
    await plant.ask(Stop())
    await plant.close()


async def commissioned(plant: FarPlant, location: Location) -> None:
    await plant.ask(SetLocation(location, "UTC"))
    await plant.ask(SetClock("system"))
    await plant.ask(Home())
    await plant.until(lambda seen: seen.homed and seen.activity is ActivityName.HOLDING)
    await plant.ask(ReleaseControl("T1"))


@pytest.mark.parametrize("range_name", amount(["0 to 360"], [*RANGES]))
async def test_north_is_passed_with_a_move(range_name: str) -> None:
    plant = far_plant(config_of((-170.0, 170.0)), SITES["north"][1], range_name)
    await plant.start()
    await commissioned(plant, SAMSUN)
    for azimuth_deg, axis_deg in ((5.0, 5.0), (350.0, -10.0), (20.0, 20.0), (190.0, -170.0)):
        await plant.ask(Move(Orientation(azimuth_deg, 60.0)))
        await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
        seen = plant.tracker()
        assert seen.fault is None
        assert seen.homed
        assert seen.azimuth is not None
        assert seen.azimuth.position_deg == pytest.approx(axis_deg, abs=0.1)
    await plant.close()


async def test_a_target_that_is_refused_is_told_with_its_refusal() -> None:
    plant = far_plant(config_of((-170.0, 170.0)), SITES["north"][1], "0 to 360")
    await plant.start()
    await commissioned(plant, SAMSUN)
    plant.far.refuses_all = True
    await plant.ask(Move(Orientation(90.0, 60.0)))
    await plant.forward(seconds=3)
    fault = plant.tracker().fault
    assert fault is not None
    assert fault.code == "command_refused"
    assert "does not accept this value (Modbus exception 3)" in fault.message
    assert plant.site.alive
    await plant.ask(Stop())
    plant.far.refuses_all = False
    await plant.ask(ResetFault())
    await plant.forward(seconds=2)
    await plant.ask(Move(Orientation(90.0, 60.0)))
    await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
    assert plant.tracker().fault is None
    assert plant.far.machine.observe().azimuth.position_deg == pytest.approx(90.0, abs=0.1)
    await plant.close()


@pytest.mark.parametrize(
    ("range_name", "ends"), [("0 to 360", "0, maximum = 360"), ("-180 to 180", "-180, maximum = 180")]
)
async def test_a_range_in_the_profile_is_written_from_the_first_target_on(range_name: str, ends: str) -> None:
    text = (PROFILES / "sunspec-601.toml").read_text(encoding="utf-8")
    target = 'azimuth_target = { address = 40116, type = "int32"'
    assert target in text
    profile = parse_profile(text.replace(target, f"{target}, minimum = {ends}"), "own.toml")
    axis = replace(AZIMUTH_DEFAULT, minimum_deg=-200.0, maximum_deg=200.0)
    low_deg = RANGES[range_name][0]
    written = AzimuthRange(axis, profile.registers["azimuth_target"])
    assert not written.take_other(-10.0)
    for azimuth_deg in (-200, -180, -10, 0, 10, 179, 190, 200):
        assert written.count(azimuth_deg, 0.001) == (azimuth_deg - low_deg) % 360 * 1000 + low_deg * 1000
