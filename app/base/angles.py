"""Angles in degrees: wrapping, and the distance between two directions of the sky."""

from math import asin, cos, degrees, radians, sin, sqrt


def wrap360(angle_deg: float) -> float:
    """Return the angle in [0, 360)."""
    wrapped = angle_deg % 360.0
    return 0.0 if wrapped >= 360.0 else wrapped


def wrap180(angle_deg: float) -> float:
    """Return the angle in [-180, 180)."""
    return wrap360(angle_deg + 180.0) - 180.0


def separation_deg(
    azimuth_a_deg: float, elevation_a_deg: float, azimuth_b_deg: float, elevation_b_deg: float
) -> float:
    """Return the great-circle angle between two directions, in [0, 180] degrees (haversine form)."""
    a, b = radians(elevation_a_deg), radians(elevation_b_deg)
    half_azimuth = radians(azimuth_a_deg - azimuth_b_deg) / 2
    haversine = sin((a - b) / 2) ** 2 + cos(a) * cos(b) * sin(half_azimuth) ** 2
    return 2.0 * degrees(asin(min(1.0, sqrt(max(0.0, haversine)))))
