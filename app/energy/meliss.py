"""Meliss's clear-sky beam, as C. Alexandru prints it (eq 8, doi:10.3390/math12071034).

M. Meliss, "Regenerative Energiequellen: Praktikum", Springer, 1997. There is no diffuse light in it.
"""

from collections.abc import Callable

import numpy as np

from app.energy.equatorial import extraterrestrial_wm2, sin_altitude
from app.sun.trigonometry import Array

TURBIDITY = 3.0
"""The turbidity factor at which the model gives the paper's fixed panel; the paper does not print one."""

Beam = Callable[[Array], Array]
"""Direct normal irradiance at solar hours: hours in, W/m2 out, arrays of one shape."""


def beam_wm2(sine_of_altitude: Array, day_of_year: int, turbidity: float = TURBIDITY) -> Array:
    """Return the direct normal irradiance, W/m2, 0 while the sun is down."""
    up = sine_of_altitude > 0.0
    depth = turbidity / (0.9 + 9.4 * np.where(up, sine_of_altitude, 1.0))
    return np.where(up, extraterrestrial_wm2(day_of_year) * np.exp(-depth), 0.0)


def beam_of_day(
    latitude_deg: float, sun_declination_deg: float, day_of_year: int, turbidity: float = TURBIDITY
) -> Beam:
    """Return the model for one day and latitude as a function of solar hours."""

    def beam(solar_h: Array) -> Array:
        return beam_wm2(sin_altitude(latitude_deg, sun_declination_deg, solar_h), day_of_year, turbidity)

    return beam
