"""PSA, PSA+ and Koblick for one instant, each in one go: what the controller calls at every tick.

The same equations as in `psa`, `psa_plus` and `koblick`, with the calls between the steps saved and the sun
turned as a vector from the ecliptic to the horizon, so that right ascension and declination need not be
formed. A test holds both forms together to 1e-9 degrees; the numbers in brackets are the papers' equations.
"""

from math import atan2, cos, hypot, sin, sqrt

from app.sun.koblick import DAY_ZERO_UNIX_S
from app.sun.psa import J2000_UNIX_S, PARALLAX
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN


def psa(unix_s: float, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """Return azimuth in (-180, 180] and true elevation, degrees, as `psa.position` does."""
    n = (unix_s - J2000_UNIX_S) / 86400.0
    node = 2.1429 - 0.0010394594 * n  # (3)
    g = 6.2400600 + 0.0172019699 * n  # (5)
    mean = 4.8950630 + 0.017202791698 * n  # (4)
    longitude = mean + sin(g) * (0.03341607 + 0.00069788 * cos(g)) - 0.0001134 - 0.0000203 * sin(node)  # (6)
    tilt = 0.4090928 - 6.2140e-9 * n + 0.0000396 * cos(node)  # (7)
    sidereal_h = 6.6974243242 + 0.0657098283 * n + unix_s % 86400.0 / 3600.0  # (10)
    sidereal = (sidereal_h * 15.0 + longitude_deg) * PER_DEGREE  # (11)
    azimuth, zenith, level = _horizon(longitude, tilt, sidereal, latitude_deg * PER_DEGREE)
    return azimuth * PER_RADIAN, 90.0 - (zenith + PARALLAX * level) * PER_RADIAN  # (16)


def psa_plus(unix_s: float, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """Return azimuth in (-180, 180] and true elevation, degrees, as `psa_plus.position` does."""
    n = (unix_s - J2000_UNIX_S) / 86400.0
    node = 2.267127827 - 9.300339267e-4 * n  # (3)
    g = 6.239468336 + 1.720200135e-2 * n  # (5)
    mean = 4.895036035 + 1.720279602e-2 * n  # (4)
    centre = sin(g) * (3.338320972e-2 + 6.995193752e-4 * cos(g))
    longitude = mean + centre - 1.544353226e-4 - 8.689729360e-6 * sin(node)  # (6)
    tilt = 4.090904909e-1 - 6.213605399e-9 * n + 4.418094944e-5 * cos(node)  # (7)
    sidereal_h = 6.697096103 + 6.570984737e-2 * n + unix_s % 86400.0 / 3600.0  # (10)
    sidereal = (sidereal_h * 15.0 + longitude_deg) * PER_DEGREE  # (11)
    azimuth, zenith, level = _horizon(longitude, tilt, sidereal, latitude_deg * PER_DEGREE)
    return azimuth * PER_RADIAN, 90.0 - (zenith + PARALLAX * level) * PER_RADIAN  # (16)


def koblick(unix_s: float, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """Return azimuth in (-180, 180] and true elevation, degrees, as `koblick.position` does."""
    day = (unix_s - DAY_ZERO_UNIX_S) / 86400.0
    w = 282.9404 + 4.70935e-5 * day  # (3)
    e = 0.016709 - 1.151e-9 * day  # (4)
    m_deg = (356.0470 + 0.9856002585 * day) % 360.0  # (5)
    m = m_deg * PER_DEGREE
    anomaly = m + e * sin(m) * (1.0 + e * cos(m))  # (8)
    longitude = atan2(sin(anomaly) * sqrt(1.0 - e * e), cos(anomaly) - e) + w * PER_DEGREE  # (9 to 13)
    tilt = (23.4393 - 3.563e-7 * day) * PER_DEGREE  # (7)
    sidereal_deg = w + m_deg + 180.0 + unix_s % 86400.0 / 240.0 + longitude_deg  # (6, 24, 25)
    azimuth, zenith, _ = _horizon(longitude, tilt, sidereal_deg * PER_DEGREE, latitude_deg * PER_DEGREE)
    return azimuth * PER_RADIAN, 90.0 - zenith * PER_RADIAN


def _horizon(longitude: float, tilt: float, sidereal: float, latitude: float) -> tuple[float, float, float]:
    """Return azimuth in (-pi, pi], zenith distance and its sine for an ecliptic longitude, all in radians."""
    x, y_ecliptic = cos(longitude), sin(longitude)
    y, z = cos(tilt) * y_ecliptic, sin(tilt) * y_ecliptic
    cos_sidereal, sin_sidereal = cos(sidereal), sin(sidereal)
    equator = x * cos_sidereal + y * sin_sidereal
    east = y * cos_sidereal - x * sin_sidereal
    cos_lat, sin_lat = cos(latitude), sin(latitude)
    north = z * cos_lat - equator * sin_lat
    level = hypot(east, north)
    return atan2(east, north), atan2(level, z * sin_lat + equator * cos_lat), level
