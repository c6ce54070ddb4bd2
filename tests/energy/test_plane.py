"""The pass of a year against pvlib, written independently: every model, mode and mount."""

import numpy as np
import pvlib
import pytest

from app.energy.ideal import Follower, ideal_axes, ideal_wm2
from app.energy.plane import Around, Light, Transposition, plane_wm2, relative_air_mass
from app.sun.position import Location
from app.tracker.settings.config import MountConfig, MountKind, Orientation, Rows
from app.tracker.values.mode import Mode
from tests.energy.light import ClearYear, clear_year, pvlib_wm2

SAMSUN = Location(41.2867, 36.33, 4.0)
SYDNEY = Location(-33.87, 151.21, 20.0)
HELD = Orientation(180.0, 55.0)
MODELS = {
    Transposition.ISOTROPIC: "isotropic",
    Transposition.HAY_DAVIES: "haydavies",
    Transposition.PEREZ: "perez",
}


@pytest.fixture(scope="module")
def samsun() -> ClearYear:
    return clear_year(SAMSUN, minutes=20)


@pytest.fixture(scope="module")
def sydney() -> ClearYear:
    return clear_year(SYDNEY, minutes=60)


def pvlib_mode(year: ClearYear, mode: Mode, held: Orientation, model: str) -> np.ndarray:
    zenith, azimuth = year.sun["apparent_zenith"].to_numpy(), year.sun["azimuth"].to_numpy()
    tilt, facing = 90.0 - held.elevation_deg, held.azimuth_deg
    angles = {
        Mode.FIXED: (np.full_like(zenith, tilt), np.full_like(zenith, facing)),
        Mode.AZIMUTH: (np.full_like(zenith, tilt), azimuth),
        Mode.ELEVATION: (zenith, np.full_like(zenith, facing)),
        Mode.DUAL: (zenith, azimuth),
    }
    return pvlib_wm2(year, *angles[mode], model)


@pytest.mark.parametrize(
    ("mode", "model"),
    [*((mode, Transposition.HAY_DAVIES) for mode in Mode), (Mode.DUAL, Transposition.PEREZ)],
)
def test_the_year_of_every_mode_is_within_a_thousandth_of_pvlib(
    samsun: ClearYear, mode: Mode, model: Transposition
) -> None:
    ours = ideal_wm2(samsun.ours, Follower(MountConfig(), mode, HELD), Around(model)).sum()
    theirs = pvlib_mode(samsun, mode, HELD, MODELS[model]).sum()
    assert ours == pytest.approx(theirs, rel=1e-3)
    assert ours == pytest.approx(theirs, rel=2e-4), "what is left is the two suns' difference at the horizon"


@pytest.mark.parametrize("model", list(MODELS))
def test_on_the_same_sun_every_value_agrees_with_pvlib(samsun: ClearYear, model: Transposition) -> None:
    """Zenith and normal at random: no difference but rounding."""
    chance = np.random.default_rng(3)
    count = 4000
    azimuth, elevation = chance.uniform(0, 360, count), chance.uniform(0.5, 89, count)
    panel_azimuth, panel_elevation = chance.uniform(0, 360, count), chance.uniform(0, 90, count)
    dni, dhi = chance.uniform(0, 1000, count), chance.uniform(1, 400, count)
    ghi = dni * np.sin(np.radians(elevation)) + dhi
    extra = chance.uniform(1320, 1410, count)
    ours = plane_wm2(
        Light(azimuth, elevation, dni, dhi, ghi, extra), panel_azimuth, panel_elevation, Around(model, 0.3)
    )
    theirs = pvlib.irradiance.get_total_irradiance(
        90 - panel_elevation, panel_azimuth, 90 - elevation, azimuth, dni, ghi, dhi, dni_extra=extra,
        airmass=pvlib.atmosphere.get_relative_airmass(90 - elevation), albedo=0.3, model=MODELS[model],
    )["poa_global"]  # fmt: skip
    np.testing.assert_allclose(ours, theirs, atol=1e-9)


def test_air_mass_is_that_of_pvlib() -> None:
    elevation = np.linspace(0.0, 90.0, 91)
    theirs = pvlib.atmosphere.get_relative_airmass(90.0 - elevation)
    np.testing.assert_allclose(relative_air_mass(elevation), theirs, rtol=1e-12)
    assert relative_air_mass(np.array([-1.0]))[0] == 0.0


@pytest.mark.parametrize("site", ["samsun", "sydney"])
def test_more_freedom_collects_more(site: str, request: pytest.FixtureRequest) -> None:
    year: ClearYear = request.getfixturevalue(site)
    held = HELD if site == "samsun" else Orientation(0.0, 56.0)
    towards = MountConfig(least_incidence=True)
    equatorial = MountConfig(
        MountKind.EQUATORIAL, 180.0 if site == "samsun" else 0.0, abs(year.location.latitude_deg)
    )
    fixed, azimuth, elevation, dual, polar = (
        ideal_wm2(year.ours, Follower(mount, mode, held), Around()).sum()
        for mount, mode in (
            (MountConfig(), Mode.FIXED), (MountConfig(), Mode.AZIMUTH), (towards, Mode.ELEVATION),
            (MountConfig(), Mode.DUAL), (equatorial, Mode.DUAL),
        )
    )  # fmt: skip
    assert fixed < azimuth < dual
    assert fixed < elevation < dual
    assert polar == pytest.approx(dual, rel=1e-9)
    assert 1.25 < dual / fixed < 1.6


def test_elevation_as_the_paper_has_it_brings_next_to_nothing(samsun: ClearYear) -> None:
    """At the sun's elevation but a held azimuth a panel stands upright while the sun rises aside."""
    paper, least, fixed = (
        ideal_wm2(samsun.ours, Follower(MountConfig(least_incidence=best), mode, HELD), Around()).sum()
        for mode, best in ((Mode.ELEVATION, False), (Mode.ELEVATION, True), (Mode.FIXED, False))
    )
    assert paper / fixed == pytest.approx(1.0, abs=0.01)
    assert least > 1.03 * paper


@pytest.mark.parametrize("rows", [None, Rows(0.4)], ids=["alone", "rows"])
def test_a_single_axis_year_is_that_of_pvlib(samsun: ClearYear, rows: Rows | None) -> None:
    mount = MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS, 180.0, rows=rows)
    follower = Follower(mount, Mode.DUAL, HELD, range_deg=60.0)
    theirs = pvlib.tracking.singleaxis(
        samsun.sun["apparent_zenith"], samsun.sun["azimuth"], 0, 180, 60, rows is not None, 0.4
    )
    wanted = pvlib_wm2(
        samsun, theirs["surface_tilt"].fillna(0), theirs["surface_azimuth"].fillna(90), "haydavies"
    ).sum()
    assert ideal_wm2(samsun.ours, follower, Around()).sum() == pytest.approx(wanted, rel=1e-3)
    assert np.abs(ideal_axes(samsun.ours, follower).first_deg).max() <= 60.0


def test_the_albedo_is_checked() -> None:
    with pytest.raises(ValueError, match="between 0 and 1"):
        Around(albedo=1.2)
