"""The entered horizon: straight between its points, all the way round, and what it hides."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.sun.horizon import FLAT, MOST_POINTS, Horizon

HILLS = Horizon(((20.0, 4.0), (100.0, 12.0), (260.0, 8.0), (340.0, 2.0)))
azimuths = st.lists(st.integers(0, 359), min_size=1, max_size=20, unique=True).map(sorted)


def test_it_runs_straight_between_its_points_also_over_north() -> None:
    assert HILLS.height_deg(100.0) == 12.0
    assert HILLS.height_deg(60.0) == pytest.approx(8.0)
    assert HILLS.height_deg(0.0) == pytest.approx(3.0), "half-way from 340 to 20 degrees"
    assert HILLS.height_deg(360.0) == HILLS.height_deg(0.0)
    assert Horizon(((90.0, 5.0),)).height_deg(271.0) == 5.0


def test_it_hides_what_is_below_it_and_above_a_flat_one() -> None:
    assert HILLS.hides(100.0, 11.9)
    assert not HILLS.hides(100.0, 12.1)
    assert not HILLS.hides(100.0, -0.1), "that has set"
    assert not FLAT.hides(100.0, 0.0)
    assert FLAT.outline() == ()


@given(azimuths, st.data())
def test_the_outline_meets_every_point_and_closes(places: list[int], data: st.DataObject) -> None:
    heights = data.draw(st.lists(st.floats(0, 89), min_size=len(places), max_size=len(places)))
    horizon = Horizon(tuple(zip(map(float, places), heights, strict=True)))
    outline = dict(horizon.outline())
    assert outline[0.0] == outline[360.0]
    for azimuth_deg, elevation_deg in horizon.points:
        assert outline[azimuth_deg] == pytest.approx(elevation_deg, abs=0.006)
    assert max(outline.values()) <= max(heights) + 0.006


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        (((360.0, 1.0),), "azimuth of the horizon must be 0 to below 360, not 360"),
        (((10.0, 90.0),), "elevation of the horizon must be 0 to below 90, not 90"),
        (((10.0, -1.0),), "elevation of the horizon must be 0 to below 90, not -1"),
        (((20.0, 1.0), (10.0, 1.0)), "ascending order of azimuth"),
        (((20.0, 1.0), (20.0, 2.0)), "each azimuth only once"),
        (tuple((float(one), 1.0) for one in range(MOST_POINTS + 1)), "at most 360 points"),
    ],
)
def test_points_that_do_not_fit_are_refused(points: tuple[tuple[float, float], ...], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        Horizon(points)
