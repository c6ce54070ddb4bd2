"""Where the axes of a recording stood: frames of most mounts tell directions of the sky."""

from app.sun.trigonometry import ARRAY, Array
from app.tracker.config import MountKind, Orientation, TrackerConfig
from app.tracker.memory import Pointing
from app.tracker.mount import sky, to_axes
from app.tracker.recording import Frames


def axis_angles(
    config: TrackerConfig, pointing: Pointing, frames: Frames, what: str = "measured"
) -> tuple[Array, Array]:
    """Return first and second axis angle of every frame, degrees, the first within one turn.

    `what` names the columns: `measured` or `setpoint`.
    """
    azimuth_deg, elevation_deg = frames.column(f"{what}_azimuth_deg"), frames.column(f"{what}_elevation_deg")
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return azimuth_deg, elevation_deg
    return to_axes(config.mount, pointing, azimuth_deg, elevation_deg, ARRAY)


def faced(config: TrackerConfig, pointing: Pointing, frames: Frames) -> list[Orientation]:
    """Return the direction of the sky that the panel faced in every frame."""
    azimuth_deg, elevation_deg = (
        frames.column(name).tolist() for name in ("measured_azimuth_deg", "measured_elevation_deg")
    )
    stood = zip(azimuth_deg, elevation_deg, strict=True)
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return [sky(config, pointing, *axes) for axes in stood]
    return [Orientation(*direction) for direction in stood]
