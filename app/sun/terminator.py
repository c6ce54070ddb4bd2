"""Where on Earth the sun is in the zenith, and the line between day and night."""

from datetime import datetime
from math import asin, atan, atan2, copysign, cos, degrees, radians, sin, tan

from app.sun.position import Algorithm, Location, sun_position

EQUATOR = Location(0.0, 0.0)
LEAST_DECLINATION_DEG = 1e-6
"""At an equinox the line runs through both poles: it is then drawn for a sun just beside the equator."""


def subsolar_point(algorithm: Algorithm, at: datetime) -> Location:
    """Return where the sun is in the zenith at an aware instant; raises `InstantRefused` as `sun_position`.

    What is seen of the sun at latitude and longitude zero gives its direction from the middle of the Earth.
    """
    seen = sun_position(algorithm, EQUATOR, at)
    azimuth, elevation = radians(seen.azimuth_deg), radians(seen.elevation_deg)
    north = cos(elevation) * cos(azimuth)
    east = cos(elevation) * sin(azimuth)
    return Location(degrees(asin(north)), degrees(atan2(east, sin(elevation))))


def terminator_deg(subsolar: Location, longitude_deg: float) -> float:
    """Return the latitude at which the sun's center is on the horizon at a longitude, without refraction."""
    declination_deg = subsolar.latitude_deg
    if abs(declination_deg) < LEAST_DECLINATION_DEG:
        declination_deg = copysign(LEAST_DECLINATION_DEG, declination_deg)
    away = radians(longitude_deg - subsolar.longitude_deg)
    return degrees(atan(-cos(away) / tan(radians(declination_deg))))
