"""Studies worked out: against pvlib, against each other, with the controller, and from weather files."""

from dataclasses import replace
from datetime import date
from pathlib import Path

import numpy as np
import pandas as pd
import pvlib
import pytest

from app.base.adapter import adapter
from app.energy.program import step_program
from app.energy.stepping import Steps, midpoint_h
from app.studies.compute import finished, work_out
from app.studies.days import REPRESENTATIVE, days_of
from app.studies.jobs import ProgramLight, ProgramQuestion
from app.studies.light import clear_days, standard_offset_h, weather_days
from app.studies.programs import find_programs
from app.studies.request import Fidelity, LightModel, Span, StudyMode, StudyRequest, StudyStrategy
from app.studies.result import CaseResult, StudyResult, curves_csv, table_csv
from app.studies.weather import HOURS, WeatherFormat, read_weather
from app.studies.weather_columns import WeatherRefused
from app.sun.position import Location
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, TrackerConfig
from tests.amount import amount
from tests.studies import files

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

SAMSUN = Location(41.2867, 36.33, 4.0)
JUNE = date(2026, 6, 21)
DECEMBER = date(2026, 12, 21)
"""The shortest day: the controller is simulated for its every second."""


def asked(**more: object) -> StudyRequest:
    known = {
        "title": "Test", "location": SAMSUN, "time_zone": "Europe/Istanbul", "span": Span.DAY, "on": JUNE,
        "modes": (StudyMode.DUAL,), "strategies": (StudyStrategy.CONTINUOUS,),
        "held": Orientation(180.0, 48.7), "step_min": 10,
    }  # fmt: skip
    return StudyRequest(**{**known, **more})


def worked(request: StudyRequest) -> dict[tuple[StudyMode, StudyStrategy], CaseResult]:
    cases = work_out(request, clear_days(request), lambda *_: None)
    return {(case.mode, case.strategy): case for case in cases}


def test_a_year_of_modes_is_within_a_thousandth_of_a_pipeline_of_pvlib() -> None:
    """The whole study, its sky, sun and summing included, against pvlib from end to end."""
    modes = (StudyMode.AZIMUTH, StudyMode.ELEVATION, StudyMode.DUAL)
    found = worked(asked(span=Span.YEAR, step_min=30, modes=modes))
    times = clear_days(asked(span=Span.YEAR, step_min=30)).at_unix_s.ravel()
    index = pd.to_datetime(times, unit="s", utc=True)
    sun = pvlib.solarposition.get_solarposition(index, SAMSUN.latitude_deg, SAMSUN.longitude_deg, 4.0)
    zenith, azimuth = sun["apparent_zenith"], sun["azimuth"]
    mass = pvlib.atmosphere.get_absolute_airmass(
        pvlib.atmosphere.get_relative_airmass(zenith), pvlib.atmosphere.alt2pres(4.0)
    )
    turbidity = pvlib.clearsky.lookup_linke_turbidity(index, SAMSUN.latitude_deg, SAMSUN.longitude_deg)
    extra = pvlib.irradiance.get_extra_radiation(np.asarray(index.day_of_year, dtype=float))
    sky = pvlib.clearsky.ineichen(zenith, mass, turbidity, 4.0, extra)
    angles = {
        StudyMode.FIXED: (41.3, 180.0), StudyMode.AZIMUTH: (41.3, azimuth),
        StudyMode.ELEVATION: (zenith, 180.0), StudyMode.DUAL: (zenith, azimuth),
    }  # fmt: skip
    for mode, (tilt, facing) in angles.items():
        total = pvlib.irradiance.get_total_irradiance(
            tilt, facing, zenith, azimuth, sky["dni"], sky["ghi"], sky["dhi"], dni_extra=extra, albedo=0.2,
            model="haydavies",
        )["poa_global"]  # fmt: skip
        theirs_kwhm2 = float(np.nansum(total.to_numpy()) / 2 / 1000)
        ours = found[mode, StudyStrategy.CONTINUOUS].insolation_kwhm2
        assert ours == pytest.approx(theirs_kwhm2, rel=1e-3), mode


