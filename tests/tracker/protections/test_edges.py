"""The edges of hysteresis: what equals a limit has not left it yet."""

from datetime import UTC, datetime, timedelta

import pytest

from app.tracker.protections import guarding, low_light, wind_stow
from app.tracker.protections.guarding import OFF_GUARD
from app.tracker.protections.low_light import AWAKE, LowLight
from app.tracker.protections.wind_stow import CALM, Wind, WindStow
from app.tracker.protections.words import Protection
from app.tracker.settings.protections import LightProtection, ProtectionConfig, WindProtection
from app.tracker.weather.weather import Quality, Reading, Sensed

NOW = datetime(2026, 6, 21, 6, 0, tzinfo=UTC)
LIMITS = WindProtection(gust_mps=17.0, mean_mps=15.0, hysteresis_mps=2.0)
LIGHT = LightProtection(threshold_wm2=50.0, hysteresis_wm2=10.0)


@pytest.mark.parametrize(
    ("wind", "calm"),
    [
        (Wind(14.9, 12.9), True),
        (Wind(15.0, 12.9), False),
        (Wind(14.9, 13.0), False),
        (Wind(14.9, None), True),
        (Wind(None, 12.9), False),
    ],
)
def test_wind_is_calm_below_its_limits_less_the_hysteresis(wind: Wind, *, calm: bool) -> None:
    held = WindStow(NOW, NOW)
    later = NOW + timedelta(seconds=601)
    assert wind_stow.step(held, LIMITS, wind, later) == (CALM if calm else WindStow(NOW, later))


def test_light_must_rise_by_the_hysteresis_once_it_was_too_dark() -> None:
    dark = low_light.step(AWAKE, LIGHT, 49.9, NOW)
    assert dark == LowLight(None, NOW, False)
    assert low_light.step(AWAKE, LIGHT, 50.0, NOW).light_ok
    assert not low_light.step(dark, LIGHT, 59.9, NOW).light_ok
    assert low_light.step(dark, LIGHT, 60.0, NOW).light_ok


def test_an_unknown_light_keeps_what_was_known_and_begins_the_delay_anew() -> None:
    later = NOW + timedelta(seconds=300)
    assert low_light.step(LowLight(None, NOW, False), LIGHT, None, later) == LowLight(None, later, False)
    resting = LowLight(NOW, NOW, False)
    assert low_light.step(resting, LIGHT, None, later) is resting


def air(gust_mps: float | None, mean_mps: float | None) -> Sensed:
    wind = Reading() if gust_mps is None else Reading(gust_mps, Quality.GOOD, 0.0)
    return Sensed(wind, wind_mean_mps=mean_mps)


def test_the_mean_wind_stows_too_but_only_while_the_sensor_is_well() -> None:
    config = ProtectionConfig(wind=LIMITS)
    for gust_mps, mean_mps, kind in (
        (10.0, 15.0, Protection.WIND_STOW),
        (10.0, 14.9, Protection.TRACK),
        (10.0, None, Protection.TRACK),
        (None, 15.0, Protection.TRACK),
    ):
        seen = air(gust_mps, mean_mps)
        assert guarding.step(OFF_GUARD, config, seen, (), NOW, night=False).kind is kind


def test_what_holds_is_known_since_it_began() -> None:
    config, later = ProtectionConfig(wind=LIMITS), NOW + timedelta(seconds=5)
    begun = guarding.step(OFF_GUARD, config, air(20.0, 5.0), (), NOW, night=False)
    assert (begun.kind, begun.since) == (Protection.WIND_STOW, NOW)
    assert guarding.step(begun, config, air(20.0, 5.0), (), later, night=False).since == NOW
    over = later + timedelta(seconds=700)
    ended = guarding.step(begun, config, air(3.0, 5.0), (), over, night=True)
    assert (ended.kind, ended.since) == (Protection.NIGHT, over)
