"""The state machines of the protections: what holds for every sequence of readings."""

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.tracker.protections import low_light, snow, wind_stow
from app.tracker.protections.guarding import OFF_GUARD, Guarding, latched, step
from app.tracker.protections.low_light import AWAKE, LowLight
from app.tracker.protections.snow import CLEAR, Snow
from app.tracker.protections.wind_stow import CALM, Wind, WindStow
from app.tracker.protections.words import Protection
from app.tracker.settings.protections import (
    PROTECTED,
    LightProtection,
    ProtectionConfig,
    Reaction,
    SnowProtection,
    StowName,
    StowPlace,
    WindProtection,
)
from app.tracker.weather.weather import NOTHING_SENSED, Quality, Quantity, Reading, Sensed
from tests.fault_result import FaultResult

BEGIN = datetime(2026, 1, 1, tzinfo=UTC)
ALL = tuple(Quantity)
CONFIG = ProtectionConfig()
QUICK = ProtectionConfig(
    wind=WindProtection(resume_after_s=10.0, bad_after_s=3.0),
    snow=SnowProtection(hold_s=3.0),
    light=LightProtection(hold_s=5.0),
)
LIMITS = WindProtection(gust_mps=17.0, mean_mps=15.0, hysteresis_mps=2.0)
LIGHT = LightProtection(threshold_wm2=50.0, hysteresis_wm2=10.0)
CALM_AIR = Sensed(
    Reading(3.0, Quality.GOOD, 0.0), Reading(0.0, Quality.GOOD, 0.0), Reading(600.0, Quality.GOOD, 0.0), 3.0
)
good = st.floats(0.0, 40.0).map(lambda value: Reading(value, Quality.GOOD, 0.0, "station"))
bad = st.sampled_from([q for q in Quality if q is not Quality.GOOD]).map(
    lambda quality: Reading(3.0, quality, 0.0, "station")
)
readings = st.one_of(good, bad)
weather = st.builds(Sensed, wind=readings, snow=readings, light=readings)


def at(seconds: float) -> datetime:
    return BEGIN + timedelta(seconds=seconds)


def told(value: float | None) -> Reading:
    return Reading() if value is None else Reading(value, Quality.GOOD, 0.0, "station")


def run(samples: list[Sensed], config: ProtectionConfig = QUICK, *, night: bool = False) -> list[Guarding]:
    state, states = OFF_GUARD, []
    for second, seen in enumerate(samples):
        state = step(state, config, seen, ALL, at(second), night=night)
        states.append(state)
    return states


@given(st.lists(weather, min_size=1, max_size=60), st.booleans())
@pytest.mark.fault(41)
def test_wind_always_wins_and_one_protection_holds(samples: list[Sensed], night: bool) -> None:
    for seen, state in zip(samples, run(samples, night=night), strict=True):
        wind_mps = seen.wind.good
        if wind_mps is not None and wind_mps >= QUICK.wind.gust_mps:
            assert state.kind is Protection.WIND_STOW
            assert state.stow is StowName.WIND


@given(st.lists(weather, min_size=1, max_size=60))
def test_typhoon_ends_only_after_the_whole_delay_of_good_and_calm_readings(samples: list[Sensed]) -> None:
    states = run(samples)
    for index in range(1, len(states)):
        if states[index - 1].kind is Protection.WIND_STOW and states[index].kind is not Protection.WIND_STOW:
            assert index > QUICK.wind.resume_after_s
            last = samples[index - int(QUICK.wind.resume_after_s) : index + 1]
            assert all(one.wind.good is not None and one.wind.good < QUICK.wind.gust_mps for one in last)


@given(st.lists(weather, min_size=1, max_size=60))
def test_a_bad_reading_never_reads_as_calm_light_or_bare(samples: list[Sensed]) -> None:
    states = run(samples)
    for seen, before, after in zip(samples, [OFF_GUARD, *states], states, strict=False):
        if seen.wind.good is None and before.wind_stow.since is not None:
            assert after.wind_stow.since is not None
        if seen.snow.good is None and before.snow.since is not None:
            assert after.snow.since is not None


@given(st.lists(st.floats(0.0, 20.0), min_size=1, max_size=40))
def test_snow_must_lie_for_the_whole_time(loads: list[float]) -> None:
    limits, state = SnowProtection(hold_s=5.0), CLEAR
    for second, load_kg in enumerate(loads):
        before, state = state, snow.step(state, limits, load_kg, at(second))
        if before.since is None and state.since is not None:
            assert all(one >= limits.load_kg for one in loads[max(0, second - 4) : second + 1])
        assert (state.since is None) or load_kg >= limits.load_kg


