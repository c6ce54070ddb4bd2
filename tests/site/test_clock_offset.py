"""A clock that runs away slowly: said from 30 s on, and from 5 minutes on nothing tracks."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import timedelta

import pytest

from app.link.messages import SetClock, TakeSighting
from app.site.clock.clock_offset import ClockOffset
from app.site.clock.ntp import KernelClock
from app.site.clock.timekeeping import Timekeeper
from app.tracker.commands.commands import Move
from app.tracker.memory.memory import ClockSetting
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName
from tests.fault_result import VIRTUAL, FaultResult
from tests.site.plant import Plant
from tests.site.tracking_field import homed

Record = Callable[[str, object], None]
CREEP = timedelta(seconds=1)


@dataclass
class WallClock:
    """The computer's wall clock: it creeps at every look, and NTP may keep it."""

    off: timedelta = timedelta(0)
    creeps: timedelta = timedelta(0)
    kernel: KernelClock | None = None

    def drift(self) -> timedelta:
        self.off += self.creeps
        return self.off


@pytest.fixture
def wall() -> WallClock:
    return WallClock()


async def tracking(wall: WallClock) -> Plant:
    plant = homed(tracks=True)
    plant.site.model.timekeeper = Timekeeper(
        plant.clock, ClockSetting("system"), drift=wall.drift, kernel=lambda: wall.kernel
    )
    await plant.start()
    await plant.until(lambda seen: seen.activity is ActivityName.TRACKING)
    return plant


async def raised_at(plant: Plant, wall: WallClock, code: str) -> timedelta:
    """Return how far the clock had crept when an alarm was raised."""
    while code not in plant.alarms():
        assert wall.off < timedelta(minutes=7), f"{code} was not raised"
        await plant.forward(seconds=0.5)
    return wall.off


@pytest.mark.fault(28)
async def test_a_clock_that_creeps_is_told_from_30_s_on_and_stops_tracking_from_5_minutes_on(
    wall: WallClock, fault: FaultResult
) -> None:
    plant = await tracking(wall)
    wall.creeps = CREEP
    drifts_at = await raised_at(plant, wall, "clock_drifts")
    assert timedelta(seconds=30) < drifts_at < timedelta(seconds=34)
    fault.noticed((drifts_at - timedelta(seconds=30)) / CREEP * 0.5, VIRTUAL)
    fault.shows(plant.alarms()["clock_drifts"])
    fault.recovers("automatic: when the clock is set or an NTP server keeps it")
    assert plant.tracker().activity is ActivityName.TRACKING
    assert plant.tracker().tracking_on

    off_at = await raised_at(plant, wall, "clock_off")
    assert timedelta(minutes=5) < off_at < timedelta(minutes=5, seconds=4)
    assert "clock_untrusted" in {reason.code for reason in plant.tracker().actions["track"]}
    assert "until the site's clock is trusted" in plant.tracker().activity_text
    stood = plant.tracker().measured
    await plant.forward(seconds=20)
    assert plant.tracker().measured == stood

    wall.creeps = timedelta(0)
    await plant.ask(SetClock("system"))
    await plant.forward(seconds=1)
    seen = plant.latest()
    assert seen.clock.trusted
    assert seen.clock.warnings == ()
    await plant.until(lambda shown: shown.setpoint is not None)
    await plant.close()


async def test_what_ntp_corrects_is_no_creeping(wall: WallClock) -> None:
    wall.kernel = KernelClock(synchronised=True, offset_s=-0.2)
    plant = await tracking(wall)
    wall.creeps = CREEP
    await plant.forward(seconds=30)
    seen = plant.latest()
    assert wall.off > timedelta(seconds=50)
    assert seen.clock.off_s == pytest.approx(0.2)
    assert seen.clock.trusted
    assert seen.clock.warnings == ()
    await plant.close()


@pytest.mark.parametrize(("seconds", "codes"), [(30, []), (31, ["clock_drifts"]), (-300, ["clock_drifts"])])
def test_the_edges_of_the_warning(seconds: int, codes: list[str]) -> None:
    offset = ClockOffset(None, timedelta(seconds=seconds))
    assert [reason.code for reason in offset.warnings()] == codes
    assert offset.reasons() == ()
    beyond = ClockOffset(None, timedelta(0), timedelta(seconds=-301))
    assert [reason.code for reason in beyond.reasons()] == ["clock_off"]
    assert "5.0 minutes slow" in beyond.reasons()[0].message
    assert beyond.warnings() == ()


@pytest.mark.fault(28)
async def test_views_of_the_sun_an_hour_apart_say_that_the_clock_is_wrong(plant: Plant) -> None:
    """The operator sets the clock 9 minutes slow, then turns the panel to the sun as it stands in the sky."""
    await plant.commission()
    slow = timedelta(minutes=9)
    await plant.ask(SetClock("manual", plant.site.model.now() - slow))
    for hours in (0.0, 1.5):
        plant.clock.advance(timedelta(hours=hours))
        await plant.forward(seconds=1)
        sky = plant.site.model.sky.sun(
            plant.site.model.state.location,
            plant.site.model.tracker("T1").config.algorithm,
            plant.clock.now(),
        )
        assert sky is not None
        await plant.ask(Move(Orientation(sky.azimuth_deg, sky.apparent_elevation_deg)))
        await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
        await plant.ask(TakeSighting("T1"))
    await plant.forward(seconds=1)
    seen = plant.latest()
    assert [reason.code for reason in seen.clock.reasons] == ["clock_off"]
    assert seen.clock.off_s == pytest.approx(-slow.total_seconds(), abs=30.0)
    assert "clock_untrusted" in {reason.code for reason in plant.tracker().actions["track"]}

    await plant.ask(TakeSighting("T1"))
    await plant.ask(SetClock("manual", plant.clock.now()))
    await plant.forward(seconds=1)
    seen = plant.latest()
    assert seen.clock.trusted
