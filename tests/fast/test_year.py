"""A year of four modes against a pvlib pipeline written on its own, and what a comparison tells."""

import pandas as pd
import pvlib
import pytest

from app.fast.compare import compare, extraterrestrial_wm2
from app.fast.comparison import ClearSky, Comparison
from app.fast.spa_table import build
from app.fast.sun import spa_path
from app.fast.year import collected_whm2
from app.sun.position import Location
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from tests.amount import amount

STEP_MIN = amount(60, 5)
"""Both sides add up the same instants; without numba, which only the soak has, each takes its time."""
SKY = ClearSky(altitude_m=600.0, linke_turbidity=3.4, albedo=0.25)


@pytest.mark.parametrize(
    ("latitude_deg", "facing_deg"), [(41.2867, 180.0), (-23.5, 0.0), (67.0, 180.0)][: amount(1, 3)]
)
def test_a_year_is_within_a_ten_thousandth_of_pvlib(latitude_deg: float, facing_deg: float) -> None:
    place, held = Location(latitude_deg, 36.33, SKY.altitude_m), Orientation(facing_deg, 55.0)
    times = pd.date_range("2026-01-01", "2027-01-01", freq=f"{STEP_MIN}min", tz="UTC", inclusive="left")
    at_unix_s = (times - pd.Timestamp(0, tz="UTC")).total_seconds().to_numpy()
    sun = spa_path(build(at_unix_s[0], at_unix_s[-1]), place, at_unix_s)
    ours = collected_whm2(
        sun, extraterrestrial_wm2(times.day_of_year.to_numpy(dtype=float)), 60.0 * STEP_MIN, held, SKY
    )
    theirs = _pvlib_whm2(times, place, held)
    assert ours == pytest.approx(theirs, rel=1e-4)


def _pvlib_whm2(times: pd.DatetimeIndex, place: Location, held: Orientation) -> dict[Mode, float]:
    sun = pvlib.solarposition.get_solarposition(
        times,
        place.latitude_deg,
        place.longitude_deg,
        place.altitude_m,
        pressure=101_000.0,
        temperature=10.0,
    )
    mass = pvlib.atmosphere.get_absolute_airmass(
        pvlib.atmosphere.get_relative_airmass(sun.apparent_zenith),
        pvlib.atmosphere.alt2pres(place.altitude_m),
    )
    outside = pvlib.irradiance.get_extra_radiation(times.day_of_year.to_numpy())
    sky = pvlib.clearsky.ineichen(
        sun.apparent_zenith, mass, SKY.linke_turbidity, place.altitude_m, dni_extra=outside
    )
    tilt, lifted = 90.0 - held.elevation_deg, sun.apparent_zenith.clip(0.0, 90.0)
    panels = {
        Mode.FIXED: (tilt, held.azimuth_deg),
        Mode.AZIMUTH: (tilt, sun.azimuth),
        Mode.ELEVATION: (lifted, held.azimuth_deg),
        Mode.DUAL: (lifted, sun.azimuth),
    }
    return {
        mode: float(
            pvlib.irradiance.get_total_irradiance(
                *panel, sun.apparent_zenith, sun.azimuth, sky.dni, sky.ghi, sky.dhi,
                dni_extra=outside, albedo=SKY.albedo, model="haydavies",
            ).poa_global.where(sun.apparent_elevation > 0.0).sum() * STEP_MIN / 60.0
        )
        for mode, panel in panels.items()
    }  # fmt: skip


@pytest.fixture(scope="module")
def compared() -> Comparison:
    place, held = Location(41.2867, 36.33, 50.0), Orientation(180.0, 55.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("app.fast.compare.FOUR_SEASONS", (75, 162, 258, 344)[: amount(1, 4)])
        return compare(TrackerConfig("T1", "Tracker 1"), place, 2026, held, ClearSky(50.0))


def test_each_mode_collects_at_least_what_the_simpler_one_does(compared: Comparison) -> None:
    worth = {one.mode: one.collected_kwhm2 for one in compared.modes}
    assert worth[Mode.FIXED] <= worth[Mode.ELEVATION] <= worth[Mode.DUAL]
    assert worth[Mode.FIXED] <= worth[Mode.AZIMUTH] <= worth[Mode.DUAL]
    assert {one.mode: one.gain_pct for one in compared.modes}[Mode.FIXED] == 0.0


def test_a_wider_deadband_moves_less_and_stays_within_itself(compared: Comparison) -> None:
    rows = compared.deadbands
    assert [row.moves_a_day for row in rows] == sorted((row.moves_a_day for row in rows), reverse=True)
    assert [row.rms_off_deg for row in rows] == sorted(row.rms_off_deg for row in rows)
    assert all(row.worst_off_deg <= row.deadband_deg for row in rows)
