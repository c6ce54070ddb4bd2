"""What views of the sun say about the clock: only what several of them agree on, hours apart."""

from collections.abc import Sequence
from datetime import timedelta

from app.sun.position import Algorithm, Location
from app.tracker.commissioning.alignment import Mistake, diagnose
from app.tracker.memory.memory import Sighting

NEWEST = 6
FEWEST = 2
APART = timedelta(hours=1)
AGREE_WITHIN_S = 60.0
"""A view that is 0.25 degrees off is one minute of the sun off."""


def clock_error(
    sightings: Sequence[Sighting],
    location: Location,
    algorithm: Algorithm = Algorithm.PSA,
    *,
    refraction: bool = True,
) -> timedelta | None:
    """Return by how much the clock is fast by the newest sightings (negative: slow), None if they differ.

    A wrong zero can look like a wrong clock for one view of the sun, but not for views an hour apart: each
    must have the clock for its most likely mistake, and all the same error within a minute.
    """
    newest = sorted(sightings, key=lambda one: one.at)[-NEWEST:]
    if len(newest) < FEWEST or newest[-1].at - newest[0].at < APART:
        return None
    errors_s = []
    for sighting in newest:
        causes = diagnose(sighting, location, algorithm, refraction=refraction)
        if not causes or causes[0].mistake is not Mistake.CLOCK or causes[0].shift_s is None:
            return None
        errors_s.append(-causes[0].shift_s)
    if max(errors_s) - min(errors_s) > AGREE_WITHIN_S:
        return None
    return timedelta(seconds=sum(errors_s) / len(errors_s))
