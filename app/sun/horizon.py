"""The horizon as it was entered by hand: how high hills, trees and houses stand in each direction."""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise

from app.base.message import N_, say, with_format

OUTLINE_STEP_DEG = 5.0
MOST_POINTS = 72


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
        place = bisect_right([one for one, _ in self.points], azimuth_deg)
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
