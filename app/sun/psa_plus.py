"""PSA+: Blanco, Milidonis and Bonanos, "Updating the PSA sun position algorithm", Solar Energy 212 (2020).

doi:10.1016/j.solener.2020.10.084, pages 339-341. The chain of PSA (2001) with coefficients fitted anew; the
equation numbers are those of `psa`. Here the sun is turned as a vector from the ecliptic to the horizon, so
that right ascension and declination need not be formed: the same numbers, faster over arrays. Angles inside
the chain are radians; what leaves `position` is degrees.
"""

from math import cos, radians, sin

from app.sun.psa import PARALLAX, days_since_2000, hour_of_day, local_sidereal_time
from app.sun.trigonometry import PER_RADIAN, T, Trigonometry


def node_longitude(n: T) -> T:
    """Return Omega, the term of the moon's node (eq 3), radians."""
    return 2.267127827 - 9.300339267e-4 * n


def mean_longitude(n: T) -> T:
    """Return the mean longitude L (eq 4), radians, not wrapped."""
    return 4.895036035 + 1.720279602e-2 * n


def mean_anomaly(n: T) -> T:
    """Return the mean anomaly g (eq 5), radians, not wrapped."""
    return 6.239468336 + 1.720200135e-2 * n


def ecliptic_longitude(longitude: T, anomaly: T, node: T, trig: Trigonometry[T]) -> T:
    """Return the ecliptic longitude l (eq 6), radians; sin 2g is written as 2 sin g cos g."""
    centre = trig.sin(anomaly) * (3.338320972e-2 + 6.995193752e-4 * trig.cos(anomaly))
    return longitude + centre - 1.544353226e-4 - 8.689729360e-6 * trig.sin(node)


def obliquity(n: T, node: T, trig: Trigonometry[T]) -> T:
    """Return the obliquity of the ecliptic (eq 7), radians."""
    return 4.090904909e-1 - 6.213605399e-9 * n + 4.418094944e-5 * trig.cos(node)


def equatorial_vector(longitude: T, tilt: T, trig: Trigonometry[T]) -> tuple[T, T, T]:
    """Return the unit vector to the sun, x to the equinox, z to the north pole (in place of eqs 8 and 9)."""
    sin_l = trig.sin(longitude)
    return trig.cos(longitude), trig.cos(tilt) * sin_l, trig.sin(tilt) * sin_l


def greenwich_sidereal_time(n: T, hour: T) -> T:
    """Return Greenwich mean sidereal time (eq 10), hours, not wrapped."""
    return 6.697096103 + 6.570984737e-2 * n + hour


def horizon_vector(
    sun: tuple[T, T, T], sidereal_time: T, latitude_deg: float, trig: Trigonometry[T]
) -> tuple[T, T, T]:
    """Return the unit vector to the sun, east, north and up (in place of eqs 12 to 14)."""
    x, y, z = sun
    latitude = radians(latitude_deg)
    sin_lat, cos_lat = sin(latitude), cos(latitude)
    cos_sidereal, sin_sidereal = trig.cos(sidereal_time), trig.sin(sidereal_time)
    equator = x * cos_sidereal + y * sin_sidereal
    east = y * cos_sidereal - x * sin_sidereal
    return east, z * cos_lat - equator * sin_lat, z * sin_lat + equator * cos_lat


def horizontal(east: T, north: T, up: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth in (-pi, pi] and zenith distance with parallax (eqs 15 and 16), radians."""
    sin_zenith = trig.hypot(east, north)
    return trig.atan2(east, north), trig.atan2(sin_zenith, up) + PARALLAX * sin_zenith


def position(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth from north clockwise in (-180, 180] and true elevation, degrees.

    Within 0.0085 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    n, hour = days_since_2000(unix_s), hour_of_day(unix_s, trig)
    node = node_longitude(n)
    longitude = ecliptic_longitude(mean_longitude(n), mean_anomaly(n), node, trig)
    sun = equatorial_vector(longitude, obliquity(n, node, trig), trig)
    sidereal = local_sidereal_time(greenwich_sidereal_time(n, hour), longitude_deg)
    azimuth, zenith = horizontal(*horizon_vector(sun, sidereal, latitude_deg, trig), trig)
    return azimuth * PER_RADIAN, 90.0 - zenith * PER_RADIAN
