"""Where the axes of a recording stood: frames of most mounts tell directions of the sky."""

from app.sun.trigonometry import ARRAY, Array
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import Frames
from app.tracker.mounts.mount import sky, to_axes
from app.tracker.settings.config import MountKind, Orientation, TrackerConfig
from app.tracker.settings.strategy import CLEAR


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
    """Return the direction of the sky that the panel really faced in every frame of a simulation.

    Where light sensors correct, that is what they see: the axis angles less the misalignment that is played.
    """
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION or config.hybrid.enabled:
        played = config.hybrid.simulated if config.hybrid.enabled else CLEAR
        first_deg, second_deg = axis_angles(config, pointing, frames)
        first_deg, second_deg = first_deg - played.azimuth_deg, second_deg - played.elevation_deg
        stood = zip(first_deg.tolist(), second_deg.tolist(), strict=True)
        return [sky(config, pointing, *axes) for axes in stood]
    columns = (frames.column(f"measured_{name}_deg").tolist() for name in ("azimuth", "elevation"))
    return [Orientation(*direction) for direction in zip(*columns, strict=True)]
