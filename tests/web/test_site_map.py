"""The map of the location page: which part of the world it shows, and what is where on it."""

import re
from datetime import UTC, datetime

import pytest

from app.sun.position import Algorithm, Location, sun_position
from app.web.features.site.place import Mistake
from app.web.features.site.site_map import LARGER_DEG, crop_around, night_path, on_path, site_map
from tests.web.test_place import SAMSUN, SUMMER

WEST = Location(41.2867, -36.33)
FIJI = Location(-17.8, 178.0)
POLE = Location(89.0, 15.0)


def box(places: list[Location], width_deg: float = 200.0) -> tuple[float, ...]:
    found = crop_around(places, width_deg)
    return found.x, found.y, found.width, found.height


def test_the_whole_world_is_shown_while_no_location_is_entered() -> None:
    assert box([]) == (0.0, -468.0, 3600.0, 2736.0)


def test_a_crop_of_200_by_152_degrees_has_the_location_in_its_middle() -> None:
    x, y, width, height = box([Location(0.0, 10.0)])
    assert (width, height) == (2000.0, 1520.0)
    assert on_path(Location(0.0, 10.0)) == (x + width / 2, y + height / 2)


def test_the_larger_crop_is_of_60_by_46_degrees() -> None:
    assert box([SAMSUN], LARGER_DEG)[2:] == (600.0, 456.0)


@pytest.mark.parametrize("places", [[FIJI], [POLE], [Location(-18.0, -179.0)], [Location(-89.0, 0.0)]])
def test_the_crop_ends_at_the_date_line_and_the_poles(places: list[Location]) -> None:
    x, y, width, height = box(places)
    assert -90 <= x <= 3690 - width
    assert -90 <= y <= 1890 - height
    for across, down in map(crop_around(places, 200.0).percent, places):
        assert 3 <= across <= 97
        assert 3 <= down <= 97


@pytest.mark.parametrize(
    "places", [[SAMSUN, WEST], [FIJI, Location(-17.8, -178.0)], [POLE, Location(-89, 15)]]
)
def test_both_locations_are_on_the_map_while_it_is_asked_about_one(places: list[Location]) -> None:
    found = site_map(Algorithm.PSA, SUMMER, places, Mistake.EAST_WEST, is_asked=True)
    assert [mark.kind for mark in found.marks] == ["doubted", "other"]
    assert all(2 <= mark.x <= 98 and 2 <= mark.y <= 98 for mark in found.marks)


def test_labels_tell_the_two_locations_apart_and_do_not_lie_on_one_another() -> None:
    sides = site_map(Algorithm.PSA, SUMMER, [WEST, SAMSUN], Mistake.EAST_WEST, is_asked=True)
    assert [mark.label for mark in sides.marks] == ["36.33° W", "36.33° E"]
    assert [mark.below for mark in sides.marks] == [False, False]
    swapped = Location(36.33, 41.2867)
    near = site_map(Algorithm.PSA, SUMMER, [swapped, SAMSUN], Mistake.SWAPPED, is_asked=True)
    assert [mark.label for mark in near.marks] == ["36.33° N", "41.29° N"]
    assert [mark.below for mark in near.marks] == [True, False], "the northern one has its label above"


@pytest.mark.parametrize("at", [SUMMER, datetime(2027, 12, 21, 18, tzinfo=UTC)])
def test_it_is_night_within_the_path_and_the_sun_is_at_its_zenith(at: datetime) -> None:
    found = site_map(Algorithm.PSA, at, [])
    assert found.sun is not None
    x, y, width, height = box([])
    there = Location(
        90.0 - (y + found.sun.y / 100 * height) / 10.0, (x + found.sun.x / 100 * width) / 10.0 - 180.0
    )
    assert sun_position(Algorithm.PSA, there, at).elevation_deg == pytest.approx(90.0, abs=0.2)
    points = [tuple(map(float, one)) for one in re.findall(r"(-?\d+) (-?\d+)", found.night)]
    *edge, (_, dark), _ = points
    for across, down in edge:
        beside = Location(90.0 - down / 10.0, (across / 10.0) % 360.0 - 180.0)
        assert sun_position(Algorithm.PSA, beside, at).elevation_deg == pytest.approx(0.0, abs=0.1)
    pole = Location(-90.0 if dark > 1800 else 90.0, 0.0)
    assert sun_position(Algorithm.PSA, pole, at).elevation_deg < 0, "the path goes on over the dark pole"


def test_the_night_is_south_of_the_line_in_the_northern_summer() -> None:
    assert night_path(Location(23.0, 0.0)).endswith("L3690 3600L-90 3600Z")
    assert night_path(Location(-23.0, 0.0)).endswith("L3690 -1800L-90 -1800Z")


def test_a_clock_of_years_without_a_known_sun_leaves_the_map() -> None:
    found = site_map(Algorithm.PSA, datetime(1900, 1, 1, tzinfo=UTC), [SAMSUN])
    assert (found.night, found.sun) == ("", None)
    assert len(found.marks) == 1
