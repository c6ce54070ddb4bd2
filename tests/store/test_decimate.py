"""Fewer frames keep every peak, the order of time and the ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from app.store.decimate import FEWEST_POINTS, PEAKS, decimate
from app.tracker.memory.recording import COLUMNS, Frames
from tests.store.tracked_day import tracked_day

values = st.one_of(st.floats(-400.0, 400.0), st.just(np.nan))
some_frames = st.integers(1, 120).flatmap(
    lambda rows: arrays(np.float64, (rows, len(COLUMNS)), elements=values)
)


@given(some_frames, st.integers(FEWEST_POINTS, 60))
def test_peaks_order_and_ends_stay(given_values: NDArray[np.float64], points: int) -> None:
    given_values[:, 0] = np.arange(len(given_values))
    frames = Frames(given_values)
    few = decimate(frames, points)
    assert points < len(frames) or few is frames
    assert len(few) == len(given_values) or len(few) <= points
    elapsed_s = few.column("elapsed_s")
    np.testing.assert_array_equal(few.values, given_values[elapsed_s.astype(int)])
    assert (np.diff(elapsed_s) > 0).all()
    assert elapsed_s[0] == 0.0
    assert elapsed_s[-1] == len(given_values) - 1
    for column in PEAKS:
        known = given_values[:, column][~np.isnan(given_values[:, column])]
        kept = few.values[:, column]
        if len(known):
            assert np.nanmin(kept) == known.min()
            assert np.nanmax(kept) == known.max()


def test_most_of_the_points_are_used() -> None:
    assert 500 <= len(decimate(tracked_day(9000), 1000)) <= 1000


def test_too_few_points_are_refused() -> None:
    with pytest.raises(ValueError, match="at least 32 points"):
        decimate(tracked_day(300), FEWEST_POINTS - 1)
