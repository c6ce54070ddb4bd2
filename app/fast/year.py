"""What the four modes of an azimuth-elevation mount collect under a clear sky, minute by minute, in one pass.

Clear sky: P. Ineichen and R. Perez, Solar Energy 73 (2002) 151-157, doi:10.1016/S0038-092X(02)00045-2, as
pvlib has it, with a constant Linke turbidity; transposition: Hay and Davies (1980).
"""

from math import exp, pi
from typing import Final

import numpy as np

from app.fast.comparison import ClearSky
from app.fast.compiled import compiled, inlined
from app.fast.trigonometry import sine_cosine
from app.sun.position import SunPath
from app.sun.trigonometry import Array
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode

MODES: Final = (Mode.FIXED, Mode.AZIMUTH, Mode.ELEVATION, Mode.DUAL)
DEGREE = pi / 180.0
LEAST_COS_ZENITH = 0.01745
SEA_LEVEL_PA = 101_325.0


def collected_whm2(
    sun: SunPath, extraterrestrial_wm2: Array, step_s: float, held: Orientation, sky: ClearSky
) -> dict[Mode, float]:
    """Return what falls on a panel in each mode, Wh/m2 over instants that are `step_s` seconds apart.

    `held` is what the fixed panel faces, and the angle of the axis that does not follow. The extraterrestrial
    irradiance is W/m2 at each instant.
    """
    sums = np.zeros(len(MODES))
    place = (sky.altitude_m, _pressure_pa(sky.altitude_m), sky.linke_turbidity, sky.albedo)
    panel = (held.azimuth_deg * DEGREE, held.elevation_deg * DEGREE)
    _collect(sun.azimuth_deg, sun.apparent_elevation_deg, extraterrestrial_wm2, place, panel, sums)
    return dict(zip(MODES, (sums * step_s / 3600.0).tolist(), strict=True))


def _pressure_pa(altitude_m: float) -> float:
    """Return the standard atmosphere's pressure, as pvlib's `alt2pres`."""
    return 100.0 * float(((44331.514 - altitude_m) / 11880.516) ** (1.0 / 0.1902632))


@inlined
def _air_mass(elevation_deg: float, sin_elevation: float) -> float:
    """Return the relative air mass (Kasten and Young 1989)."""
    return 1.0 / (sin_elevation + 0.50572 * float((6.07995 + elevation_deg) ** -1.6364))


@inlined
def _plane(
    facing: float,
    sin_panel: float,
    direct: float,
    diffuse: float,
    whole: float,
    anisotropy: float,
    share: float,
) -> float:
    """Return beam, sky and ground on a plane, W/m2; `share` is what the sky around the sun counts more."""
    lit = max(facing, 0.0)
    dome = (1.0 - anisotropy) * 0.5 * (1.0 + sin_panel)
    return direct * lit + diffuse * (anisotropy * lit * share + dome) + whole * 0.5 * (1.0 - sin_panel)


@compiled
def _collect(
    azimuth_deg: Array,
    elevation_deg: Array,
    extraterrestrial_wm2: Array,
    place: tuple[float, float, float, float],
    panel: tuple[float, float],
    sums: Array,
) -> None:
    """Add up what falls on the panel in each mode over all instants with the sun up."""
    altitude_m, pressure_pa, turbidity, albedo = place
    fh1, fh2 = exp(-altitude_m / 8000.0), exp(-altitude_m / 1250.0)
    cg1, cg2 = 5.09e-5 * altitude_m + 0.868, 3.92e-5 * altitude_m + 0.0387
    ceiling = 1.0 - (0.1 - 0.2 * exp(-turbidity)) / (0.1 + 0.882 / fh1)
    sin_held, cos_held = sine_cosine(panel[1])
    for i in range(azimuth_deg.size):
        if elevation_deg[i] <= 0.0:
            continue
        up, level = sine_cosine(elevation_deg[i] * DEGREE)
        mass = _air_mass(elevation_deg[i], up) * pressure_pa / SEA_LEVEL_PA
        outside = extraterrestrial_wm2[i]
        whole = cg1 * outside * up * exp(-cg2 * mass * (fh1 + fh2 * (turbidity - 1.0)))
        beam = outside * (0.664 + 0.163 / fh1) * exp(-0.09 * mass * (turbidity - 1.0))
        direct = min(beam, max(whole * ceiling / up, 0.0))
        diffuse = whole - direct * up
        ground = whole * albedo
        anisotropy, share = direct / outside, 1.0 / max(up, LEAST_COS_ZENITH)
        _, towards = sine_cosine(azimuth_deg[i] * DEGREE - panel[0])
        fixed = up * sin_held + level * cos_held * towards
        turned = up * sin_held + level * cos_held
        lifted = up * up + level * level * towards
        sums[0] += _plane(fixed, sin_held, direct, diffuse, ground, anisotropy, share)
        sums[1] += _plane(turned, sin_held, direct, diffuse, ground, anisotropy, share)
        sums[2] += _plane(lifted, up, direct, diffuse, ground, anisotropy, share)
        sums[3] += _plane(1.0, up, direct, diffuse, ground, anisotropy, share)
