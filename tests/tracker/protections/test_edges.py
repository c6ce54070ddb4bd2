"""The edges of hysteresis: what equals a limit has not left it yet."""

from datetime import UTC, datetime, timedelta

import pytest

from app.tracker.protections import hibernation, typhoon
from app.tracker.protections.config import LightProtection, WindProtection
from app.tracker.protections.hibernation import AWAKE, Hibernation
from app.tracker.protections.typhoon import CALM, Typhoon, Wind

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
    held = Typhoon(NOW, NOW)
    later = NOW + timedelta(seconds=601)
    assert typhoon.step(held, LIMITS, wind, later) == (CALM if calm else Typhoon(NOW, later))


def test_light_must_rise_by_the_hysteresis_once_it_was_too_dark() -> None:
    dark = hibernation.step(AWAKE, LIGHT, 49.9, NOW)
    assert dark == Hibernation(None, NOW, False)
    assert hibernation.step(AWAKE, LIGHT, 50.0, NOW).light_ok
    assert not hibernation.step(dark, LIGHT, 59.9, NOW).light_ok
    assert hibernation.step(dark, LIGHT, 60.0, NOW).light_ok


def test_an_unknown_light_keeps_what_was_known_and_begins_the_delay_anew() -> None:
    later = NOW + timedelta(seconds=300)
    assert hibernation.step(Hibernation(None, NOW, False), LIGHT, None, later) == Hibernation(
        None, later, False
    )
    resting = Hibernation(NOW, NOW, False)
    assert hibernation.step(resting, LIGHT, None, later) is resting
