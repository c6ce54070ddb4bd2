"""After a restart what held still holds, and its time begins anew."""

from datetime import UTC, datetime, timedelta

import pytest

from app.tracker.protections.guarding import OFF_GUARD, Guarding, latched, step
from app.tracker.protections.snow import Snow
from app.tracker.protections.wind_stow import CALM, WindStow
from app.tracker.protections.words import Protection
from app.tracker.settings.protections import PROTECTED, StowName
from app.tracker.weather.weather import Quality, Quantity, Reading, Sensed

NOW = datetime(2026, 6, 21, 6, 0, tzinfo=UTC)
CALM_AIR = Sensed(
    Reading(3.0, Quality.GOOD, 0.0), Reading(0.0, Quality.GOOD, 0.0), Reading(600.0, Quality.GOOD, 0.0), 3.0
)


def test_a_storm_that_held_holds_for_the_whole_delay_again() -> None:
    state = latched(Protection.WIND_STOW, NOW)
    assert state == Guarding(wind_stow=WindStow(NOW, NOW), kind=Protection.WIND_STOW, since=NOW)
    assert state.stow is StowName.WIND
    for seconds, holds in ((600.0, Protection.WIND_STOW), (600.1, Protection.TRACK)):
        now = NOW + timedelta(seconds=seconds)
        assert step(state, PROTECTED, CALM_AIR, (Quantity.WIND,), now, night=False).kind is holds


def test_snow_that_held_holds_until_it_is_seen_gone() -> None:
    state = latched(Protection.SNOW, NOW)
    assert state == Guarding(snow=Snow(NOW), kind=Protection.SNOW, since=NOW)
    assert state.stow is StowName.SNOW
    assert step(state, PROTECTED, Sensed(), (), NOW, night=False).kind is Protection.SNOW
    assert step(state, PROTECTED, CALM_AIR, (), NOW, night=False).kind is Protection.TRACK


@pytest.mark.parametrize(
    "kind", [None, Protection.NIGHT, Protection.WAIT, Protection.LOW_LIGHT_HOLD, Protection.TRACK]
)
def test_nothing_else_is_kept(kind: Protection | None) -> None:
    assert latched(kind, NOW) is OFF_GUARD


def test_the_earliest_end_is_known_only_while_it_holds() -> None:
    ends = NOW + timedelta(seconds=600)
    assert WindStow(NOW, NOW).earliest_end(PROTECTED.wind) == ends
    assert CALM.earliest_end(PROTECTED.wind) is None
    assert WindStow(None, NOW).earliest_end(PROTECTED.wind) is None
    assert WindStow(NOW, None).earliest_end(PROTECTED.wind) is None
