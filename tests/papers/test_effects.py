"""The effects of misprints: none is typed, and those without a model are recomputed here by other means."""

import ast
import re
from collections.abc import Iterator
from math import acos, cos, degrees, radians, sin, tan
from pathlib import Path

import numpy as np
import pytest

from app.research.effect import Effect, Measured, effect, not_measured
from app.research.library import LIBRARY, paper
from app.research.sampling import sample
from app.sun.accuracy import separations_deg
from app.sun.trigonometry import Array

SOURCES = Path(__file__).parents[2] / "app" / "research"
GIVEN = {"MOUNTAIN_KM"}
"""What an effect names and does not claim: the height at which it is told."""

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


def calls(tree: ast.AST, name: str) -> Iterator[ast.Call]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name:
            yield node


def typed(value: ast.expr) -> bool:
    """Return whether an expression is made of literals and constants alone."""
    names = [node.id for node in ast.walk(value) if isinstance(node, ast.Name)]
    return all(name.isupper() and name not in GIVEN for name in names)


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


def test_no_number_of_an_effect_is_typed_into_its_place() -> None:
    """One number may stand as it is divided: a circle by the counts of an encoder that the paper prints."""
    found = [
        (path.name, ast.unparse(call))
        for path in sorted(SOURCES.glob("*.py"))
        for call in calls(ast.parse(path.read_text()), "Measured")
        if typed(call.args[0])
    ]
    assert found == [("xia.py", "Measured(360.0 / ENCODER_COUNTS, 1)")]
    assert typed(ast.parse("36.0", mode="eval").body)
    assert not typed(ast.parse("3600.0 * off_h", mode="eval").body)


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


def lying(azimuth_deg: Array, elevation_deg: Array) -> Array:
    """Return how far suns are from those whose azimuth is turned by 180 degrees."""
    return separations_deg(azimuth_deg, elevation_deg, azimuth_deg + 180.0, elevation_deg)


def test_an_hour_of_offset_and_three_turn_the_sun_by_so_much() -> None:
    assert numbers("gezegin-dirik", "HMI, step 2")[0] == pytest.approx(turned(15.0), abs=0.05)
    assert numbers("gezegin-dirik", "text, section 3")[0] == pytest.approx(turned(45.0), abs=0.05)


def test_an_azimuth_from_south_taken_for_one_from_north_turns_the_sun() -> None:
    apart = np.concatenate(
        [lying(one.reference.azimuth_deg, one.reference.elevation_deg) for one in sample()]
    )
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


def test_without_y_the_azimuth_is_due_south_or_due_north() -> None:
    squares, count = 0.0, 0
    for one in sample():
        azimuth_deg, elevation_deg = one.reference.azimuth_deg, one.reference.elevation_deg
        south = np.where(np.abs(np.mod(azimuth_deg, 360.0) - 180.0) < 90.0, 180.0, 0.0)
        apart = separations_deg(south, elevation_deg, azimuth_deg, elevation_deg)
        squares, count = squares + float(np.sum(apart**2)), count + len(apart)
    assert numbers("gezegin-dirik", "eq 31")[1] == pytest.approx((squares / count) ** 0.5, rel=0.01)


def test_what_follows_from_nalinis_numbers() -> None:
    assert numbers("nalini-hemavathi", "text above eq 3") == pytest.approx([0.05], abs=0.001)
    assert numbers("nalini-hemavathi", "table 1") == pytest.approx(
        [26.78 - 26.033, 122.604 - 121.99], abs=0.001
    )
    assert numbers("nalini-hemavathi", "below table 1") == pytest.approx([0.38, 0.20, 0.0], abs=0.005)
    share_percent, greatest_deg = numbers("nalini-hemavathi", "eq 17")
    assert share_percent == pytest.approx(51.0, abs=1.0)
    assert greatest_deg == pytest.approx(180.0, abs=1.0)


def test_what_follows_from_xias_and_alexandrus_numbers() -> None:
    assert numbers("xia", "section 5") == pytest.approx([1.7 / (36.9**2 / 1600.0)])
    assert numbers("xia", "sections 3 and 4") == pytest.approx([0.1])
    assert numbers("xia", "text below eq 3")[1] > 45.0
    declination = 23.45 * sin(radians(360.0 * (172 - 80) / 365.0))
    half_day_deg = degrees(acos(-tan(radians(45.65)) * tan(radians(declination))))
    assert numbers("alexandru", "section 4", "sunrise") == pytest.approx(
        [60.0 * (4.26 - 12.0 + half_day_deg / 15.0)], abs=0.01
    )
    assert numbers("alexandru", "table 3") == pytest.approx([3600.0 * (14.59 - (24.0 - 9.42))])


def test_a_part_of_the_words_holds_no_digit_on_the_page() -> None:
    for key in LIBRARY:
        for one in paper(key).errata:
            words = "".join(part for part in one.effect.parts if isinstance(part, str))
            assert not re.search(r"\d", words), one.where
