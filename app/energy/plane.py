"""From the light of the sky to what falls on a panel: arrays in, arrays out.

Azimuth from north clockwise; a panel's elevation is that of its normal, so that its tilt is 90 degrees less
it. Columns have equal lengths; irradiance is W/m2. Transposition as pvlib has it:

- isotropic: B. Liu and R. Jordan, Solar Energy 4 (1960) 1-19, doi:10.1016/0038-092X(60)90062-1;
- Hay and Davies: "Calculations of the solar radiation incident on an inclined surface", 1980;
- Perez: R. Perez et al., Solar Energy 44 (1990) 271-289, doi:10.1016/0038-092X(90)90055-H.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import assert_never

import numpy as np

from app.base.message import N_
from app.sun.trigonometry import PER_DEGREE, Array

LEAST_COS_ZENITH = 0.01745
LEAST_COS_PEREZ = float(np.cos(np.radians(85.0)))
KAPPA = 1.041
CLEARNESS_EDGES = (1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2)
PEREZ_1990 = np.array(
    [
        [-0.008, 0.588, -0.062, -0.060, 0.072, -0.022],
        [0.130, 0.683, -0.151, -0.019, 0.066, -0.029],
        [0.330, 0.487, -0.221, 0.055, -0.064, -0.026],
        [0.568, 0.187, -0.295, 0.109, -0.152, -0.014],
        [0.873, -0.392, -0.362, 0.226, -0.462, 0.001],
        [1.132, -1.237, -0.412, 0.288, -0.823, 0.056],
        [1.060, -1.600, -0.359, 0.264, -1.127, 0.131],
        [0.678, -0.327, -0.250, 0.156, -1.377, 0.251],
    ]
)
"""F11, F12, F13, F21, F22, F23 for the eight classes of clearness: all sites, 1990."""


class Transposition(StrEnum):
    """How the light of the sky is spread over it."""

    ISOTROPIC = "isotropic"
    HAY_DAVIES = "hay-davies"
    PEREZ = "perez"


@dataclass(frozen=True, slots=True)
class Light:
    """The sun's apparent place and what it gives, as columns of equal length; W/m2 and degrees.

    `direct_wm2` is on a plane that faces the sun, `diffuse_wm2` and `global_wm2` on a level one;
    `extraterrestrial_wm2` is that outside the air.
    """

    sun_azimuth_deg: Array
    sun_elevation_deg: Array
    direct_wm2: Array
    diffuse_wm2: Array
    global_wm2: Array
    extraterrestrial_wm2: Array


@dataclass(frozen=True, slots=True)
class Around:
    """The model of the sky and the share of light that the ground gives back."""

    transposition: Transposition = Transposition.HAY_DAVIES
    albedo: float = 0.2

    def __post_init__(self) -> None:
        if not 0.0 <= self.albedo <= 1.0:
            raise ValueError(N_("The albedo of the ground lies between 0 and 1."))


def plane_wm2(light: Light, panel_azimuth_deg: Array, panel_elevation_deg: Array, around: Around) -> Array:
    """Return what falls on the front of a panel: beam, sky and ground."""
    facing = cos_incidence(light, panel_azimuth_deg, panel_elevation_deg)
    cos_tilt = np.sin(panel_elevation_deg * PER_DEGREE)
    beam_wm2 = np.maximum(light.direct_wm2 * facing, 0.0)
    ground_wm2 = light.global_wm2 * around.albedo * (1.0 - cos_tilt) / 2.0
    return np.asarray(beam_wm2 + _sky_wm2(light, facing, cos_tilt, around.transposition) + ground_wm2)


def cos_incidence(light: Light, panel_azimuth_deg: Array, panel_elevation_deg: Array) -> Array:
    """Return the cosine of the angle between sun and normal; negative when the sun is behind the panel."""
    sun, panel = light.sun_elevation_deg * PER_DEGREE, panel_elevation_deg * PER_DEGREE
    turned = np.cos((light.sun_azimuth_deg - panel_azimuth_deg) * PER_DEGREE)
    level = np.cos(sun) * np.cos(panel) * turned
    return np.asarray(np.sin(sun) * np.sin(panel) + level, dtype=np.float64)


def relative_air_mass(elevation_deg: Array) -> Array:
    """Return the relative air mass at apparent elevations, 0 below the horizon.

    F. Kasten and A. Young, Applied Optics 28 (1989) 4735-4738, doi:10.1364/AO.28.004735.
    """
    up = elevation_deg >= 0.0
    above_deg = np.where(up, elevation_deg, 0.0)
    mass = 1.0 / (np.sin(above_deg * PER_DEGREE) + 0.50572 * (6.07995 + above_deg) ** -1.6364)
    return np.where(up, mass, 0.0)


def _sky_wm2(light: Light, facing: Array, cos_tilt: Array, model: Transposition) -> Array:
    dome = (1.0 + cos_tilt) / 2.0
    match model:
        case Transposition.ISOTROPIC:
            return light.diffuse_wm2 * dome
        case Transposition.HAY_DAVIES:
            return _hay_davies_wm2(light, facing, dome)
        case Transposition.PEREZ:
            return _perez_wm2(light, facing, cos_tilt)
    assert_never(model)


def _hay_davies_wm2(light: Light, facing: Array, dome: Array) -> Array:
    cos_zenith = np.sin(light.sun_elevation_deg * PER_DEGREE)
    anisotropy = light.direct_wm2 / light.extraterrestrial_wm2
    around_sun = anisotropy * np.maximum(facing, 0.0) / np.maximum(cos_zenith, LEAST_COS_ZENITH)
    return np.asarray(light.diffuse_wm2 * (around_sun + (1.0 - anisotropy) * dome), dtype=np.float64)


def _perez_wm2(light: Light, facing: Array, cos_tilt: Array) -> Array:
    """Return the light of a sky with a bright ring at the sun and a band at the horizon; 0 at night."""
    mass = relative_air_mass(light.sun_elevation_deg)
    lit = (mass > 0.0) & (light.diffuse_wm2 > 0.0)
    zenith = (90.0 - light.sun_elevation_deg) * PER_DEGREE
    brightness = light.diffuse_wm2 * mass / light.extraterrestrial_wm2
    cubed = KAPPA * zenith**3
    share = light.direct_wm2 / np.where(lit, light.diffuse_wm2, 1.0)
    clearness = (1.0 + share + cubed) / (1.0 + cubed)
    f = PEREZ_1990[np.digitize(clearness, CLEARNESS_EDGES)]
    ring = np.maximum(f[..., 0] + f[..., 1] * brightness + f[..., 2] * zenith, 0.0)
    band = f[..., 3] + f[..., 4] * brightness + f[..., 5] * zenith
    towards = np.maximum(facing, 0.0) / np.maximum(np.cos(zenith), LEAST_COS_PEREZ)
    sin_tilt = np.sqrt(np.maximum(1.0 - cos_tilt * cos_tilt, 0.0))
    dome = (1.0 - ring) * (1.0 + cos_tilt) / 2.0
    return np.where(lit, np.maximum(light.diffuse_wm2 * (dome + ring * towards + band * sin_tilt), 0.0), 0.0)
