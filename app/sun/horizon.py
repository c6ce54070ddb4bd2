"""The horizon as it was entered by hand: how high hills, trees and houses stand in each direction."""

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from operator import itemgetter

from app.base.message import N_, say, with_format

OUTLINE_STEP_DEG = 5.0
MOST_POINTS = 360


@dataclass(frozen=True, slots=True)
class Horizon:
    """Points of the skyline: azimuth in [0, 360) and elevation in [0, 90), degrees, by rising azimuth.

    Between two points it runs straight, also over north; one point alone is its height all round, and
    without points the horizon is flat. Raises `ValueError` with a sentence for points that do not fit.
    """

    points: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        if len(self.points) > MOST_POINTS:
            raise ValueError(say("The horizon takes at most {most_points} points.", most_points=MOST_POINTS))
        for azimuth_deg, elevation_deg in self.points:
            if not 0.0 <= azimuth_deg < 360.0:
                raise ValueError(
                    say(
                        "An azimuth of the horizon must be 0 to below 360, not {azimuth_deg}.",
                        azimuth_deg=with_format(azimuth_deg, "g"),
                    )
                )
            if not 0.0 <= elevation_deg < 90.0:
                raise ValueError(
                    say(
                        "An elevation of the horizon must be 0 to below 90, not {elevation_deg}.",
                        elevation_deg=with_format(elevation_deg, "g"),
                    )
                )
        azimuths = [azimuth_deg for azimuth_deg, _ in self.points]
        if any(after <= before for before, after in pairwise(azimuths)):
            raise ValueError(
                N_("The points of the horizon must be in ascending order of azimuth, each azimuth only once.")
            )

    def height_deg(self, azimuth_deg: float) -> float:
        """Return how high the horizon stands in a direction, degrees; 0 where none was entered."""
        if not self.points:
            return 0.0
        azimuth_deg %= 360.0
        place = bisect_right(self.points, azimuth_deg, key=itemgetter(0))
        before, below_deg = self.points[place - 1]
        after, above_deg = self.points[place % len(self.points)]
        span_deg = (after - before) % 360.0
        share = ((azimuth_deg - before) % 360.0) / span_deg if span_deg else 0.0
        return below_deg + (above_deg - below_deg) * share

    def hides(self, azimuth_deg: float, elevation_deg: float) -> bool:
        """Return whether what lies in this direction above a flat horizon is behind the entered one."""
        return 0.0 <= elevation_deg < self.height_deg(azimuth_deg)

    def outline(self) -> tuple[tuple[float, float], ...]:
        """Return the whole skyline, 0 to 360 degrees, its own points among others; empty if it is flat."""
        if not self.points:
            return ()
        steps = {step * OUTLINE_STEP_DEG for step in range(int(360.0 / OUTLINE_STEP_DEG) + 1)}
        azimuths = sorted(steps | {azimuth_deg for azimuth_deg, _ in self.points})
        return tuple((azimuth_deg, round(self.height_deg(azimuth_deg), 2)) for azimuth_deg in azimuths)


FLAT = Horizon()


def joined(points: Iterable[tuple[float, float]]) -> Horizon:
    """Return the horizon of points in any order, of which the same direction may be named twice.

    Azimuths may be -180 to 360, as closed lists have them: 0 and 360 are one point where they have one
    elevation. Raises `ValueError` with both where they differ, and for what `Horizon` refuses.
    """
    turned: dict[float, tuple[float, float]] = {}
    kept: list[tuple[float, float]] = []
    for azimuth_deg, elevation_deg in points:
        north_deg = azimuth_deg % 360.0 % 360.0  # the first is 360 for the smallest negative numbers
        other = turned.setdefault(north_deg, (azimuth_deg, elevation_deg))
        if other == (azimuth_deg, elevation_deg) or other[0] == azimuth_deg:
            kept.append((north_deg, elevation_deg))
        elif other[1] != elevation_deg:
            raise ValueError(
                say(
                    "Azimuths {azimuth1} and {azimuth2} are the same direction, but their elevations are "
                    "{elevation1} and {elevation2}. Give them the same elevation, or leave one out.",
                    azimuth1=with_format(other[0], "g"),
                    azimuth2=with_format(azimuth_deg, "g"),
                    elevation1=with_format(other[1], "g"),
                    elevation2=with_format(elevation_deg, "g"),
                )
            )
    return Horizon(tuple(sorted(kept)))
