"""Only a clock of 1970 to 2099 can be right: others are refused, set aside where stored, and not trusted."""

from datetime import UTC, datetime, timedelta, timezone

import pytest

from app.base.clock import VirtualClock
from app.link.messages import SetClock
from app.site.clock.timekeeping import Timekeeper
from app.site.startup import begin
from app.store.store import JournalFilter
from app.store.writer import DatabaseWriter
from app.tracker.commands.commands import Stop
from app.tracker.memory.memory import ClockSetting, SiteState
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.fault_result import FaultResult
from tests.site.direct_writer import DirectWriter
from tests.site.plant import SAMSUN, SUMMER_NOON, Begun, Plant, make_plant

EAST, WEST = timezone(timedelta(hours=14)), timezone(timedelta(hours=-12))
NEVER = [
    datetime(1, 1, 1, tzinfo=UTC),
    datetime(1, 1, 1, tzinfo=EAST),
    datetime(1969, 12, 31, 23, 59, tzinfo=UTC),
    datetime(1970, 1, 1, tzinfo=EAST),
    datetime(2099, 12, 31, 23, 59, tzinfo=WEST),
    datetime(2100, 1, 1, tzinfo=UTC),
    datetime(2206, 6, 1, tzinfo=UTC),
    datetime(9999, 12, 30, tzinfo=UTC),
    datetime(9999, 12, 31, 23, 59, 52, tzinfo=UTC),
    datetime(9999, 12, 31, 23, 59, 59, tzinfo=WEST),
]


@pytest.mark.fault(102)
async def test_a_clock_of_other_years_is_refused_and_tracking_goes_on(
    tracked: Plant, fault: FaultResult
) -> None:
    before = tracked.site.model.state.clock
    for at in NEVER:
        with pytest.raises(ValueError, match=r"Enter a year from 1970 to 2099|cannot be 1970") as refused:
            await tracked.ask(SetClock("manual", at))
        fault.shows(str(refused.value))
        await tracked.forward(seconds=0.5)
        assert tracked.site.alive
    assert tracked.tracker().activity is ActivityName.TRACKING
    assert tracked.site.model.state.clock == before


@pytest.mark.fault(102)
@pytest.mark.parametrize("at", [at for at in NEVER if at.year in (1969, 2100, 2206)], ids=str)
async def test_a_system_clock_of_other_years_is_not_trusted_and_nothing_ends(
    at: datetime, fault: FaultResult, begun: Begun
) -> None:
    plant = await begun(start=at, state=SiteState(location=SAMSUN, clock=ClockSetting("system")))
    await plant.forward(seconds=2)
    clock = plant.site.model.timekeeper.state()
    assert [one.code for one in clock.reasons] == ["clock_implausible"]
    assert not clock.trusted
    assert clock.reasons[0].message == f"The clock shows the year {at.year}, which cannot be right."
    fault.shows(clock.reasons[0].message.replace(str(at.year), "YEAR"))
    told = await plant.ask(Stop())
    assert told.sun is None or at.year == 1969
    assert plant.site.alive
    with pytest.raises(ValueError, match=r"a year|was built"):
        await plant.ask(SetClock("system"))


async def test_a_clock_that_runs_into_other_years_is_no_longer_trusted(begun: Begun) -> None:
    last = datetime(2099, 12, 31, 23, 59, 58, tzinfo=UTC)
    plant = await begun(start=last, state=SiteState(location=SAMSUN, clock=ClockSetting("system")))
    assert plant.site.model.timekeeper.state().trusted
    await plant.forward(seconds=4)
    assert not plant.site.model.timekeeper.state().trusted
    assert plant.site.alive
    await plant.ask(Stop())


@pytest.mark.parametrize("offset_s", [2.5e11, -6.4e10, 1e300, float("inf"), float("nan"), 6e9])
def test_an_offset_that_was_kept_and_shows_other_years_is_set_aside(offset_s: float) -> None:
    keeper = Timekeeper(VirtualClock(SUMMER_NOON), ClockSetting("manual", offset_s))
    assert keeper.now() == SUMMER_NOON
    assert [one.code for one in keeper.reasons()] == ["clock_unset"]


@pytest.mark.fault(102)
async def test_a_site_with_the_year_9999_starts_and_says_so(store: DatabaseWriter) -> None:
    store.save_site(SiteState("Samsun", SAMSUN, clock=ClockSetting("manual", 251_600_000_000.0)))
    found = begin(store, SUMMER_NOON, unclean_since=None)
    plant = make_plant(state=found.site, trackers=found.trackers, writer=DirectWriter(store))
    await plant.start()
    await plant.forward(seconds=2)
    assert plant.site.alive
    assert (plant.site.model.state.name, plant.site.model.state.location) == ("Samsun", SAMSUN)
    assert [one.code for one in plant.site.model.timekeeper.reasons()] == ["clock_unset"]
    await plant.close()
    said = [
        one.event.message
        for one in store.journal(JournalFilter())
        if one.event.kind is EventKind.CONFIG_REJECTED
    ]
    assert said == [
        "Stored settings of Samsun were rejected at startup: Clock: stored +2.516e+11 s, used none "
        "(Enter a year from 1970 to 2099.)"
    ]
    assert store.site() == found.site, "the next start finds what is used"


async def test_a_clock_that_shows_1970_is_implausible_cannot_be_confirmed_and_can_be_set(
    begun: Begun,
) -> None:
    plant = await begun(start=datetime(1970, 1, 1, tzinfo=UTC), state=SiteState(clock=ClockSetting("system")))
    (reason,) = plant.site.model.timekeeper.reasons()
    assert "1970-01-01 00:00" in reason.message
    with pytest.raises(ValueError, match="The clock cannot be 1970-01-01 00:00 UTC"):
        await plant.ask(SetClock("system"))
    with pytest.raises(ValueError, match="The clock cannot be 1971"):
        await plant.ask(SetClock("manual", datetime(1971, 1, 1, tzinfo=UTC)))
    await plant.ask(SetClock("manual", SUMMER_NOON))
    assert plant.site.model.now() == SUMMER_NOON
    assert plant.site.model.timekeeper.state().trusted
