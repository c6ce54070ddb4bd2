"""Light sensors find a pointing error in sunlight, and do no harm when they are dark, stuck or clouded."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.show.rehearsal import Rehearsal
from app.simulation.faults import Fault, FaultKind
from app.sun.position import Location
from app.tracker.commands.commands import SelectMode, Stop, Track
from app.tracker.memory.memory import Pointing
from app.tracker.motion.hybrid import AxisCorrection, HybridPhase, axis_correction
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.strategy import Continuous, Deadband, HybridConfig, SimulatedLight, Strategy
from app.tracker.values.mode import Mode
from app.tracker.values.motion import LightPair

PLACE = Location(41.2867, 36.33)
MORNING = datetime(2026, 6, 21, 7, 0, tzinfo=UTC)
MISALIGNED = HybridConfig(enabled=True, simulated=SimulatedLight(1.0, -0.6))
SECOND = timedelta(seconds=1)
EAGER = HybridConfig(enabled=True)
CONTINUOUS = Continuous()


class Sunny:
    """A tracker with light sensors under the morning sun of Samsun, tracking."""

    def __init__(self, hybrid: HybridConfig = MISALIGNED, strategy: Strategy = CONTINUOUS) -> None:
        config = TrackerConfig("T1", "Tracker 1", strategy=strategy, hybrid=hybrid)
        self.rehearsal = Rehearsal(config, Pointing(), PLACE, MORNING)
        self.rehearsal.home()
        self.rehearsal.ask(SelectMode(Mode.DUAL, Orientation(180.0, 45.0)))
        self.rehearsal.ask(Track())
        self.forward(timedelta(minutes=1))

    def forward(self, length: timedelta) -> None:
        for _ in range(int(length / SECOND)):
            self.rehearsal.clock.advance(SECOND)
            self.rehearsal.site_time += SECOND
            self.rehearsal.tick()

    def play(self, kind: FaultKind, amount: float, axis: Axis | None = None) -> None:
        self.rehearsal.drive.inject(Fault(kind, axis, amount))

    @property
    def correction(self) -> tuple[float, float]:
        shown = self.rehearsal.controller.snapshot(self.rehearsal.site_time).hybrid
        assert shown is not None
        assert shown.sum.azimuth_deg == pytest.approx(
            shown.computed.azimuth_deg + shown.correction.azimuth_deg
        )
        return shown.correction.azimuth_deg, shown.correction.elevation_deg


def found(hybrid: HybridConfig = MISALIGNED) -> Sunny:
    """Return a tracker whose sensors have found most of the misalignment."""
    sunny = Sunny(hybrid)
    sunny.forward(timedelta(minutes=10))
    assert sunny.correction[0] > 0.8
    return sunny


@pytest.mark.parametrize("strategy", [Continuous(), Deadband()], ids=["continuous", "deadband"])
def test_a_misalignment_is_found_in_sunlight(strategy: Strategy) -> None:
    sunny = Sunny(strategy=strategy)
    sunny.forward(timedelta(minutes=30))
    assert sunny.correction == pytest.approx((1.0, -0.6), abs=0.12)
    shown = sunny.rehearsal.controller.snapshot(sunny.rehearsal.site_time)
    assert shown.off_sun_deg is not None
    assert shown.off_sun_deg < 0.5
    frame = sunny.rehearsal.controller.frame()
    assert frame[10:12] == pytest.approx(sunny.correction)


def test_an_axis_that_arrives_first_does_not_take_the_way_of_the_other_for_an_error() -> None:
    """While azimuth is still on its way, the elevation's pair sees the sun from aside, and too high."""
    sunny = Sunny(EAGER)
    assert sunny.correction == pytest.approx((0.0, 0.0), abs=0.02)


def test_in_cloud_the_correction_decays_and_in_sunlight_it_is_found_again() -> None:
    sunny = found()
    before_deg = sunny.correction[0]
    sunny.play(FaultKind.CLOUD, 1.0)
    sunny.forward(timedelta(minutes=15))
    assert sunny.correction[0] == pytest.approx(before_deg / 2.718, rel=0.05)
    sunny.rehearsal.drive.end_injected_faults()
    sunny.forward(timedelta(minutes=10))
    assert sunny.correction[0] == pytest.approx(before_deg, abs=0.05)


@pytest.mark.parametrize("stuck_wm2", [0.0, 60_000.0])
def test_a_stuck_sensor_is_doubted_and_its_correction_fades(stuck_wm2: float) -> None:
    sunny = Sunny(replace(EAGER, decay_s=60.0))
    sunny.play(FaultKind.LIGHT_SENSOR_STUCK, stuck_wm2, Axis.AZIMUTH)
    largest_deg = 0.0
    for _ in range(8):
        sunny.forward(timedelta(minutes=1))
        largest_deg = max(largest_deg, abs(sunny.correction[0]))
    assert largest_deg <= EAGER.bound_deg
    assert abs(sunny.correction[0]) < 0.05
    assert abs(sunny.correction[1]) < 0.1


@pytest.mark.parametrize("decay_s", [0.0, 900.0])
def test_a_stop_lets_the_correction_decay_and_a_new_zero_or_pointing_forgets_it(decay_s: float) -> None:
    sunny = found(replace(MISALIGNED, decay_s=decay_s))
    found_deg = sunny.correction[0]
    sunny.rehearsal.ask(Stop())
    sunny.forward(timedelta(minutes=15))
    sunny.rehearsal.ask(Track())
    sunny.forward(SECOND)
    kept = 1.0 / 2.718 if decay_s else 1.0
    assert sunny.correction[0] == pytest.approx(found_deg * kept, rel=0.1)
    if decay_s:
        sunny.rehearsal.controller.set_pointing(Pointing(1.0, -0.6))
    else:
        sunny.rehearsal.ask(Stop())
        sunny.forward(timedelta(seconds=5))
        sunny.rehearsal.home()
        sunny.rehearsal.ask(Track())
    sunny.forward(SECOND)
    assert sunny.correction == (0.0, 0.0)


readings = st.one_of(st.floats(-1e9, 1e9), st.sampled_from([0.0, float("nan"), float("inf"), -float("inf")]))
pairs = st.one_of(st.none(), st.builds(LightPair, readings, readings))


@given(
    st.lists(st.tuples(pairs, st.floats(-1.0, 100_000.0), st.booleans()), max_size=40),
    st.floats(0.01, 10.0),
    st.floats(0.001, 10.0),
    st.floats(0.0, 1000.0),
)
def test_whatever_the_sensors_say_the_correction_keeps_its_bound(
    story: list[tuple[LightPair | None, float, bool]], bound_deg: float, gain_dps: float, decay_s: float
) -> None:
    config = HybridConfig(enabled=True, bound_deg=bound_deg, gain_dps=gain_dps, decay_s=decay_s)
    correction, now = AxisCorrection(), MORNING
    for pair, elapsed_s, on_place in story:
        now += timedelta(seconds=max(elapsed_s, 0.0))
        before = correction
        correction = axis_correction(before, config, pair, now, elapsed_s, on_place=on_place)
        assert abs(correction.degrees) <= bound_deg
        dark = pair is None or not min(pair.lower_wm2, pair.higher_wm2) >= config.threshold_wm2
        if dark:
            assert correction.phase is HybridPhase.DARK
            assert abs(correction.degrees) <= abs(before.degrees)
