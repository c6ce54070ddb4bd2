"""Turning rows of panels back from the sun just so far that none shades the next.

K. Anderson and M. Mikofski, "Slope-Aware Backtracking for Single-Axis Trackers", NREL/TP-5K00-76626, 2020,
doi:10.2172/1660126, as pvlib's `tracking.singleaxis` has it.
"""

from math import cos, radians

from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, T, Trigonometry
from app.tracker.settings.config import Rows

SMALLEST = 1e-300


def backtracked_deg(rows: Rows, rotation_deg: T, trig: Trigonometry[T]) -> T:
    """Return the rotation, degrees, at which rows just do not shade each other; unchanged where they do not.

    `rotation_deg` is the one that faces the sun, without limits.
    """
    slope_deg = rows.cross_axis_tilt_deg
    distance = 1.0 / (rows.ground_coverage_ratio * cos(radians(slope_deg)))
    gap = abs(distance * trig.cos((rotation_deg - slope_deg) * PER_DEGREE))
    shaded = (1.0 - gap) * (1.0 + gap)
    back = trig.atan2(trig.sqrt((shaded + abs(shaded)) / 2.0), gap)  # (14); zero where the gap is above 1
    side = rotation_deg / (abs(rotation_deg) + SMALLEST)
    return rotation_deg - side * back * PER_RADIAN