@given(st.integers(0, 9), st.sampled_from([17.0, 30.0, None]))
def test_any_violating_sample_begins_the_calm_time_anew(second: int, wind_mps: float | None) -> None:
    limits, state = WindProtection(resume_after_s=10.0), WindStow(at(0), at(0))
    state = wind_stow.step(state, limits, Wind(wind_mps), at(second))
    for later in range(second + 1, second + 11):
        state = wind_stow.step(state, limits, Wind(5.0), at(later))
        assert state.since == at(0)
        assert state.earliest_end(limits) == at(second + 10)
    assert wind_stow.step(state, limits, Wind(5.0), at(second + 11)) == CALM


def test_the_wind_that_equals_a_limit_is_unsafe_by_gust_and_by_mean() -> None:
    limits = WindProtection(gust_mps=17.0, mean_mps=12.0)
    assert wind_stow.step(CALM, limits, Wind(16.99, 11.99), at(0)) == CALM
    assert wind_stow.step(CALM, limits, Wind(17.0, 5.0), at(0)).since == at(0)
    assert wind_stow.step(CALM, limits, Wind(13.0, 12.0), at(0)).since == at(0)


@pytest.mark.parametrize("wind", [Wind(15.5, 5.0), Wind(10.0, 15.5)])
def test_within_the_hysteresis_the_wind_does_not_begin_but_goes_on(wind: Wind) -> None:
    limits = WindProtection(hysteresis_mps=2.0, resume_after_s=10.0)
    assert wind_stow.step(CALM, limits, wind, at(0)) == CALM
    assert wind_stow.step(WindStow(at(0), at(0)), limits, wind, at(100)).unsafe_at == at(100)


@pytest.mark.fault(40)
def test_light_flickering_around_its_threshold_switches_once(fault: FaultResult) -> None:
    limits, state = LightProtection(threshold_wm2=50.0, hysteresis_wm2=10.0, hold_s=10.0), AWAKE
    for second in range(12):
        state = low_light.step(state, limits, 49.0, at(second))
    assert state.since == at(11)
    assert low_light.step(state, limits, 59.9, at(12)).since == at(11)
    assert low_light.step(state, limits, 60.0, at(12)).since is None
    fault.prevented("hysteresis and delay: it switches once")
    fault.shows_nothing("the tracker stays as it is")
    fault.recovers("automatic: when the light has left the band of the hysteresis")


def test_darkness_is_counted_from_the_last_reading_that_was_not_dark() -> None:
    limits, state = LightProtection(hold_s=10.0), AWAKE
    for second, irradiance_wm2 in enumerate([500.0, *[0.0] * 5, None, *[0.0] * 10]):
        state = low_light.step(state, limits, irradiance_wm2, at(second))
        assert state.since is None
    assert low_light.step(state, limits, 0.0, at(17)).since == at(17)


def test_snow_stays_until_it_is_known_to_be_off() -> None:
    limits = SnowProtection(hysteresis_kg=1.0)
    state = Snow(at(0))
    assert snow.step(state, limits, None, at(1)) == state
    assert snow.step(state, limits, 3.5, at(1)) == state
    assert snow.step(state, limits, 2.9, at(1)).since is None


def test_the_snow_time_runs_while_the_wind_holds() -> None:
    windy = Sensed(wind=told(20.0), snow=told(5.0))
    calm = Sensed(wind=told(2.0), snow=told(5.0))
    states = run([windy, windy, windy, windy, *[calm] * 12])
    assert {state.kind for state in states[:14]} == {Protection.WIND_STOW}
    assert states[-1].kind is Protection.SNOW


def test_the_day_that_begins_without_light_is_waited_for() -> None:
    dark, light = Sensed(told(1.0), light=told(10.0)), Sensed(told(1.0), light=told(200.0))
    state = step(OFF_GUARD, QUICK, dark, ALL, at(0), night=True)
    assert state.kind is Protection.NIGHT
    for second in range(1, 30):
        state = step(state, QUICK, dark, ALL, at(second), night=False)
        assert state.kind is Protection.WAIT
    assert step(state, QUICK, light, ALL, at(30), night=False).kind is Protection.TRACK


@given(st.lists(weather, min_size=1, max_size=30))
def test_in_the_polar_night_only_wind_and_snow_move(samples: list[Sensed]) -> None:
    kinds = {state.kind for state in run(samples, night=True)}
    assert kinds <= {Protection.NIGHT, Protection.WIND_STOW, Protection.SNOW}


