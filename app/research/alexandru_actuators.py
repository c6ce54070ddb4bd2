"""Alexandru's two linear actuators: their lengths at the ends of travel, from the points that he prints."""

from app.research import alexandru_published as published
from app.research.result import Basis, Figure, Group
from app.tracker.settings.mechanisms import LATITUDE_DEG, alexandru_diurnal, alexandru_elevation
from app.tracker.settings.transmission import LinearActuator

MORNING_DEG, EVENING_DEG = -60.0, 60.0
WITHIN_MM = 0.05
SOLSTICE_DEG = 23.45


def actuators() -> tuple[Group, Group]:
    """Return both actuators: lengths, strokes and transmission angles."""
    return _diurnal(), _elevation()


def solstice_stroke_mm() -> float:
    """Return how far the elevation actuator is out on 21 June, which the paper puts at zero."""
    return _out_mm(SOLSTICE_DEG) - _out_mm(LATITUDE_DEG - published.ELEVATION_TILTS_DEG[0])


def beyond_stroke_mm() -> float:
    """Return how much longer than it can be the elevation actuator must be on 21 December."""
    return _out_mm(-SOLSTICE_DEG) - published.ELEVATION_MM[1]


def _out_mm(sun_declination_deg: float) -> float:
    return alexandru_elevation().length_mm(sun_declination_deg)


def _diurnal() -> Group:
    actuator = alexandru_diurnal()
    return Group(
        "Section 2, the diurnal actuator",
        "From the printed points A and B; the axis is placed so that both lengths come out, which one place "
        "does that turns the right way.",
        (
            *_lengths(actuator, (MORNING_DEG, EVENING_DEG), published.DIURNAL_MM, ("60° east", "60° west")),
            *_transmission(actuator, MORNING_DEG, EVENING_DEG),
        ),
    )


def _elevation() -> Group:
    actuator = alexandru_elevation()
    summer_deg, winter_deg = (LATITUDE_DEG - tilt_deg for tilt_deg in published.ELEVATION_TILTS_DEG)
    return Group(
        "Section 2, the elevation actuator",
        "From the printed points D and E; the hinge is placed so that both lengths come out.",
        (
            *_lengths(
                actuator, (summer_deg, winter_deg), published.ELEVATION_MM, ("tilt 22.05°", "tilt 68.95°")
            ),
            Figure(
                "stroke at tilt 22.20°", "mm", published.SOLSTICE_STROKE_MM, solstice_stroke_mm(), WITHIN_MM,
                remark="The zero is at 22.05°.",
            ),
            *_transmission(actuator, winter_deg, summer_deg),
        ),
    )  # fmt: skip


def _lengths(
    actuator: LinearActuator,
    at_deg: tuple[float, float],
    told_mm: tuple[float, float],
    names: tuple[str, str],
) -> tuple[Figure, ...]:
    return tuple(
        Figure(
            f"length at {name}", "mm", told, actuator.length_mm(angle_deg), WITHIN_MM, 3, basis=Basis.FITTED
        )
        for name, told, angle_deg in zip(names, told_mm, at_deg, strict=True)
    )


def _transmission(actuator: LinearActuator, low_deg: float, high_deg: float) -> tuple[Figure, ...]:
    """Return the transmission angles at both ends, which the paper holds between 10 and 170 degrees."""
    ends_deg = actuator.transmission_deg(low_deg), actuator.transmission_deg(high_deg)
    return (
        Figure("least transmission angle, at least 10°", "°", None, min(ends_deg), digits=1),
        Figure("greatest transmission angle, at most 170°", "°", None, max(ends_deg), digits=1),
    )
