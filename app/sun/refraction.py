"""How much the air lifts the sun, at 1010 hPa and 10 degrees Celsius.

R = 1.02 / (60 tan(h + 10.3/(h + 5.11))) degrees, Saemundsson (1986) as NREL SPA uses it. It holds while
the sun's upper limb is above the horizon (-0.8333 degrees, where SPA stops too). Below, it fades to zero
over half a degree instead of stopping at once, so that the apparent elevation stays continuous at dusk.
"""

import math

import numpy as np

from app.sun.trigonometry import PER_DEGREE, Array

LOWEST_DEG = -0.8333
FADE_DEG = 0.5


def refraction_deg(elevation_deg: float) -> float:
    """Return what refraction adds to a true elevation, degrees; zero below -1.3333."""
    if elevation_deg >= LOWEST_DEG:
        return 0.017 / math.tan((elevation_deg + 10.3 / (elevation_deg + 5.11)) * PER_DEGREE)
    fade = 1.0 - (LOWEST_DEG - elevation_deg) / FADE_DEG
    return fade * refraction_deg(LOWEST_DEG) if fade > 0.0 else 0.0


def refraction_path(elevation_deg: Array) -> Array:
    """Return what refraction adds to each true elevation, degrees; the same as `refraction_deg`."""
    lifted = np.maximum(elevation_deg, LOWEST_DEG)
    refraction = 0.017 / np.tan((lifted + 10.3 / (lifted + 5.11)) * PER_DEGREE)
    fade = np.clip(1.0 - (LOWEST_DEG - elevation_deg) / FADE_DEG, 0.0, 1.0)
    return np.asarray(refraction * fade, dtype=np.float64)
