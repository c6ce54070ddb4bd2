"""What is told of a day by one strategy; the panel knows this without loading what works it out."""

from dataclasses import dataclass

CURVE_S = 120


@dataclass(frozen=True, slots=True)
class StrategyDay:
    """A day by one strategy, and its curves: one value for every 120 s, sky degrees.

    `moves` counts motions from standstill to standstill. Errors are the angle between the panel and where it
    would face following its mode all the time, while the sun is up; None if it never is. Where light sensors
    correct, panel means where it really faces: the axis angles less the misalignment that is simulated.
    """

    moves: int
    largest_error_deg: float | None
    mean_error_deg: float | None
    travel_azimuth_deg: float
    travel_elevation_deg: float
    elapsed_s: tuple[float, ...]
    sun_azimuth_deg: tuple[float, ...]
    sun_elevation_deg: tuple[float, ...]
    panel_azimuth_deg: tuple[float, ...]
    panel_elevation_deg: tuple[float, ...]
