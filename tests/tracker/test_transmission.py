"""Linear actuators: stroke to angle and back, and what cannot be built."""

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.mechanisms import LATITUDE_DEG, alexandru_diurnal, alexandru_elevation
from app.tracker.settings.transmission import LinearActuator, Point

GOLDEN = Path(__file__).parents[1] / "golden"
DIURNAL, ELEVATION = alexandru_diurnal(), alexandru_elevation()
PLAIN = LinearActuator(Point(800.0, 0.0, 10.0), Point(0.0, 200.0), 0.0, 680.0, 300.0, 8.0)
MIRRORED = LinearActuator(Point(800.0, 0.0), Point(0.0, -200.0), 0.0, 680.0, 300.0, 8.0)
actuators = st.sampled_from([DIURNAL, ELEVATION, PLAIN, MIRRORED])


@pytest.mark.parametrize(
    ("actuator", "name", "column", "axis_deg"),
    [
        (DIURNAL, "diurnal", "omega_deg", lambda morning_deg: -morning_deg),
        (ELEVATION, "elevation", "tilt_deg", lambda tilt_deg: LATITUDE_DEG - tilt_deg),
    ],
)
def test_lengths_and_transmission_angles_are_those_of_the_paper(
    actuator: LinearActuator, name: str, column: str, axis_deg: Callable[[float], float]
) -> None:
    with (GOLDEN / f"alexandru_actuator_{name}.csv").open() as file:
        rows = list(csv.DictReader(file))
    slope = next(key for key in rows[0] if key.startswith("dL"))
    for row in rows:
        angle_deg = axis_deg(float(row[column]))
        assert actuator.length_mm(angle_deg) == pytest.approx(float(row["length_mm"]), abs=0.01)
        assert actuator.transmission_deg(angle_deg) == pytest.approx(float(row["transmission_deg"]), abs=0.01)
        assert abs(actuator.mm_per_deg(angle_deg)) == pytest.approx(abs(float(row[slope])), abs=1e-3)
    assert len(rows) >= 14


@given(actuators, st.floats(-200.0, 200.0))
def test_stroke_and_angle_lead_to_each_other(actuator: LinearActuator, angle_deg: float) -> None:
    assert actuator.angle_deg(actuator.stroke_mm(angle_deg)) == pytest.approx(angle_deg, abs=1e-9)


@given(actuators, st.floats(0.0, 1.0))
def test_nowhere_is_the_axis_slower_than_said(actuator: LinearActuator, share: float) -> None:
    low_deg, high_deg = actuator.range_deg
    dps = actuator.speed_mm_s / abs(actuator.mm_per_deg(low_deg + share * (high_deg - low_deg)))
    assert dps >= actuator.slowest_dps(low_deg, high_deg) - 1e-9


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"joint": Point(0.0, 0.0, 50.0)}, "could not turn it"),
        ({"travel_mm": 400.0}, "it cannot go"),
        ({"retracted_mm": 601.0, "travel_mm": 200.0}, "does not jam"),
        ({"speed_mm_s": 0.0}, "Speed must be between"),
    ],
)
def test_what_cannot_be_built_is_refused(change: dict[str, float], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        replace(PLAIN, **change)  # type: ignore[arg-type]  # one value of several types by name


@pytest.mark.parametrize(
    ("axis", "sentence"),
    [
        ((-61.0, 60.0, 2.0), "soft limits must lie within"),
        ((-60.0, 60.0, 4.0), "the slowest axis speed"),
    ],
)
def test_an_axis_keeps_to_what_its_actuator_can_do(axis: tuple[float, float, float], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        AxisConfig(axis[0], axis[1], axis[2], 3.0, 0.5, 1.0, DIURNAL)


def test_an_actuator_has_to_reach_the_zero_of_its_axis() -> None:
    late = replace(DIURNAL, at_deg=DIURNAL.at_deg + 70.0)
    with pytest.raises(ValueError, match="0, the home position"):
        AxisConfig(20.0, 60.0, 2.0, 3.0, 0.5, 1.0, late)
