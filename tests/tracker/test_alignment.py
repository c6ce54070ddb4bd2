"""Sightings of the sun: one names the likely mistake, several correct the pointing."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.base.angles import separation_deg, wrap180
from app.sun.position import Algorithm, Location, sun_position
from app.sun.trigonometry import SCALAR
from app.tracker.commands.commands import CommandRejected
from app.tracker.commissioning.alignment import Mistake, diagnose, fit
from app.tracker.memory.memory import Pointing, Sighting
from app.tracker.mounts.mount import PLAIN, to_axes
from tests.amount import amount

SAMSUN = Location(41.2867, 36.33)
JUNE = datetime(2026, 6, 21, tzinfo=UTC)
MORNING = JUNE + timedelta(hours=7)


def sighting(
    at: datetime,
    pointing: Pointing = Pointing(),
    *,
    believed: Location = SAMSUN,
    clock_fast: timedelta = timedelta(0),
) -> Sighting:
    """Return a sighting at Samsun, by a controller that may believe in another place or time."""
    shown = at + clock_fast
    thought = sun_position(Algorithm.PSA, believed, shown)
    truth = sun_position(Algorithm.PSA, SAMSUN, at)
    axes = to_axes(PLAIN, pointing, truth.azimuth_deg, truth.apparent_elevation_deg, SCALAR)
    return Sighting(shown, thought.azimuth_deg, thought.apparent_elevation_deg, *axes)


def sightings(day: datetime, hours: tuple[float, ...], pointing: Pointing) -> list[Sighting]:
    return [sighting(day + timedelta(hours=hour), pointing) for hour in hours]


@pytest.mark.parametrize(
    ("minutes", "words"), [(12, "12.0 minutes fast"), (-7, "7.0 minutes slow"), (60, "daylight saving")]
)
def test_a_wrong_clock_is_named_first_with_its_minutes(minutes: int, words: str) -> None:
    seen = sighting(MORNING, clock_fast=timedelta(minutes=minutes))
    first = diagnose(seen, SAMSUN)[0]
    assert diagnose(sighting(MORNING), SAMSUN) == []
    assert first.mistake is Mistake.CLOCK
    assert words in first.message
    assert first.residual_deg < 0.01


@pytest.mark.parametrize(
    ("believed", "mistake"),
    [
        (Location(41.2867, -36.33), Mistake.LONGITUDE_SIGN),
        (Location(-41.2867, 36.33), Mistake.LATITUDE_SIGN),
        (Location(36.33, 41.2867), Mistake.SWAPPED),
    ],
)
def test_a_wrong_place_is_named_first(believed: Location, mistake: Mistake) -> None:
    first = diagnose(sighting(MORNING, believed=believed), believed)[0]
    assert first.mistake is mistake
    assert first.residual_deg < 0.01


@pytest.mark.parametrize(
    ("pointing", "mistake", "words"),
    [
        (Pointing(azimuth_offset_deg=-6.0), Mistake.AZIMUTH_ZERO, "-6.0 degrees"),
        (Pointing(elevation_offset_deg=4.0), Mistake.ELEVATION_ZERO, "+4.0 degrees"),
    ],
)
def test_a_wrong_zero_is_named_first_with_its_degrees(
    pointing: Pointing, mistake: Mistake, words: str
) -> None:
    first = diagnose(sighting(MORNING, pointing), SAMSUN)[0]
    assert first.mistake is mistake
    assert words in first.message


def test_where_the_declination_is_known_a_compass_is_named_before_a_wrong_zero() -> None:
    seen = sighting(MORNING, Pointing(azimuth_offset_deg=-6.0))
    causes = [cause.mistake for cause in diagnose(seen, SAMSUN, magnetic_declination_deg=6.0)]
    assert causes[:2] == [Mistake.MAGNETIC_NORTH, Mistake.AZIMUTH_ZERO]


@settings(max_examples=amount(20, 200), deadline=None)
@given(
    azimuth_deg=st.floats(-180.0, 179.0),
    elevation_deg=st.floats(-3.0, 3.0),
    north_deg=st.floats(-4.0, 4.0),
    east_deg=st.floats(-4.0, 4.0),
)
def test_three_sightings_over_the_day_give_back_any_pointing(
    azimuth_deg: float, elevation_deg: float, north_deg: float, east_deg: float
) -> None:
    truth = Pointing(azimuth_deg, elevation_deg, north_deg, east_deg)
    found = fit(sightings(JUNE, (5.0, 9.5, 15.0), truth))
    assert abs(wrap180(found.azimuth_offset_deg - azimuth_deg)) < 1e-4
    assert found.elevation_offset_deg == pytest.approx(elevation_deg, abs=1e-4)
    assert found.lean_north_deg == pytest.approx(north_deg, abs=1e-4)
    assert found.lean_east_deg == pytest.approx(east_deg, abs=1e-4)
    assert found.residual_deg is not None
    assert found.residual_deg < 1e-4


def test_noisy_sightings_are_fitted_to_their_noise_and_point_well() -> None:
    truth, random = Pointing(3.0, -1.0, 0.8, -0.5), np.random.default_rng(7)
    noisy = [
        Sighting(
            seen.at,
            seen.sun_azimuth_deg,
            seen.sun_elevation_deg,
            seen.panel_azimuth_deg + float(random.normal(0.0, 0.05)),
            seen.panel_elevation_deg + float(random.normal(0.0, 0.05)),
        )
        for seen in sightings(JUNE, (4.5, 6.0, 7.5, 9.0, 10.5, 12.0, 13.5, 15.0), truth)
    ]
    found = fit(noisy)
    assert found.residual_deg is not None
    assert 0.01 < found.residual_deg < 0.15
    right = to_axes(PLAIN, truth, 200.0, 60.0, SCALAR)
    assert separation_deg(*right, *to_axes(PLAIN, found, 200.0, 60.0, SCALAR)) < 0.1


@pytest.mark.parametrize("hours", [(9.0, 9.1, 9.2), (6.0, 6.5, 7.0, 7.5)])
def test_sightings_of_one_time_of_day_are_refused_with_what_more_to_take(hours: tuple[float, ...]) -> None:
    with pytest.raises(CommandRejected, match="Three sightings are needed"):
        fit(sightings(JUNE, hours[:2], Pointing()))
    with pytest.raises(CommandRejected, match="too close together") as refused:
        fit(sightings(JUNE, hours, Pointing(3.0)))
    assert "in the morning, around noon, and in the evening" in refused.value.reasons[0].hint


def test_a_mast_that_seems_to_fall_over_is_refused() -> None:
    with pytest.raises(CommandRejected, match="leans by") as refused:
        fit(sightings(JUNE, (5.0, 9.5, 15.0), Pointing(lean_north_deg=25.0)))
    assert refused.value.reasons[0].code == "implausible_lean"
