"""One sample of instants and places, on which equations are measured against NREL SPA."""

from functools import cache

import numpy as np

from app.research.effect import Measured
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


def told(spread: Spread) -> tuple[Measured | str, ...]:
    """Return a spread as the parts of an effect."""
    return Measured(spread.max_deg, 4), "° (rms ", Measured(spread.rms_deg, 2), "°)"


def worse(printed: Spread, right: Spread) -> tuple[Measured | str, ...]:
    """Return what a misprint costs as the parts of an effect."""
    return "sun off by up to ", *told(printed), " instead of ", *told(right)