def test_gains_are_ordered_and_net_of_the_drives() -> None:
    modes = (StudyMode.AZIMUTH, StudyMode.ELEVATION_LEAST, StudyMode.DUAL, StudyMode.EQUATORIAL)
    found = worked(asked(span=Span.TWELVE_DAYS, modes=modes, range_deg=180.0))
    gains = {mode: case.net_gain_percent for (mode, _), case in found.items()}
    assert gains[StudyMode.FIXED] == 0.0
    assert 0 < gains[StudyMode.ELEVATION_LEAST] < gains[StudyMode.AZIMUTH] < gains[StudyMode.DUAL]
    dual = found[StudyMode.DUAL, StudyStrategy.CONTINUOUS]
    equatorial = found[StudyMode.EQUATORIAL, StudyStrategy.CONTINUOUS]
    assert equatorial.insolation_kwhm2 == pytest.approx(dual.insolation_kwhm2, rel=1e-9)
    assert equatorial.travel_deg < 0.8 * dual.travel_deg, "a polar axis turns evenly"
    assert dual.net_kwh == pytest.approx(dual.energy_kwh - dual.drives_kwh)
    assert dual.net_gain_percent < dual.gross_gain_percent
    assert sum(dual.months_kwh) == pytest.approx(dual.energy_kwh)


def test_twelve_days_stand_for_the_year() -> None:
    year, twelve = (
        worked(asked(span=span, step_min=30))[StudyMode.DUAL, StudyStrategy.CONTINUOUS]
        for span in (Span.YEAR, Span.TWELVE_DAYS)
    )
    assert twelve.energy_kwh == pytest.approx(year.energy_kwh, rel=0.01)
    assert (len(year.heat_wm2), len(twelve.heat_wm2)) == (365, 12)
    assert len(year.curves) == len(twelve.curves) == 12
    days, weights = days_of(Span.TWELVE_DAYS, JUNE)
    assert sum(weights) == 365.0
    assert tuple(day.day for day in days) == REPRESENTATIVE
    assert len(days_of(Span.YEAR, date(2024, 1, 1))[0]) == 365


@pytest.mark.parametrize("light", [LightModel.INEICHEN, LightModel.SOLIS, LightModel.HAURWITZ])
def test_every_clear_sky_is_bright_at_noon_and_dark_at_night(light: LightModel) -> None:
    days = clear_days(asked(light=light))
    assert (days.light.global_wm2[~days.up] == 0.0).all()
    assert 800 < days.light.global_wm2.max() < 1050
    level = days.light.direct_wm2 * np.sin(np.radians(days.light.sun_elevation_deg)) + days.light.diffuse_wm2
    lit = days.light.global_wm2 > 100
    np.testing.assert_allclose(level[lit], days.light.global_wm2[lit], rtol=0.08)


TURNING, TILTING = AxisConfig(-60.0, 60.0, 4.0, 6.0, 0.5, 2.0), AxisConfig(-24.0, 24.0, 4.0, 6.0, 0.5, 2.0)
OWN_MOUNTS = [
    (StudyMode.DUAL, StudyMode.EQUATORIAL, MountConfig(MountKind.EQUATORIAL, axis_tilt_deg=41.2867)),
    (StudyMode.AZIMUTH, StudyMode.HORIZONTAL_AXIS, MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS)),
]


def test_the_controller_collects_what_ideal_drives_do_but_for_its_deadband() -> None:
    tracker, mode = TrackerConfig("T1", "North field"), StudyMode.AZIMUTH
    day = asked(modes=(mode,), strategies=(StudyStrategy.DEADBAND,), tracker=tracker, step_min=5, on=DECEMBER)
    ideal, real = (
        worked(replace(day, fidelity=fidelity))[mode, StudyStrategy.DEADBAND] for fidelity in Fidelity
    )
    assert real.insolation_kwhm2 == pytest.approx(ideal.insolation_kwhm2, rel=2e-3)
    assert real.largest_error_deg < 1.6
    assert real.moves > 50
    assert set(real.curves[0].elevation_deg) == {48.7}


