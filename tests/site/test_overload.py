"""An overloaded controller leaves out what is not motion, tells it, and keeps every tick and every stop."""

import asyncio
from datetime import timedelta
from itertools import pairwise

import pytest

from app.link.messages import Order, StopAll
from app.link.weather_orders import ReportWeather
from app.simulation.simulated import SimulatedDrive
from app.simulation.simulated_machine import STOP_ALL
from app.site.loop.overload import BEGINS_AFTER, CODE, ENDS_AFTER, LATE_MS, Overload
from app.site.loop.scheduler import MOST_ASKED_AT_ONCE
from app.site.orders.site_orders import MOST_AT_ONCE as STOPPED_AT_ONCE
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.weather.weather import Weather
from app.web.services.metrics import exposition
from tests.fault_result import VIRTUAL, FaultResult
from tests.site.plant import SUMMER_NOON, Plant, settle
from tests.site.tracking_field import ONE_HZ, activities, field_of

FIELD = 100
LATE, ON_TIME = LATE_MS + 1.0, LATE_MS - 1.0


def seconds(judge: Overload, count: int, late_ms: float, *, of_ten: int = 10, begin: int = 0) -> None:
    """Let ten ticks a second come, so many of them late."""
    for tick in range(count * 10):
        at = SUMMER_NOON + timedelta(seconds=begin) + timedelta(milliseconds=100) * tick
        judge.count(late_ms if tick % 10 < of_ten else 0.0, at)


@pytest.mark.fault(75)
def test_an_overload_begins_after_two_bad_seconds_and_ends_after_ten_good_ones(fault: FaultResult) -> None:
    told: list[bool] = []
    judge = Overload(lambda one: told.append(one.active))
    seconds(judge, 1, LATE)
    assert not judge.active
    seconds(judge, BEGINS_AFTER + 1, LATE, begin=1)
    assert judge.active
    condition = judge.condition()
    assert condition is not None
    assert condition.message == "100 % of the ticks of a second began more than 30 ms late."
    seconds(judge, ENDS_AFTER - 1, ON_TIME, begin=4)
    assert judge.active
    seconds(judge, 3, ON_TIME, begin=13)
    assert not judge.active
    assert judge.condition() is None
    assert told == [True, False]
    fault.noticed(float(BEGINS_AFTER), VIRTUAL)
    fault.shows(condition.message)
    fault.recovers(f"automatic: after {ENDS_AFTER} s on time")


def test_one_pause_of_the_computer_and_single_late_ticks_are_no_overload() -> None:
    judge = Overload(lambda one: None)
    seconds(judge, 1, LATE)
    seconds(judge, 5, ON_TIME, begin=1)
    seconds(judge, 5, LATE, of_ten=2, begin=6)

    assert not judge.active


def test_an_overload_that_comes_back_within_ten_seconds_has_not_ended() -> None:
    told: list[bool] = []
    judge = Overload(lambda one: told.append(one.active))
    seconds(judge, 4, LATE)
    for begin in range(4, 40, 6):
        seconds(judge, 5, ON_TIME, begin=begin)
        seconds(judge, 1, LATE, begin=begin + 5)

    assert told == [True]


async def overload(plant: Plant, *, lasts_s: float) -> None:
    """Let time jump on by 90 ms again and again, as it does for a loop that is held up."""
    for _ in range(round(lasts_s / 0.09)):
        plant.clock.advance(timedelta(milliseconds=90))
        await plant.forward(seconds=0.001)


@pytest.mark.fault(73)
async def test_a_hundred_trackers_are_on_their_way_to_shelter_within_a_second_of_the_report() -> None:
    field = await field_of(FIELD)
    await field.ask(ReportWeather(Weather(wind_mps=28.0)))
    reported = field.clock.now()
    await field.forward(seconds=1)

    assert activities(field) == {ActivityName.STOWING}
    begun = [event.at for event in field.happened(EventKind.STOW_STARTED)]
    assert len(begun) == FIELD
    assert max(begun) - reported <= timedelta(milliseconds=150)
    await field.close()


@pytest.mark.fault(73)
async def test_five_hundred_trackers_that_tick_once_a_second_do_not_wait_for_their_ticks_to_stow() -> None:
    field = await field_of(500, period=ONE_HZ)
    await field.ask(ReportWeather(Weather(wind_mps=28.0)))
    for _ in range(500 // MOST_ASKED_AT_ONCE + 1):
        await settle()

    assert activities(field) == {ActivityName.STOWING}
    ticks = sum(loop.counter.ticks for loop in field.site.model.loops.values())
    await field.ask(ReportWeather(Weather(wind_mps=29.0)))
    await settle()
    assert sum(loop.counter.ticks for loop in field.site.model.loops.values()) == ticks
    reported = field.site.model.now()
    await field.forward(seconds=0.2)
    assert [event.at for event in field.happened(EventKind.STOW_STARTED)] == [reported] * 500
    await field.close()


@pytest.mark.fault(75)
async def test_an_overloaded_controller_tells_seldom_records_nothing_and_still_stops_at_once() -> None:
    field = await field_of(5)
    await overload(field, lasts_s=4)
    metrics = await field.site.metrics()
    assert metrics.overloaded
    assert b"heliopanel_overloaded 1.0" in exposition(metrics, 0)
    assert [one.code for one in field.site.publisher.newest.alarms] == [CODE]
    assert field.site.model.recorder.is_suspended
    ticks = {name: loop.counter.ticks for name, loop in field.site.model.loops.items()}
    told = field.site.publisher.newest.sequence
    await overload(field, lasts_s=3)
    assert field.site.publisher.newest.sequence - told <= 5
    assert all(field.site.model.tracker(name).counter.ticks - before >= 25 for name, before in ticks.items())

    await field.ask(StopAll())
    assert activities(field) <= {ActivityName.HOLDING, ActivityName.STOPPING}
    assert all(drive.is_resting or drive.command == STOP_ALL for drive in simulated(field))

    await field.forward(seconds=20)
    assert not (await field.site.metrics()).overloaded
    assert not field.site.model.recorder.is_suspended
    assert field.site.publisher.newest.sequence - told > 20
    became = [event for event in field.events if event.data.get("code") == CODE]
    assert [event.kind for event in became] == [EventKind.ALARM_RAISED, EventKind.ALARM_RETURNED]
    await field.close()


def simulated(plant: Plant) -> list[SimulatedDrive]:
    return [drive for drive in plant.drives.values() if isinstance(drive, SimulatedDrive)]


async def test_stop_all_lets_ticks_and_heartbeats_have_their_turn_between_the_trackers() -> None:
    field = await field_of(4 * STOPPED_AT_ONCE, period=ONE_HZ)
    asking = asyncio.create_task(field.site.execute(Order(StopAll(), "technician")))
    stopped = [0]
    while stopped[-1] < 4 * STOPPED_AT_ONCE:
        await asyncio.sleep(0)
        stopped.append(sum(not loop.memory.tracking_on for loop in field.site.model.loops.values()))
    assert max(after - before for before, after in pairwise(stopped)) == STOPPED_AT_ONCE
    while not asking.done():
        await settle()
    await field.close()
