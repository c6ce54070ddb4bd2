"""PSA: Blanco-Muriel et al., "Computing the solar vector", Solar Energy 70 (2001) 431-441.

doi:10.1016/S0038-092X(00)00156-0

Equation numbers are those of the reprint in "PLC based dual-axis tracker" (PSA on Rexroth). The reprint's
arctangents of eqs 8 and 14 must be four-quadrant, and in eq 11 pi/180 multiplies the whole bracket. Angles
inside the chain are radians, as published; what leaves `position` is degrees.
"""

from math import cos, radians, sin

from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, T, Trigonometry

J2000_UNIX_S = 946_728_000.0
EARTH_MEAN_RADIUS_KM = 6371.01
ASTRONOMICAL_UNIT_KM = 149_597_890.0
PARALLAX = EARTH_MEAN_RADIUS_KM / ASTRONOMICAL_UNIT_KM


def julian_day(year: int, month: int, day: int, hour: float) -> float:
    """Return the Julian day of a Gregorian date and a decimal hour UT (eq 1); divisions truncate."""
    a = int((month - 14) / 12)
    years = int(1461 * (year + 4800 + a) / 4)
    months = int(367 * (month - 2 - 12 * a) / 12)
    centuries = int(3 * int((year + 4900 + a) / 100) / 4)
    return years + months - centuries + day - 32075 - 0.5 + hour / 24.0


def days_since_2000(unix_s: T) -> T:
    """Return days since 2000-01-01 12:00 UT (eq 2), from seconds since 1970."""
    return (unix_s - J2000_UNIX_S) / 86400.0


def hour_of_day(unix_s: T, trig: Trigonometry[T]) -> T:
    """Return the decimal hour UT, in [0, 24)."""
    return trig.wrap(unix_s, 86400.0) / 3600.0


def node_longitude(n: T) -> T:
    """Return Omega, the term of the moon's node (eq 3), radians."""
    return 2.1429 - 0.0010394594 * n


def mean_longitude(n: T) -> T:
    """Return the mean longitude L (eq 4), radians, not wrapped."""
    return 4.8950630 + 0.017202791698 * n


def mean_anomaly(n: T) -> T:
    """Return the mean anomaly g (eq 5), radians, not wrapped."""
    return 6.2400600 + 0.0172019699 * n


def ecliptic_longitude(longitude: T, anomaly: T, node: T, trig: Trigonometry[T]) -> T:
    """Return the ecliptic longitude l (eq 6), radians; sin 2g is written as 2 sin g cos g."""
    sin_g = trig.sin(anomaly)
    centre = sin_g * (0.03341607 + 0.00069788 * trig.cos(anomaly))
    return longitude + centre - 0.0001134 - 0.0000203 * trig.sin(node)


def obliquity(n: T, node: T, trig: Trigonometry[T]) -> T:
    """Return the obliquity of the ecliptic (eq 7), radians."""
    return 0.4090928 - 6.2140e-9 * n + 0.0000396 * trig.cos(node)


def equatorial(longitude: T, tilt: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return right ascension in (-pi, pi] (eq 8) and declination (eq 9), radians."""
    sin_l, cos_l = trig.sin(longitude), trig.cos(longitude)
    y, z = trig.cos(tilt) * sin_l, trig.sin(tilt) * sin_l
    return trig.atan2(y, cos_l), trig.atan2(z, trig.hypot(cos_l, y))


def greenwich_sidereal_time(n: T, hour: T) -> T:
    """Return Greenwich mean sidereal time (eq 10), hours, not wrapped."""
    return 6.6974243242 + 0.0657098283 * n + hour


def local_sidereal_time(greenwich: T, longitude_deg: float) -> T:
    """Return local mean sidereal time (eq 11), radians; longitude east positive."""
    return (greenwich * 15.0 + longitude_deg) * PER_DEGREE


def hour_angle(sidereal_time: T, right_ascension: T) -> T:
    """Return the hour angle (eq 12), radians, west positive, not wrapped."""
    return sidereal_time - right_ascension


def horizontal(declination: T, angle: T, latitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return zenith distance (eq 13) and azimuth in (-pi, pi] (eq 14), radians.

    Both are taken from the vector to the sun by arctangent, which stays exact at the zenith and the poles,
    where the printed arccosine does not.
    """
    latitude = radians(latitude_deg)
    sin_lat, cos_lat = sin(latitude), cos(latitude)
    cos_dec, sin_dec = trig.cos(declination), trig.sin(declination)
    east = -cos_dec * trig.sin(angle)
    equator = cos_dec * trig.cos(angle)
    north = sin_dec * cos_lat - equator * sin_lat
    up = sin_dec * sin_lat + equator * cos_lat
    return trig.atan2(trig.hypot(east, north), up), trig.atan2(east, north)


def parallax(zenith: T, trig: Trigonometry[T]) -> T:
    """Return what the observer's place on the Earth's surface adds to a zenith distance (eq 15), radians."""
    return PARALLAX * trig.sin(zenith)


def position(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth from north clockwise in (-180, 180] and true elevation (eq 16), degrees.

    Within 0.0099 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    n, hour = days_since_2000(unix_s), hour_of_day(unix_s, trig)
    node = node_longitude(n)
    longitude = ecliptic_longitude(mean_longitude(n), mean_anomaly(n), node, trig)
    right_ascension, declination = equatorial(longitude, obliquity(n, node, trig), trig)
    sidereal = local_sidereal_time(greenwich_sidereal_time(n, hour), longitude_deg)
    angle = hour_angle(sidereal, right_ascension)
    zenith, azimuth = horizontal(declination, angle, latitude_deg, trig)
    zenith = zenith + parallax(zenith, trig)
    return azimuth * PER_RADIAN, 90.0 - zenith * PER_RADIAN
