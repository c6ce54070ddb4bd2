"""In how long a show is usually run: what is proposed works, and says why it takes longer than most."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from app.sun.daylight import daylight
from app.sun.position import Algorithm, Location
from app.tracker.mounts.capabilities import abilities, default_mode
from app.tracker.mounts.usual import mounted
from app.tracker.programs.plan import ShowPlan
from app.tracker.programs.show import check_show, schedule_of
from app.tracker.programs.usual import in_usual_time
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.settings.strategy import Interval
from app.tracker.values.mode import Mode
from tests.amount import amount
from tests.tracker.shows import (
    DAY,
    PLAIN,
    SAMSUN,
    SOLSTICE,
    SOUTH,
    SVALBARD,
    SYDNEY,
    TROPIC,
    show,
    utc,
    with_range,
)
from tests.tracker.shows import daylight as sunny

THREE = timedelta(minutes=3)


def test_most_shows_take_three_minutes_and_in_the_south_longer_because_the_panel_turns_back() -> None:
    for plan, tracker in ((SOLSTICE, PLAIN), (SOUTH, with_range(-180.0, 180.0))):
        found = in_usual_time(plan, tracker)
        assert (found.plan.duration, found.check.feasible, found.longer) == (THREE, True, None)
    found = in_usual_time(SOUTH, PLAIN)
    assert found.check.feasible
    assert found.plan.duration == timedelta(minutes=5)
    assert found.longer is not None
    assert found.longer.message == "3 minutes are too short here: the panel must turn back at north."


def turning(speed_dps: float, least_deg: float, most_deg: float) -> TrackerConfig:
    return replace(PLAIN, azimuth=AxisConfig(least_deg, most_deg, speed_dps, 6.0, 0.5, 0.5))


@pytest.mark.parametrize(
    ("plan", "tracker", "why"),
    [
        (SOLSTICE, turning(1.0, 0.0, 360.0), "the axes cannot turn that fast."),
        (SOLSTICE, turning(6.0, -180.0, 180.0), "the panel must turn back at south."),
        (sunny(SYDNEY, utc(2026, 7, 10, 14), 180.0), turning(4.0, 10.0, 365.0), "turn back at its end stop."),
        (sunny(TROPIC, utc(2026, 7, 2), 180.0), turning(4.2, 0.0, 360.0), "where the sun is highest."),
        (
            show(SAMSUN, utc(2026, 6, 21, 16, 50), utc(2026, 6, 22, 2, 30), 60.0),
            turning(1.2, 0.0, 360.0),
            "travel to the next sunrise takes longer than the night.",
        ),
        (
            replace(SOLSTICE, schedule=schedule_of(Interval(minutes=1))),
            turning(4.0, 0.0, 360.0),
            "a move must finish before the next one begins.",
        ),
    ],
    ids=["speed", "south", "end stop", "zenith", "night", "moves"],
)
def test_why_it_takes_longer_is_told_in_one_sentence(
    plan: ShowPlan, tracker: TrackerConfig, why: str
) -> None:
    found = in_usual_time(plan, tracker)
    assert found.check.feasible
    assert found.plan.duration > THREE
    assert found.longer is not None
    assert found.longer.message.startswith("3 minutes are too short here: ")
    assert found.longer.message.endswith(why)


def test_where_no_length_works_the_first_is_returned_with_its_reasons() -> None:
    night = show(SVALBARD, utc(2026, 12, 21), utc(2026, 12, 22), 60.0)
    found = in_usual_time(night, PLAIN)
    assert found.plan.duration == THREE
    assert [reason.code for reason in found.check.reasons] == ["sun_never_up"]
    assert found.check.reasons[0].message.startswith("It is polar night")
    assert found.longer is None


@settings(max_examples=amount(8, 80), deadline=None)
@given(
    latitude_deg=st.floats(-66.0, 66.0),
    longitude_deg=st.floats(-180.0, 180.0),
    day=st.integers(0, 72_000),
    kind=st.sampled_from(MountKind),
    as_usual=st.booleans(),
    choose=st.sampled_from((None, *Mode)),
)
def test_on_any_day_with_a_sunrise_the_usual_length_works(
    latitude_deg: float, longitude_deg: float, day: int, kind: MountKind, as_usual: bool, choose: Mode | None
) -> None:
    place, begin = Location(latitude_deg, longitude_deg), datetime(1901, 2, 1, tzinfo=UTC)
    begin += timedelta(days=day)
    lit = daylight(Algorithm.PSA, place, begin, begin + DAY)
    assume(lit is not None)
    assert lit is not None
    upright = kind is MountKind.AZIMUTH_ELEVATION and not as_usual
    tracker = PLAIN if upright else mounted(PLAIN, kind, latitude_deg)
    mode = choose if choose in abilities(tracker.mount).modes else default_mode(tracker.mount)
    assert mode is not None
    found = in_usual_time(show(place, *lit, 60.0, mode=mode), tracker)
    assert found.check.feasible, found.check.reasons
    assert found.plan.duration <= timedelta(minutes=10)
    assert check_show(found.plan, tracker).feasible
    assert (found.longer is None) == (found.plan.duration == THREE)