@pytest.mark.parametrize(("mode", "asked_mode", "mount"), amount(OWN_MOUNTS[:1], OWN_MOUNTS))
def test_the_controller_collects_on_its_own_mount_what_the_ideal_one_does(
    mode: StudyMode, asked_mode: StudyMode, mount: MountConfig
) -> None:
    """Frames of these mounts tell where the panel faces, not where its axes stand."""
    tracker = TrackerConfig("T1", "T1", azimuth=TURNING, elevation=TILTING, mount=mount)
    day = asked(modes=(asked_mode,), range_deg=60.0, on=DECEMBER)
    ideal = worked(day)[asked_mode, StudyStrategy.CONTINUOUS]
    strategy = amount(StudyStrategy.DEADBAND, StudyStrategy.CONTINUOUS)
    real = asked(
        modes=(mode,), strategies=(strategy,), tracker=tracker, fidelity=Fidelity.CONTROLLER, on=DECEMBER
    )
    found = worked(real)[mode, strategy]
    assert found.insolation_kwhm2 == pytest.approx(ideal.insolation_kwhm2, rel=2e-3)
    assert found.travel_deg == pytest.approx(ideal.travel_deg, rel=0.05)


def test_a_program_of_eight_steps_is_nearly_as_good_as_following() -> None:
    angles = tuple(np.linspace(60, -60, 9).tolist())
    program = step_program("Eight", Steps(midpoint_h(angles), angles, 41.29 - 23.44), SAMSUN.latitude_deg)
    found = worked(
        asked(
            modes=(StudyMode.EQUATORIAL, StudyMode.DUAL),
            strategies=(StudyStrategy.CONTINUOUS, StudyStrategy.PROGRAM, StudyStrategy.INTERVAL),
            program=program, step_min=5,
        )
    )  # fmt: skip
    stepped = found[StudyMode.EQUATORIAL, StudyStrategy.PROGRAM]
    followed = found[StudyMode.EQUATORIAL, StudyStrategy.CONTINUOUS]
    assert 0.985 < stepped.insolation_kwhm2 / followed.insolation_kwhm2 < 1.0
    assert stepped.moves == 8 + 1
    mast = found[StudyMode.DUAL, StudyStrategy.PROGRAM]
    assert mast.insolation_kwhm2 == pytest.approx(stepped.insolation_kwhm2, rel=1e-6)
    assert found[StudyMode.DUAL, StudyStrategy.INTERVAL].largest_error_deg < 4.0


def test_single_axes_of_every_kind_lie_between_fixed_and_dual() -> None:
    modes = (StudyMode.HORIZONTAL_AXIS, StudyMode.TILTED_AXIS, StudyMode.VERTICAL_AXIS, StudyMode.DUAL)
    south = Location(-33.87, 151.21, 20.0)
    found = worked(
        asked(location=south, time_zone="Australia/Sydney", span=Span.TWELVE_DAYS, modes=modes, step_min=30,
              held=Orientation(0.0, 56.0))
    )  # fmt: skip
    gains = {mode: case.gross_gain_percent for (mode, _), case in found.items()}
    assert all(5.0 < gains[mode] < gains[StudyMode.DUAL] for mode in modes[:3])
    rows = worked(asked(modes=modes[:1], rows_ratio=0.5))[StudyMode.HORIZONTAL_AXIS, StudyStrategy.CONTINUOUS]
    alone = worked(asked(modes=modes[:1]))[StudyMode.HORIZONTAL_AXIS, StudyStrategy.CONTINUOUS]
    assert rows.insolation_kwhm2 < alone.insolation_kwhm2


def test_what_was_found_can_be_kept_and_written_as_tables() -> None:
    request = asked(step_min=60)
    days = clear_days(request)
    told: list[int] = []
    result = finished(
        request, days, work_out(request, days, lambda done, of, _: told.append(done * 10 + of)), 0.5
    )
    assert told == [2, 12, 22]
    assert adapter(StudyResult).validate_json(adapter(StudyResult).dump_json(result)) == result
    assert table_csv(result).splitlines()[1].startswith("fixed,continuous,")
    assert len("".join(curves_csv(result)).splitlines()) == 1 + 2 * 24


