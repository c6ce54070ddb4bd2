"""The numbers at an axis: round, few enough, and written as the language of the page writes them."""

from collections.abc import Callable
from datetime import UTC, datetime

import pytest

from app.web.charts.axis import (
    Scale,
    angle_step,
    around,
    azimuth,
    degrees,
    multiples,
    number,
    number_step,
    time_of_day,
    time_step_s,
    times,
    within,
)
from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of


@pytest.mark.parametrize(
    ("step_of", "span", "most", "step"),
    [
        (number_step, 1013.0, 5, 250.0),
        (number_step, 0.4, 5, 0.1),
        (number_step, 139.0, 5, 50.0),
        (number_step, 0.0, 5, 2e-10),
        (angle_step, 720.0, 5, 90.0),
        (angle_step, 180.0, 5, 45.0),
        (angle_step, 90.0, 6, 15.0),
        (angle_step, 2.0, 5, 0.5),
        (time_step_s, 600, 10, 60),
        (time_step_s, 8 * 3600, 10, 3600),
        (time_step_s, 7 * 86_400, 8, 86_400),
    ],
)
def test_a_step_is_round(step_of: Callable[[float, int], float], span: float, most: int, step: float) -> None:
    """Numbers go in ones, twos, and fives, angles in parts of a quarter turn, time in minutes and hours."""
    assert step_of(span, most) == pytest.approx(step)


def test_values_between_two_lie_between_and_values_around_two_enclose_them() -> None:
    assert within(-21.3, 67.0, 5, angle_step) == (0.0, 30.0, 60.0)
    assert multiples(-45.0, 45.0, 15.0) == (-45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0)
    assert multiples(0.0, 0.3, 0.1) == (0.0, 0.1, 0.2, 0.3), "no 0.30000000000000004"
    for least, most in ((0.0, 1013.0), (-60.0, 97.0), (0.0, 0.4), (5.0, 5.0)):
        ticks = around(least, most, 5)
        assert ticks[0] <= least + 1e-9
        assert ticks[-1] >= most - 1e-9
        assert 2 <= len(ticks) <= 8


def at(*parts: int) -> float:
    return datetime(*parts, tzinfo=UTC).timestamp()  # type: ignore[arg-type, misc] # year to minute


def test_times_are_round_on_the_clock_of_the_zone() -> None:
    found = times(at(2026, 6, 21, 2, 20), at(2026, 6, 21, 17, 40), 13, "Asia/Kolkata")
    assert [time_of_day(one, "Asia/Kolkata") for one in found] == [
        "08:00", "10:00", "12:00", "14:00", "16:00", "18:00", "20:00", "22:00",
    ]  # fmt: skip


def test_times_stay_round_when_the_clocks_change() -> None:
    spring = times(at(2026, 3, 28, 23), at(2026, 3, 29, 22), 8, "Europe/Berlin")
    assert [time_of_day(one, "Europe/Berlin") for one in spring] == [
        "00:00", "03:00", "06:00", "09:00", "12:00", "15:00", "18:00", "21:00", "00:00",
    ]  # fmt: skip
    autumn = times(at(2026, 10, 24, 22), at(2026, 10, 25, 23), 9, "Europe/Berlin")
    assert [time_of_day(one, "Europe/Berlin") for one in autumn][:3] == ["00:00", "03:00", "06:00"]
    assert len(set(autumn)) == len(autumn)
    days = times(at(2026, 3, 26, 12), at(2026, 4, 2, 12), 8, "Europe/Berlin")
    assert [time_of_day(one, "Europe/Berlin") for one in days] == ["00:00"] * 7, "they begin at midnight"


def test_a_scale_places_values_and_tells_a_script_where() -> None:
    scale = Scale(-10.0, 90.0, 300.0, 100.0)
    assert [scale.at(value) for value in (-10.0, 40.0, 90.0)] == [300.0, 200.0, 100.0]
    assert [(tick.at, tick.text) for tick in scale.ticks((0.0, 90.0), degrees)] == [
        (280.0, "0°"),
        (100.0, "90°"),
    ]
    assert scale.data == "-10 90 300 100"


@pytest.mark.parametrize(
    ("code", "texts"),
    [
        ("en", ("−2.5", "0.001°", "90° E", "270° W", "0° N")),
        ("de", ("−2,5", "0,001°", "90° O", "270° W", "0° N")),
    ],
)
def test_numbers_are_written_as_the_language_writes_them(code: str, texts: tuple[str, ...]) -> None:
    token = CATALOGUE.set(catalogue_of(code))
    try:
        assert (number(-2.5), degrees(0.001), azimuth(90.0), azimuth(270.0), azimuth(-0.0)) == texts
    finally:
        CATALOGUE.reset(token)