def test_without_any_sensor_nothing_holds_for_ever() -> None:
    state = OFF_GUARD
    for second in range(0, 100_000, 1000):
        state = step(state, CONFIG, NOTHING_SENSED, (), at(second), night=False)
        assert (state.kind, state.stow, state.held) == (Protection.TRACK, None, None)


@pytest.mark.parametrize("quality", [one for one in Quality if one is not Quality.GOOD])
def test_a_known_wind_sensor_that_fails_stows_after_its_time(quality: Quality) -> None:
    calm, failed = Sensed(wind=told(3.0)), Sensed(wind=Reading(3.0, quality))
    states = run([calm, failed, failed, failed, failed])
    assert [state.kind for state in states] == [Protection.TRACK] * 4 + [Protection.WIND_STOW]


def test_a_required_wind_sensor_is_missed_though_never_seen() -> None:
    config = ProtectionConfig(wind=WindProtection(required=True, bad_after_s=2.0))
    state = OFF_GUARD
    for second in range(3):
        state = step(state, config, NOTHING_SENSED, (), at(second), night=False)
    assert state.kind is Protection.WIND_STOW


@pytest.mark.parametrize(
    ("bad", "kind", "held"),
    [
        (Reaction.IGNORE, Protection.TRACK, None),
        (Reaction.WARN, Protection.TRACK, None),
        (Reaction.HOLD, Protection.TRACK, Quantity.SNOW),
        (Reaction.STOW, Protection.SNOW, None),
    ],
)
def test_what_a_bad_snow_sensor_does_is_set(bad: Reaction, kind: Protection, held: Quantity | None) -> None:
    config = ProtectionConfig(snow=SnowProtection(bad=bad, bad_after_s=0.0))
    state = step(OFF_GUARD, config, Sensed(wind=told(1.0), light=told(500.0)), ALL, at(0), night=False)
    assert (state.kind, state.held, state.doubt(Quantity.SNOW).ripe) == (kind, held, True)


@pytest.mark.parametrize("bad", [Reaction.IGNORE, Reaction.WARN])
def test_a_light_sensor_that_failed_for_good_ends_the_rest(bad: Reaction) -> None:
    dark, failed = Sensed(wind=told(1.0), light=told(0.0)), Sensed(wind=told(1.0))
    config = ProtectionConfig(light=LightProtection(hold_s=5.0, bad=bad, bad_after_s=4.0))
    states = run([Sensed(wind=told(1.0), light=told(100.0)), *[dark] * 8, *[failed] * 6], config)
    assert states[8].kind is Protection.LOW_LIGHT_HOLD
    assert states[11].kind is Protection.LOW_LIGHT_HOLD
    assert states[-1].kind is Protection.TRACK


@pytest.mark.parametrize("kind", [Protection.WIND_STOW, Protection.SNOW])
def test_what_was_latched_holds_until_it_is_seen_good(kind: Protection) -> None:
    state = latched(kind, at(0))
    for second in range(0, 5000, 100):
        state = step(state, CONFIG, NOTHING_SENSED, (), at(second), night=False)
        assert state.kind is kind
    bare = Sensed(wind=told(1.0), snow=told(0.0))
    assert step(state, CONFIG, bare, ALL, at(5000), night=False).kind in {kind, Protection.TRACK}


def test_the_calm_time_begins_anew_after_a_restart() -> None:
    state = latched(Protection.WIND_STOW, at(0))
    for second in range(601):
        state = step(state, CONFIG, Sensed(wind=told(1.0)), ALL, at(second), night=False)
        assert state.kind is Protection.WIND_STOW
    assert step(state, CONFIG, Sensed(wind=told(1.0)), ALL, at(601), night=False).kind is Protection.TRACK


def test_what_is_switched_off_demands_nothing() -> None:
    config = ProtectionConfig(
        wind=WindProtection(enabled=False),
        snow=SnowProtection(enabled=False),
        light=LightProtection(enabled=False),
    )
    storm = Sensed(wind=told(50.0), snow=told(90.0), light=told(0.0))
    assert {state.kind for state in run([storm] * 20, config)} == {Protection.TRACK}


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: WindProtection(gust_mps=0.5), "Gust threshold must be"),
        (lambda: WindProtection(mean_mps=float("nan")), "Mean-wind threshold must be"),
        (lambda: WindProtection(hysteresis_mps=18.0), "smaller than both"),
        (lambda: SnowProtection(hysteresis_kg=4.0), "smaller than the snow-stow threshold"),
        (lambda: LightProtection(bad=Reaction.STOW), "cannot cause a stow"),
        (lambda: StowPlace(91.0), "Elevation must be"),
        (lambda: StowPlace(10.0, 361.0), "Azimuth must be"),
        (lambda: ProtectionConfig(warning_s=-1.0), "Warning time must be"),
    ],
)
def test_settings_that_cannot_be_are_refused_with_a_sentence(make: object, words: str) -> None:
    assert callable(make)
    with pytest.raises(ValueError, match=words):
        make()


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
    held = WindStow(BEGIN, BEGIN)
    later = BEGIN + timedelta(seconds=601)
    assert wind_stow.step(held, LIMITS, wind, later) == (CALM if calm else WindStow(BEGIN, later))


