"""Linear actuators by name: the two of Alexandru's equatorial tracker, from the points that the paper gives.

C. Alexandru, Mathematics 2024, 12, 1034, doi:10.3390/math12071034, latitude 45.65 degrees. Its frame has x to
the back (north), z upwards and so y to the west. The paper does not give the axes' places. The diurnal axis
rises to the back in the plane y = 0; that the actuator is 950 mm long in the evening leaves one place for it,
511.282 mm above the origin, at which it turns the right way and stays within its transmission angles. The
hinge of the elevation lies where both its lengths, 550 and 750 mm, are met. The speed is ours: the paper has
none.
"""

from math import cos, radians, sin

from app.tracker.settings.transmission import LinearActuator, Point

Vector = tuple[float, float, float]

LATITUDE_DEG = 45.65
AXIS_OFFSET_MM = 511.282
HINGE: Vector = (-36.26, 0.0, 694.31)
POINT_A: Vector = (484.10, 348.78, 195.34)
POINT_B: Vector = (99.67, -1.41, 585.35)
POINT_D: Vector = (449.47, 0.0, 598.22)
POINT_E: Vector = (85.83, 0.0, 1010.88)
MORNING_DEG = -60.0
SUMMER_TILT_DEG = 22.05
SPEED_MM_S = 10.0
WEST: Vector = (0.0, 1.0, 0.0)
UP: Vector = (0.0, 0.0, 1.0)
NORTH: Vector = (1.0, 0.0, 0.0)


def alexandru_diurnal() -> LinearActuator:
    """Return the actuator of the hour angle (west positive): out by 300 mm from morning to evening."""
    latitude = radians(LATITUDE_DEG)
    upward = (-sin(latitude), 0.0, cos(latitude))
    to_south_pole = (-cos(latitude), 0.0, -sin(latitude))
    origin = _scaled(upward, AXIS_OFFSET_MM)
    return LinearActuator(
        base=_seen(POINT_A, origin, upward, WEST, to_south_pole),
        joint=_seen(POINT_B, origin, upward, WEST, to_south_pole),
        at_deg=MORNING_DEG,
        retracted_mm=650.0,
        travel_mm=300.0,
        speed_mm_s=SPEED_MM_S,
    )


def alexandru_elevation() -> LinearActuator:
    """Return the actuator of the declination (latitude less tilt): out by 200 mm from summer to winter."""
    return LinearActuator(
        base=_seen(POINT_D, HINGE, UP, NORTH, WEST),
        joint=_seen(POINT_E, HINGE, UP, NORTH, WEST),
        at_deg=LATITUDE_DEG - SUMMER_TILT_DEG,
        retracted_mm=550.0,
        travel_mm=200.0,
        speed_mm_s=SPEED_MM_S,
    )


MECHANISMS = {"alexandru-diurnal": alexandru_diurnal, "alexandru-elevation": alexandru_elevation}
"""Named examples, for pages and the API."""


def _seen(point: Vector, origin: Vector, x: Vector, y: Vector, z: Vector) -> Point:
    away = (point[0] - origin[0], point[1] - origin[1], point[2] - origin[2])
    return Point(_dot(away, x), _dot(away, y), _dot(away, z))


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _scaled(vector: Vector, factor: float) -> Vector:
    return vector[0] * factor, vector[1] * factor, vector[2] * factor
