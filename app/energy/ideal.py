"""What a panel collects that stands where its mode wants it at every instant: the pass of a whole year.

`ideal_wm2` goes from the sun to the plane of the panel in one go, arrays in and arrays out, with no state.
"""

from dataclasses import dataclass

import numpy as np

from app.energy.plane import Around, Light, plane_wm2
from app.sun.trigonometry import ARRAY, Array
from app.tracker.mounts.kinematics import direction, followed
from app.tracker.settings.config import MountConfig, Orientation
from app.tracker.values.mode import Mode


@dataclass(frozen=True, slots=True)
class Follower:
    """What is mounted how, and what it follows; a first axis turns no further than +-`range_deg`."""

    mount: MountConfig
    mode: Mode
    held: Orientation
    range_deg: float | None = None


@dataclass(frozen=True, slots=True)
class AxisPath:
    """Axis angles as columns, degrees: first and second axis, as `mounts.kinematics` has them."""

    first_deg: Array
    second_deg: Array


def ideal_axes(light: Light, follower: Follower) -> AxisPath:
    """Return the axis angles that the mode wants at every instant."""
    held = (follower.held.azimuth_deg, follower.held.elevation_deg)
    sun = (light.sun_azimuth_deg, light.sun_elevation_deg)
    first_deg, second_deg = followed(follower.mount, follower.mode, held, sun, ARRAY)
    if follower.range_deg is not None:
        first_deg = np.clip(first_deg, -follower.range_deg, follower.range_deg)
    return AxisPath(first_deg, second_deg)


def faced(mount: MountConfig, axes: AxisPath) -> tuple[Array, Array]:
    """Return the directions of the sky, azimuth and elevation in degrees, that a panel faces."""
    return direction(mount, axes.first_deg, axes.second_deg, ARRAY)


def collected_wm2(light: Light, mount: MountConfig, axes: AxisPath, around: Around) -> Array:
    """Return what falls on the panel at these axis angles, W/m2."""
    return plane_wm2(light, *faced(mount, axes), around)


def ideal_wm2(light: Light, follower: Follower, around: Around) -> Array:
    """Return what falls on a panel that follows ideally, W/m2: sun, direction, incidence, plane."""
    return collected_wm2(light, follower.mount, ideal_axes(light, follower), around)
