"""Where a panel faces."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Orientation:
    """A direction of the panel's normal: azimuth from north clockwise, elevation above the horizon."""

    azimuth_deg: float
    elevation_deg: float
