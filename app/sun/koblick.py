"""Koblick's SolarAzEl (Schlyter's low-precision sun) as Gezegin & Dirik (2022) print it for their panel.

Equation numbers are the paper's. Corrected misprints: the signs and the month rule of eq 1, the sign of eq 4,
degrees in eqs 7 to 13 and 21 to 26, the obliquity of the day in eq 19 in place of a constant, y in eq 31;
the altitude term of eq 20 is dropped (it is no parallax). Time is UT. Angles are degrees, as published.
"""

from math import cos, floor, radians, sin

from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, T, Trigonometry

DAY_ZERO_UNIX_S = 946_598_400.0


def julian_day(year: int, month: int, day: int, hour: float) -> float:
    """Return the Julian day of a Gregorian date and a decimal hour UT (eq 1, month rule added)."""
    if month <= 2:
        year, month = year - 1, month + 12
    century = year // 100
    leap = 2 - century + century // 4
    return floor(365.25 * (year + 4716)) + floor(30.6001 * (month + 1)) + leap + day - 1524.5 + hour / 24.0


def day_number(unix_s: T) -> T:
    """Return days since 1999-12-31 00:00 UT (eq 2), from seconds since 1970."""
    return (unix_s - DAY_ZERO_UNIX_S) / 86400.0


def hour_of_day(unix_s: T, trig: Trigonometry[T]) -> T:
    """Return the decimal hour UT (eq 23), in [0, 24)."""
    return trig.wrap(unix_s, 86400.0) / 3600.0


def perihelion(day: T) -> T:
    """Return the longitude of the perihelion w (eq 3), degrees."""
    return 282.9404 + 4.70935e-5 * day


def eccentricity(day: T) -> T:
    """Return the eccentricity of the Earth's orbit e (eq 4; the second term is subtracted)."""
    return 0.016709 - 1.151e-9 * day


def mean_anomaly(day: T, trig: Trigonometry[T]) -> T:
    """Return the mean anomaly M in [0, 360) (eq 5), degrees."""
    return trig.wrap(356.0470 + 0.9856002585 * day, 360.0)


def mean_longitude(perihelion_deg: T, anomaly_deg: T) -> T:
    """Return the sun's mean longitude L (eq 6), degrees, not wrapped."""
    return perihelion_deg + anomaly_deg


def obliquity(day: T) -> T:
    """Return the obliquity of the ecliptic (eq 7), degrees."""
    return 23.4393 - 3.563e-7 * day


def eccentric_anomaly(anomaly_deg: T, e: T, trig: Trigonometry[T]) -> T:
    """Return the eccentric anomaly E to first order (eq 8), degrees."""
    m = anomaly_deg * PER_DEGREE
    return anomaly_deg + PER_RADIAN * e * trig.sin(m) * (1.0 + e * trig.cos(m))


def orbit(eccentric_deg: T, e: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return distance r in astronomical units and true anomaly v in degrees (eqs 9 to 12)."""
    anomaly = eccentric_deg * PER_DEGREE
    x = trig.cos(anomaly) - e
    y = trig.sin(anomaly) * trig.sqrt(1.0 - e * e)
    return trig.hypot(x, y), trig.atan2(y, x) * PER_RADIAN


def true_longitude(true_anomaly_deg: T, perihelion_deg: T) -> T:
    """Return the sun's true longitude (eq 13), degrees, not wrapped."""
    return true_anomaly_deg + perihelion_deg


def equatorial(longitude_deg: T, obliquity_deg: T, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return right ascension in (-180, 180] and declination, degrees (eqs 14 to 22; r cancels)."""
    longitude, tilt = longitude_deg * PER_DEGREE, obliquity_deg * PER_DEGREE
    x, y_ecliptic = trig.cos(longitude), trig.sin(longitude)
    y, z = y_ecliptic * trig.cos(tilt), y_ecliptic * trig.sin(tilt)
    return trig.atan2(y, x) * PER_RADIAN, trig.atan2(z, trig.hypot(x, y)) * PER_RADIAN


def greenwich_sidereal_time(mean_longitude_deg: T, trig: Trigonometry[T]) -> T:
    """Return Greenwich sidereal time at 0 h UT in [0, 24) (eq 24), hours."""
    return trig.wrap(mean_longitude_deg + 180.0, 360.0) / 15.0


def local_sidereal_time(greenwich_h: T, hour: T, longitude_deg: float) -> T:
    """Return local sidereal time (eq 25), hours, not wrapped; longitude east positive."""
    return greenwich_h + hour + longitude_deg / 15.0


def hour_angle(sidereal_h: T, right_ascension_deg: T) -> T:
    """Return the hour angle (eq 26), degrees, west positive, not wrapped."""
    return sidereal_h * 15.0 - right_ascension_deg


def horizontal(angle_deg: T, declination_deg: T, latitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth in [0, 360] and elevation, degrees (eqs 27 to 34).

    The arcsine of eq 34 is taken as an arctangent, which stays exact at the zenith.
    """
    latitude = radians(latitude_deg)
    sin_lat, cos_lat = sin(latitude), cos(latitude)
    angle, declination = angle_deg * PER_DEGREE, declination_deg * PER_DEGREE
    cos_dec, z = trig.cos(declination), trig.sin(declination)
    x, y = trig.cos(angle) * cos_dec, trig.sin(angle) * cos_dec
    x_horizon = x * sin_lat - z * cos_lat
    z_horizon = x * cos_lat + z * sin_lat
    azimuth = trig.atan2(y, x_horizon) * PER_RADIAN + 180.0
    return azimuth, trig.atan2(z_horizon, trig.hypot(x_horizon, y)) * PER_RADIAN


def parallax(elevation_deg: T, distance_au: T, trig: Trigonometry[T]) -> T:
    """Return what the observer's place on the Earth's surface takes from an elevation, degrees.

    Not in the paper: its eq 20 stands in this place. 8.794 arc seconds is the sun's horizontal parallax.
    """
    return (8.794 / 3600.0) / distance_au * trig.cos(elevation_deg * PER_DEGREE)


def position(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return azimuth from north clockwise in [0, 360] and true elevation, degrees.

    Within 0.0124 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    azimuth_deg, elevation_deg, _ = _place(unix_s, latitude_deg, longitude_deg, trig)
    return azimuth_deg, elevation_deg


def position_with_parallax(
    unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]
) -> tuple[T, T]:
    """Return azimuth in [0, 360] and true elevation less the parallax, degrees.

    Within 0.0100 degrees of NREL SPA, 2000 to 2049. Latitude north, longitude east positive.
    """
    azimuth_deg, elevation_deg, distance_au = _place(unix_s, latitude_deg, longitude_deg, trig)
    return azimuth_deg, elevation_deg - parallax(elevation_deg, distance_au, trig)


def _place(unix_s: T, latitude_deg: float, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T, T]:
    """Return azimuth and elevation in degrees, and the distance in astronomical units."""
    day = day_number(unix_s)
    e, w, m = eccentricity(day), perihelion(day), mean_anomaly(day, trig)
    distance_au, true_anomaly = orbit(eccentric_anomaly(m, e, trig), e, trig)
    right_ascension, declination = equatorial(true_longitude(true_anomaly, w), obliquity(day), trig)
    greenwich = greenwich_sidereal_time(mean_longitude(w, m), trig)
    sidereal = local_sidereal_time(greenwich, hour_of_day(unix_s, trig), longitude_deg)
    azimuth, elevation = horizontal(hour_angle(sidereal, right_ascension), declination, latitude_deg, trig)
    return azimuth, elevation, distance_au
