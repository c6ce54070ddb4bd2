"""Sun positions in one compiled pass: PSA+ from its equations, SPA from a table of daily cubics."""

from math import cos, degrees, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from app.fast.compiled import compiled
from app.fast.spa_table import DAY_S, SpaTable
from app.fast.trigonometry import arctangent2, sine_cosine
from app.sun.position import Location, SunPath, wrap360_path
from app.sun.psa import J2000_UNIX_S, PARALLAX
from app.sun.refraction import refraction_path
from app.sun.trigonometry import Array

Indices = NDArray[np.intp]

PER_RADIAN = degrees(1.0)
PER_DAY = 1.0 / DAY_S
TILT = 0.40909
SIN_TILT, COS_TILT = sin(TILT), cos(TILT)
HOUR_RADIANS = pi / 12.0
POLAR_FLATTENING = 0.99664719
EARTH_RADIUS_M = 6_378_140.0


def psa_plus_path(location: Location, at_unix_s: Array) -> SunPath:
    """Return what `sun_path` returns for PSA+, seconds since 1970 UTC in a one-dimensional array.

    Within 2e-6 degrees of the same algorithm in NumPy.
    """
    return _path(*psa_plus_angles(location, at_unix_s))


def psa_plus_angles(location: Location, at_unix_s: Array) -> tuple[Array, Array]:
    """Return azimuth in [-180, 180] and true elevation, degrees."""
    azimuth_deg, elevation_deg = np.empty_like(at_unix_s), np.empty_like(at_unix_s)
    latitude = radians(location.latitude_deg)
    place = (sin(latitude), cos(latitude), radians(location.longitude_deg))
    _psa_plus(at_unix_s, place, azimuth_deg, elevation_deg)
    return azimuth_deg, elevation_deg


def spa_path(table: SpaTable, location: Location, at_unix_s: Array) -> SunPath:
    """Return NREL SPA's sun from a table that covers the instants, seconds since 1970 UTC.

    Within 1e-5 degrees of SPA. The instants must ascend. Raises `ValueError` for one outside the table.
    """
    if at_unix_s.size and not table.covers(float(at_unix_s[0]), float(at_unix_s[-1])):
        raise ValueError("The table of the sun does not cover these instants; build it for their years.")
    return _path(*spa_angles(table, location, at_unix_s))


def spa_angles(table: SpaTable, location: Location, at_unix_s: Array) -> tuple[Array, Array]:
    """Return azimuth in [-180, 180] and true elevation, degrees, as `spa_path` does, without its checks."""
    azimuth_deg, elevation_deg = np.empty_like(at_unix_s), np.empty_like(at_unix_s)
    latitude = radians(location.latitude_deg)
    axial, polar = _geocentric(latitude, location.altitude_m)
    place = (sin(latitude), cos(latitude), radians(location.longitude_deg), axial, polar)
    begins_s = (table.first_day + np.arange(len(table.terms) + 1)) * DAY_S
    noons_s = np.asarray(begins_s[:-1] + DAY_S / 2.0, dtype=np.float64)
    edges = np.searchsorted(at_unix_s, begins_s)
    _spa(at_unix_s, edges, noons_s, table.terms, place, azimuth_deg, elevation_deg)
    return azimuth_deg, elevation_deg


def _path(azimuth_deg: Array, elevation_deg: Array) -> SunPath:
    return SunPath(wrap360_path(azimuth_deg), elevation_deg, elevation_deg + refraction_path(elevation_deg))


def _geocentric(latitude: float, altitude_m: float) -> tuple[float, float]:
    """Return the distance from the Earth's axis and from the equator, in Earth radii (SPA 3.12)."""
    u = np.arctan2(POLAR_FLATTENING * sin(latitude), cos(latitude))
    height = altitude_m / EARTH_RADIUS_M
    return cos(u) + height * cos(latitude), POLAR_FLATTENING * sin(u) + height * sin(latitude)