def test_light_must_rise_by_the_hysteresis_once_it_was_too_dark() -> None:
    dark = low_light.step(AWAKE, LIGHT, 49.9, BEGIN)
    assert dark == LowLight(None, BEGIN, False)
    assert low_light.step(AWAKE, LIGHT, 50.0, BEGIN).light_ok
    assert not low_light.step(dark, LIGHT, 59.9, BEGIN).light_ok
    assert low_light.step(dark, LIGHT, 60.0, BEGIN).light_ok


def test_an_unknown_light_keeps_what_was_known_and_begins_the_delay_anew() -> None:
    later = BEGIN + timedelta(seconds=300)
    assert low_light.step(LowLight(None, BEGIN, False), LIGHT, None, later) == LowLight(None, later, False)
    resting = LowLight(BEGIN, BEGIN, False)
    assert low_light.step(resting, LIGHT, None, later) is resting


def air(gust_mps: float | None, mean_mps: float | None) -> Sensed:
    return Sensed(told(gust_mps), wind_mean_mps=mean_mps)


def test_the_mean_wind_stows_too_but_only_while_the_sensor_is_well() -> None:
    config = ProtectionConfig(wind=LIMITS)
    for gust_mps, mean_mps, kind in (
        (10.0, 15.0, Protection.WIND_STOW),
        (10.0, 14.9, Protection.TRACK),
        (10.0, None, Protection.TRACK),
        (None, 15.0, Protection.TRACK),
    ):
        seen = air(gust_mps, mean_mps)
        assert step(OFF_GUARD, config, seen, (), BEGIN, night=False).kind is kind


def test_what_holds_is_known_since_it_began() -> None:
    config, later = ProtectionConfig(wind=LIMITS), BEGIN + timedelta(seconds=5)
    begun = step(OFF_GUARD, config, air(20.0, 5.0), (), BEGIN, night=False)
    assert (begun.kind, begun.since) == (Protection.WIND_STOW, BEGIN)
    assert step(begun, config, air(20.0, 5.0), (), later, night=False).since == BEGIN
    over = later + timedelta(seconds=700)
    ended = step(begun, config, air(3.0, 5.0), (), over, night=True)
    assert (ended.kind, ended.since) == (Protection.NIGHT, over)


def test_a_storm_that_held_holds_for_the_whole_delay_again() -> None:
    state = latched(Protection.WIND_STOW, BEGIN)
    assert state == Guarding(wind_stow=WindStow(BEGIN, BEGIN), kind=Protection.WIND_STOW, since=BEGIN)
    assert state.stow is StowName.WIND
    for seconds, holds in ((600.0, Protection.WIND_STOW), (600.1, Protection.TRACK)):
        now = BEGIN + timedelta(seconds=seconds)
        assert step(state, PROTECTED, CALM_AIR, (Quantity.WIND,), now, night=False).kind is holds


def test_snow_that_held_holds_until_it_is_seen_gone() -> None:
    state = latched(Protection.SNOW, BEGIN)
    assert state == Guarding(snow=Snow(BEGIN), kind=Protection.SNOW, since=BEGIN)
    assert state.stow is StowName.SNOW
    assert step(state, PROTECTED, Sensed(), (), BEGIN, night=False).kind is Protection.SNOW
    assert step(state, PROTECTED, CALM_AIR, (), BEGIN, night=False).kind is Protection.TRACK


@pytest.mark.parametrize(
    "kind", [None, Protection.NIGHT, Protection.WAIT, Protection.LOW_LIGHT_HOLD, Protection.TRACK]
)
def test_nothing_else_is_kept(kind: Protection | None) -> None:
    assert latched(kind, BEGIN) is OFF_GUARD


def test_the_earliest_end_is_known_only_while_it_holds() -> None:
    ends = BEGIN + timedelta(seconds=600)
    assert WindStow(BEGIN, BEGIN).earliest_end(PROTECTED.wind) == ends
    assert CALM.earliest_end(PROTECTED.wind) is None
    assert WindStow(None, BEGIN).earliest_end(PROTECTED.wind) is None
    assert WindStow(BEGIN, None).earliest_end(PROTECTED.wind) is None
