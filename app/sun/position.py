"""Where the sun stands: the algorithms by name, for one instant and for many."""

from dataclasses import dataclass
from enum import StrEnum


class Algorithm(StrEnum):
    """A published sun position algorithm."""

    PSA = "psa"
    KOBLICK = "koblick"


@dataclass(frozen=True, slots=True)
class Location:
    """A place on Earth: latitude north positive, longitude east positive, altitude in metres."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float = 0.0

    def __post_init__(self) -> None:
        if not -90.0 <= self.latitude_deg <= 90.0:
            raise ValueError(f"Latitude must lie between -90 and 90 degrees, not {self.latitude_deg}.")
        if not -180.0 <= self.longitude_deg <= 180.0:
            raise ValueError(f"Longitude must lie between -180 and 180 degrees, not {self.longitude_deg}.")
        if not -500.0 <= self.altitude_m <= 9000.0:
            raise ValueError(f"Altitude must lie between -500 and 9000 metres, not {self.altitude_m}.")


@dataclass(frozen=True, slots=True)
class SunPosition:
    """Azimuth clockwise from true north [0, 360), elevation without and with refraction, degrees."""

    azimuth_deg: float
    elevation_deg: float
    apparent_elevation_deg: float