@compiled
def _psa_plus(
    at_unix_s: Array, place: tuple[float, float, float], azimuth_deg: Array, elevation_deg: Array
) -> None:
    """Turn PSA+'s sun as a vector from the ecliptic to the horizon."""
    sin_latitude, cos_latitude, longitude = place
    for i in range(at_unix_s.size):
        n = (at_unix_s[i] - J2000_UNIX_S) * PER_DAY
        sin_node, cos_node = sine_cosine(2.267127827 - 9.300339267e-4 * n)
        sin_g, cos_g = sine_cosine(6.239468336 + 1.720200135e-2 * n)
        centre = (
            sin_g * (3.338320972e-2 + 6.995193752e-4 * cos_g) - 1.544353226e-4 - 8.689729360e-6 * sin_node
        )
        y_ecliptic, x = sine_cosine(4.895036035 + 1.720279602e-2 * n + centre)
        tilt = 4.090904909e-1 - TILT - 6.213605399e-9 * n + 4.418094944e-5 * cos_node
        y, z = (COS_TILT - SIN_TILT * tilt) * y_ecliptic, (SIN_TILT + COS_TILT * tilt) * y_ecliptic
        hour = (n + 0.5 - np.floor(n + 0.5)) * 24.0
        sidereal = (6.697096103 + 6.570984737e-2 * n + hour) * HOUR_RADIANS + longitude
        sin_sidereal, cos_sidereal = sine_cosine(sidereal)
        equator = x * cos_sidereal + y * sin_sidereal
        east = y * cos_sidereal - x * sin_sidereal
        north = z * cos_latitude - equator * sin_latitude
        level = np.sqrt(east * east + north * north)
        azimuth_deg[i] = arctangent2(east, north) * PER_RADIAN
        zenith = arctangent2(level, z * sin_latitude + equator * cos_latitude)
        elevation_deg[i] = 90.0 - (zenith + PARALLAX * level) * PER_RADIAN


@compiled
def _spa_day(
    at_unix_s: Array,
    noon_s: float,
    terms: Array,
    place: tuple[float, float, float, float, float],
    azimuth_deg: Array,
    elevation_deg: Array,
) -> None:
    """Turn the sun of one day, moved by its parallax, to the observer's horizon."""
    sin_latitude, cos_latitude, longitude, axial, polar = place
    a0, a1, a2, a3 = terms[0] + longitude, terms[1], terms[2], terms[3]
    s0, s1, s2, s3 = terms[4] - terms[12] * polar, terms[5], terms[6], terms[7]
    c0, c1, c2, c3 = terms[8], terms[9], terms[10], terms[11]
    beside = terms[12] * axial
    for i in range(at_unix_s.size):
        at = (at_unix_s[i] - noon_s) * PER_DAY
        angle = a0 + at * (a1 + at * (a2 + at * a3))
        cos_declination = c0 + at * (c1 + at * (c2 + at * c3))
        z = s0 + at * (s1 + at * (s2 + at * s3))
        sin_angle, cos_angle = sine_cosine(angle)
        equator = cos_declination * cos_angle - beside
        east = -cos_declination * sin_angle
        north = z * cos_latitude - equator * sin_latitude
        up = z * sin_latitude + equator * cos_latitude
        azimuth_deg[i] = arctangent2(east, north) * PER_RADIAN
        elevation_deg[i] = arctangent2(up, np.sqrt(east * east + north * north)) * PER_RADIAN


@compiled
def _spa(
    at_unix_s: Array,
    edges: Indices,
    noons_s: Array,
    terms: Array,
    place: tuple[float, float, float, float, float],
    azimuth_deg: Array,
    elevation_deg: Array,
) -> None:
    """Evaluate each day's cubics over its instants, which lie between two of the edges."""
    for day in range(terms.shape[0]):
        span = slice(edges[day], edges[day + 1])
        _spa_day(at_unix_s[span], noons_s[day], terms[day], place, azimuth_deg[span], elevation_deg[span])
