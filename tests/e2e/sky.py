"""The sky by NREL's SPA, as pvlib computes it, and the distance between two directions of it."""

from typing import Any

import numpy as np
import pandas as pd
import pvlib
from numpy.typing import NDArray

Column = NDArray[np.float64]


def spa_deg(
    unix_s: Column, latitude_deg: float, longitude_deg: float, altitude_m: float
) -> tuple[Column, Column]:
    """Return azimuth and true elevation."""
    at = pd.to_datetime(unix_s, unit="s", utc=True)
    found = pvlib.solarposition.get_solarposition(
        at, latitude_deg, longitude_deg, altitude=altitude_m, method="nrel_numpy"
    )
    return found["azimuth"].to_numpy(), found["elevation"].to_numpy()


def separation_deg(azimuth_a: Column, elevation_a: Column, azimuth_b: Column, elevation_b: Column) -> Column:
    """Return the angle between directions of the sky."""
    a, b = np.radians(elevation_a), np.radians(elevation_b)
    half = np.radians(azimuth_a - azimuth_b) / 2
    haversine = np.sin((a - b) / 2) ** 2 + np.cos(a) * np.cos(b) * np.sin(half) ** 2
    found: Column = 2 * np.degrees(np.arcsin(np.sqrt(np.clip(haversine, 0.0, 1.0))))
    return found


def columns(frames: dict[str, Any]) -> dict[str, Column]:
    """Return the frames of an API answer as arrays; what was not known is NaN."""
    return {name: np.array(values, dtype=np.float64) for name, values in frames["columns"].items()}


def off_spa_deg(info: dict[str, Any], frames: dict[str, Column]) -> Column:
    """Return how far the recorded sun lies from SPA, frame by frame."""
    begin_s = pd.Timestamp(info["sun_start"]).timestamp()
    place = info["location"]
    azimuth, elevation = spa_deg(
        begin_s + frames["sun_time_s"],
        place["latitude_deg"],
        place["longitude_deg"],
        place["altitude_m"],
    )
    return separation_deg(frames["sun_azimuth_deg"], frames["sun_elevation_deg"], azimuth, elevation)


def off_sun_deg(frames: dict[str, Column]) -> Column:
    """Return how far the panel pointed from the recorded sun, frame by frame."""
    return separation_deg(
        frames["measured_azimuth_deg"],
        frames["measured_elevation_deg"],
        frames["sun_azimuth_deg"],
        frames["sun_elevation_deg"],
    )
