"""One sample of instants and places, on which equations are measured against NREL SPA."""

from functools import cache
from math import floor, log10

import numpy as np

from app.sun.accuracy import Question, Sample, Spread, draw, separations_deg, spread_of
from app.sun.algorithms import Many
from app.sun.position import wrap360_path

ASKED = Question(samples=40_000)
"""Of these about 20,000 have the sun up: 2000 to 2049, latitude -65 to 65."""


@cache
def sample() -> tuple[Sample, ...]:
    """Return the sample, drawn once."""
    return draw(ASKED)


def from_spa(position: Many) -> Spread:
    """Return how far a sun is from NREL SPA, degrees."""
    apart = []
    for one in sample():
        azimuth_deg, elevation_deg = position(
            one.unix_s, one.location.latitude_deg, one.location.longitude_deg
        )
        azimuth_deg = wrap360_path(np.mod(azimuth_deg, 360.0))
        apart.append(
            separations_deg(
                azimuth_deg, elevation_deg, one.reference.azimuth_deg, one.reference.elevation_deg
            )
        )
    return spread_of(np.concatenate(apart))


def told(spread: Spread) -> str:
    """Return a spread in words."""
    return f"{figures(spread.max_deg, 4)}° (rms {figures(spread.rms_deg, 2)}°)"


def figures(value: float, count: int) -> str:
    """Return a number above zero with at least so many significant figures, never as a power of ten."""
    before = floor(log10(value)) + 1
    return f"{value:.{max(0, count - before)}f}"


def worse(printed: Spread, right: Spread) -> str:
    """Return in words what a misprint costs."""
    return f"sun off by up to {told(printed)} instead of {told(right)}"
