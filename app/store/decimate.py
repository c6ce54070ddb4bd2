"""Fewer frames for a plot that still show every peak."""

import numpy as np
from numpy.typing import NDArray

from app.tracker.memory.recording import COLUMNS, Frames

PEAKS = tuple(index for index, name in enumerate(COLUMNS) if name.endswith(("_deg", "_mps", "_wm2", "_dps")))
FEWEST_POINTS = 2 + 2 * len(PEAKS)


def decimate(frames: Frames, points: int) -> Frames:
    """Return at most `points` of these frames, in order: of equal stretches the extremes of every column.

    Extremes of angles, speeds, wind and light count. First and last frame stay. Raises `ValueError` below
    `FEWEST_POINTS`.
    """
    if points < FEWEST_POINTS:
        raise ValueError(f"Ask for at least {FEWEST_POINTS} points, not {points}.")
    kept, stretches = frames.values, points // 2
    while len(kept) > points:
        kept = kept[_extremes(kept[:, PEAKS].T, -(-len(kept) // stretches))]
        stretches = max(1, stretches * 3 // 4)
    return frames if kept is frames.values else Frames(kept)


def _extremes(angles: NDArray[np.float64], length: int) -> NDArray[np.intp]:
    """Return the places of first, last and the extremes of every column in every stretch of a length."""
    columns, count = angles.shape
    stretches = -(-count // length)
    padded = np.full((columns, stretches * length), np.nan)
    padded[:, :count] = angles
    missing = np.isnan(padded)
    places = [np.array([0, count - 1])]
    for nothing, place_of in ((np.inf, np.argmin), (-np.inf, np.argmax)):
        np.copyto(padded, nothing, where=missing)
        within = place_of(padded.reshape(columns, stretches, length), axis=2)
        places.append((within + np.arange(stretches) * length).ravel())
    return np.unique(np.concatenate(places))
