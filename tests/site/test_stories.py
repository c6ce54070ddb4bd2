"""A site lives: it is commissioned, jogs, tracks, stops and tells what happened."""

from datetime import timedelta

import pytest

from app.base.angles import separation_deg
from app.link.messages import SetLocation
from app.sun.position import Location
from app.tracker.commands.commands import CommandRejected, EndJog, Jog, SelectMode, Stop, Track
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from tests.site.plant import Plant


async def test_a_commissioned_tracker_follows_the_sun(plant: Plant) -> None:
    await plant.commission()
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    await plant.until(lambda seen: seen.in_position)
    await plant.forward(seconds=120)

    seen = plant.tracker()

    assert seen.activity is ActivityName.TRACKING
    assert seen.off_sun_deg is not None
    assert seen.off_sun_deg <= 0.5
    assert seen.measured is not None
    assert seen.sun is not None
    assert (
        separation_deg(
            seen.measured.azimuth_deg,
            seen.measured.elevation_deg,
            seen.sun.azimuth_deg,
            seen.sun.apparent_elevation_deg,
        )
        <= 0.5
    )


async def test_a_jog_that_is_not_renewed_ends_with_its_lease(plant: Plant) -> None:
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1, JogSpeed.FAST))
    await plant.forward(seconds=0.2)
    assert plant.tracker().activity is ActivityName.JOGGING

    await plant.forward(seconds=0.05)
    await plant.forward(seconds=1.0)

    assert plant.tracker().activity is ActivityName.HOLDING
    assert not plant.site.model.tracker("T1").moving
    assert [event.kind for event in plant.happened(EventKind.JOG_ENDED)] == [EventKind.JOG_ENDED]


async def test_the_lease_is_judged_to_the_instant_and_not_at_the_next_tick(plant: Plant) -> None:
    begun = plant.clock.now()
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1, lease=timedelta(milliseconds=130)))
    plant.clock.move_to(begun + timedelta(milliseconds=130))
    await plant.forward(seconds=0.001)

    assert plant.tracker().activity is not ActivityName.JOGGING


async def test_a_dead_press_never_moves_again(plant: Plant) -> None:
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.ask(EndJog("p1"))

    with pytest.raises(CommandRejected) as refused:
        await plant.ask(Jog("p1", Axis.AZIMUTH, 1, sequence=1))

    assert [reason.code for reason in refused.value.reasons] == ["press_dead"]


async def test_stop_ends_tracking_and_stays_stopped(plant: Plant) -> None:
    await plant.commission()
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())
    await plant.forward(seconds=1)
    assert plant.site.model.tracker("T1").moving

    await plant.ask(Stop())
    await plant.forward(seconds=3)
    stopped = plant.tracker()
    await plant.forward(seconds=60)

    assert stopped.activity is ActivityName.HOLDING
    assert plant.tracker().measured == stopped.measured
    assert plant.tracker().tracking_on is False
    assert plant.happened(EventKind.STOPPED)[0].actor == "technician"


async def test_tracking_is_refused_with_every_reason(plant: Plant) -> None:
    with pytest.raises(CommandRejected) as refused:
        await plant.ask(Track())

    assert len(refused.value.reasons) >= 3
    assert all(reason.message.endswith(".") for reason in refused.value.reasons)


async def test_a_new_place_is_refused_while_a_tracker_follows_the_sun(plant: Plant) -> None:
    await plant.commission()
    await plant.ask(SelectMode(Mode.DUAL))
    await plant.ask(Track())

    with pytest.raises(CommandRejected, match="T1 is tracking the sun"):
        await plant.ask(SetLocation(Location(10.0, 10.0), "UTC"))