@pytest.mark.parametrize(
    ("zone", "hours"), [("Europe/Istanbul", 3.0), ("Europe/Berlin", 1.0), ("Australia/Sydney", 10.0)]
)
def test_days_are_cut_in_standard_time(zone: str, hours: float) -> None:
    assert standard_offset_h(zone, 2026) == hours


FORMATS = {
    WeatherFormat.EPW: files.epw,
    WeatherFormat.TMY3: files.tmy3,
    WeatherFormat.PVGIS_TMY: files.pvgis_tmy,
    WeatherFormat.PVGIS_HOURLY: files.pvgis_hourly,
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("weather")
    for kind, content in FORMATS.items():
        (made / f"{kind.name}.csv").write_bytes(content())
    return made


@pytest.mark.parametrize("kind", list(FORMATS))
def test_the_same_weather_is_the_same_study_in_every_format(kind: WeatherFormat, folder: Path) -> None:
    """One sun over Samsun, written in four ways, at four offsets and stamps."""
    seen = read_weather(folder / f"{kind.name}.csv", 2019 if kind is WeatherFormat.PVGIS_HOURLY else None)
    assert seen.format is kind
    assert len(seen.direct_wm2) == HOURS
    assert (seen.location.latitude_deg, seen.location.altitude_m) == (41.28, 4.0)
    assert seen.centre_h == pytest.approx(
        {WeatherFormat.PVGIS_TMY: 0.2, WeatherFormat.PVGIS_HOURLY: 10 / 60}.get(kind, 0.5)
    )
    request = asked(span=Span.YEAR, light=LightModel.WEATHER, weather_file="x", step_min=60)
    days = weather_days(request, seen)
    assert days.utc_offset_h == 3.0
    brightest = days.light.global_wm2.mean(axis=0).argmax()
    assert brightest == 13, "the made sun culminates at 12.5 h of UTC+2: the hour from 13 of UTC+3"
    found = {case.mode: case for case in work_out(request, days, lambda *_: None)}
    gain = found[StudyMode.DUAL].gross_gain_percent
    assert 15.0 < gain < 60.0


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (files.pvgis_hourly(slope=35), "slope 0"),
        (files.pvgis_hourly(components=False), "Select the radiation components"),
        (files.epw().replace(b"14.", b"xx.", 1), "temp_air"),
        (files.tmy3().replace(b"850", b"9850", 1), "hour"),
        (files.tmy3().replace(b"Wspd", b"Wind"), "no column wind_speed"),
        (files.pvgis_tmy()[:3000], "too few hours"),
        (files.pvgis_tmy().replace(b"Elevation (m): 4.0", b"Elevation (m): high"), "cannot be read"),
        (b"\x00\x01", "cannot read this weather file"),
    ],
    ids=["tilted", "sum only", "no number", "too bright", "no wind", "cut off", "no altitude", "binary"],
)  # fmt: skip
def test_a_file_that_cannot_be_used_is_refused_with_a_sentence(
    content: bytes, sentence: str, tmp_path: Path
) -> None:
    path = tmp_path / "file.csv"
    path.write_bytes(content)
    with pytest.raises(WeatherRefused, match=sentence):
        read_weather(path)


def test_a_year_that_the_file_has_not_is_refused(folder: Path) -> None:
    with pytest.raises(WeatherRefused, match="has the years 2019 to 2020, not 2026"):
        read_weather(folder / "PVGIS_HOURLY.csv", 2026)


def test_programs_are_found_under_a_clear_sky_of_the_place_too() -> None:
    question = ProgramQuestion(
        Location(-33.87, 151.21, 20.0), date(2026, 12, 21), light=ProgramLight.INEICHEN
    )
    answer = find_programs(question)
    assert [row.steps for row in answer.rows] == list(range(13))
    assert answer.declination_deg == pytest.approx(-23.43, abs=0.02)
    assert answer.rows[12].tilt_deg == pytest.approx(-33.87 + 23.43, abs=2.5)
    assert answer.rows[12].electric_wh < answer.continuous_wh
    assert all(row.further_wh > 0 for row in answer.rows[1:])
    assert replace(question, light=ProgramLight.MELISS) != question
