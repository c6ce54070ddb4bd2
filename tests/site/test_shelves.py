"""A shelved alarm over a restart of the controller, whose clock was ahead before it or is behind after it."""

import pytest

from app.alarms.conditions import Condition
from app.link.alarm_orders import ShelveAlarm
from app.site.startup import begin
from app.store.writer import DatabaseWriter
from app.tracker.values.alarm_words import AlarmState
from tests.golden.table import ClockRow, clocks
from tests.site.direct_writer import DirectWriter
from tests.site.plant import SUMMER_NOON, Plant, make_plant

JUMPED = "clock_jumped"


async def begun(plant: Plant) -> None:
    """Start a site that has this alarm."""
    await plant.start()
    plant.site.trouble("clock", Condition(JUMPED, None, "Site", "It jumped."))
    await plant.forward(seconds=1)


def state_of(plant: Plant) -> AlarmState:
    """Return how this alarm is told."""
    site = plant.site.latest()
    return next(alarm.state for alarm in site.alarms if alarm.alarm_id == JUMPED)


@pytest.mark.parametrize("row", clocks("shelf"))
async def test_no_shelf_lasts_beyond_a_day_after_the_clock_was_ahead(
    store: DatabaseWriter, row: ClockRow
) -> None:
    before = make_plant(start=SUMMER_NOON + row.stored, writer=DirectWriter(store))
    await begun(before)
    await before.ask(ShelveAlarm(JUMPED, 60, "The cable is being replaced."))
    assert state_of(before) is AlarmState.SHELVED
    await before.close()

    asked_at = SUMMER_NOON + row.asked + row.later
    beginning = begin(store, asked_at, unclean_since=None)
    after = make_plant(
        start=asked_at,
        writer=DirectWriter(store),
        state=beginning.site,
        trackers=beginning.trackers,
        alarms=beginning.alarms,
    )
    await begun(after)
    assert state_of(after) is (AlarmState.SHELVED if row.expected == "shelved" else AlarmState.UNACKNOWLEDGED)
    await after.close()
