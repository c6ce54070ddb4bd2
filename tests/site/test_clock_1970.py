"""A computer that begins in 1970: nothing relies on its clock, and nobody can say that it is right."""

from datetime import UTC, datetime

import pytest

from app.base.clock import VirtualClock
from app.link.messages import SetClock
from app.site.clock.timekeeping import Timekeeper
from app.tracker.memory.memory import ClockSetting
from tests.site.plant import Begun

BEGINNING = datetime(1970, 1, 1, tzinfo=UTC)
TODAY = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)


def test_a_clock_that_shows_1970_is_implausible_though_it_was_trusted_before() -> None:
    """On a computer whose journal is new nothing but the software's own age tells it."""
    keeper = Timekeeper(VirtualClock(BEGINNING), ClockSetting("system"))
    (reason,) = keeper.reasons()
    assert reason.code == "clock_implausible"
    assert "The clock shows 1970-01-01 00:00 UTC" in reason.message
    assert not keeper.state().trusted


async def test_a_clock_that_shows_1970_cannot_be_confirmed_and_can_be_set(begun: Begun) -> None:
    plant = await begun(start=BEGINNING)
    with pytest.raises(ValueError, match="The clock cannot be 1970-01-01 00:00 UTC"):
        await plant.ask(SetClock("system"))
    with pytest.raises(ValueError, match="The clock cannot be 1971"):
        await plant.ask(SetClock("manual", datetime(1971, 1, 1, tzinfo=UTC)))
    await plant.ask(SetClock("manual", TODAY))
    assert plant.site.model.now() == TODAY
    assert plant.site.model.timekeeper.state().trusted
