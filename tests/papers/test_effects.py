"""The effects of misprints: none is typed, and those without a model are recomputed here by other means."""

from math import acos, cos, degrees, radians, sin, tan

import numpy as np
import pytest

from app.research.effect import Effect, Measured, effect, figures, not_measured
from app.research.library import LIBRARY, paper
from app.research.sampling import sample
from app.sun.accuracy import separations_deg

UNMEASURED = {
    ("gezegin-dirik", "eq 5"), ("gezegin-dirik", "eq 24"),
    ("nalini-hemavathi", "text below eq 4"), ("nalini-hemavathi", "eqs 8 and 20"),
    ("nalini-hemavathi", "eqs 9 and 10"), ("nalini-hemavathi", "no equation"),
    ("psa-rexroth", "numbering"),
    ("alexandru", "section 2"), ("alexandru", "section 3"), ("alexandru", "section 4"),
}  # fmt: skip


def numbers(key: str, where: str, printed: str = "") -> list[float]:
    """Return the numbers of an effect, as they were computed."""
    found = next(one for one in paper(key).errata if one.where == where and printed in one.printed)
    return [part.value for part in found.effect.parts if isinstance(part, Measured)]


def test_a_number_in_the_words_of_an_effect_is_refused() -> None:
    with pytest.raises(ValueError, match="not typed"):
        effect("sun off by up to 15°")
    with pytest.raises(ValueError, match="not typed"):
        not_measured("36 s")
    assert effect("load ", Measured(2.0, 3), " times").text == "load 2.00 times"


def test_every_effect_is_computed_or_says_that_it_is_not_measured() -> None:
    errata = [(key, one) for key in LIBRARY for one in paper(key).errata]
    assert len(errata) == 52
    assert {(key, one.where) for key, one in errata if not one.effect.measured} == UNMEASURED
    for _, one in errata:
        assert isinstance(one.effect, Effect)
        assert one.effect.measured != one.effect.text.startswith("not measured: ")
    assert sum(one.effect.measured for _, one in errata) == 40


def turned(turn_deg: float) -> float:
    """Return how far apart two suns of the sample are at most, one turned about the pole by hours."""
    greatest = 0.0
    for one in sample():
        latitude = radians(one.location.latitude_deg)
        azimuth, elevation = np.radians(one.reference.azimuth_deg), np.radians(one.reference.elevation_deg)
        sine = np.sin(elevation) * sin(latitude) + np.cos(elevation) * cos(latitude) * np.cos(azimuth)
        apart = 2.0 * np.arcsin(np.cos(np.arcsin(sine)) * sin(radians(turn_deg / 2.0)))
        greatest = max(greatest, float(np.degrees(apart).max()))
    return greatest


def test_an_hour_of_offset_turns_the_sun_by_so_much() -> None:
    assert numbers("gezegin-dirik", "HMI, step 2")[0] == pytest.approx(turned(15.0), abs=0.05)


def test_an_azimuth_from_south_taken_for_one_from_north_turns_the_sun() -> None:
    suns = [(one.reference.azimuth_deg, one.reference.elevation_deg) for one in sample()]
    apart = np.concatenate([separations_deg(*sun, sun[0] + 180.0, sun[1]) for sun in suns])
    greatest, rms = numbers("xia", "figure 1")
    assert greatest == pytest.approx(float(apart.max()), abs=0.5)
    assert rms == pytest.approx(float(np.sqrt(np.mean(apart**2))), rel=0.01)


def test_steps_taken_for_radians_lose_the_sun_and_a_zero_term_does_not() -> None:
    for where, printed in (
        ("eqs 6 and 7", ""), ("eqs 8 to 10", ""), ("eqs 12 and 13", ""), ("eq 18", "cos"),
        ("eqs 21 and 22", ""), ("eq 31", ""),
    ):  # fmt: skip
        assert numbers("gezegin-dirik", where, printed)[1] > 45.0, where
    greatest, rms, right, right_rms = numbers("gezegin-dirik", "eq 18", "zeclip")
    assert (greatest, rms) == (right, right_rms)


def test_what_follows_from_the_numbers_that_nalini_xia_and_alexandru_print() -> None:
    assert numbers("nalini-hemavathi", "table 1") == pytest.approx(
        [26.78 - 26.033, 122.604 - 121.99], abs=0.001
    )
    assert numbers("nalini-hemavathi", "below table 1") == pytest.approx([0.38, 0.20, 0.0], abs=0.005)
    assert numbers("nalini-hemavathi", "eq 17") == pytest.approx([51.0, 180.0], abs=1.0)
    assert numbers("nalini-hemavathi", "eq 6") == pytest.approx([-5.7345, -95.7345], abs=1e-4)
    assert numbers("xia", "section 5") == pytest.approx([1.7 / (36.9**2 / 1600.0)])
    declination = 23.45 * sin(radians(360.0 * (172 - 80) / 365.0))
    half_day_deg = degrees(acos(-tan(radians(45.65)) * tan(radians(declination))))
    assert numbers("alexandru", "section 4", "sunrise") == pytest.approx(
        [60.0 * (4.26 - 12.0 + half_day_deg / 15.0)], abs=0.01
    )
    assert numbers("alexandru", "table 3") == pytest.approx([3600.0 * (14.59 - (24.0 - 9.42))])
    assert numbers("alexandru", "eq 7") == pytest.approx([1439.9, 1209.3], abs=0.05)


@pytest.mark.parametrize(
    ("key", "where", "printed", "greatest"),
    [
        ("gezegin-dirik", "eq 1", "no rule", 1.139),
        ("gezegin-dirik", "eq 4", "", 0.0147),
        ("gezegin-dirik", "eq 19", "", 0.0148),
        ("xia", "eq 3", "", 25.3),
        ("psa-rexroth", "eq 8", "", 180.0),
        ("psa-rexroth", "eq 14", "", 180.0),
    ],
)
def test_what_a_misprint_costs(key: str, where: str, printed: str, greatest: float) -> None:
    assert numbers(key, where, printed)[0] == pytest.approx(greatest, rel=0.01)


@pytest.mark.parametrize(
    ("value", "count", "shown_as"),
    [(7.1e-7, 1, "0.0000007"), (107.3, 2, "107"), (-5.73447, 5, "-5.7345"), (0.0, 1, "0")],
)
def test_measured_effects_are_never_powers_of_ten(value: float, count: int, shown_as: str) -> None:
    assert figures(value, count) == shown_as
