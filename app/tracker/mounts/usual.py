"""What a mount usually looks like: where its axis lies at a place and how far its axes turn."""

from dataclasses import replace

from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, TrackerConfig

USUAL_TILT_DEG = 25.0
RANGES: dict[MountKind, tuple[tuple[float, float], tuple[float, float]]] = {
    MountKind.AZIMUTH_ELEVATION: ((0.0, 360.0), (0.0, 90.0)),
    MountKind.EQUATORIAL: ((-105.0, 105.0), (-24.0, 24.0)),
    MountKind.HORIZONTAL_SINGLE_AXIS: ((-60.0, 60.0), (0.0, 90.0)),
    MountKind.TILTED_SINGLE_AXIS: ((-60.0, 60.0), (0.0, 90.0)),
    MountKind.VERTICAL_SINGLE_AXIS: ((-130.0, 130.0), (0.0, 90.0)),
}
"""Soft limits of first and second axis, degrees; of a second axis that is not there they do not count."""


def mounted(config: TrackerConfig, kind: MountKind, latitude_deg: float | None) -> TrackerConfig:
    """Return the configuration on another kind of mount: its usual axis and limits, no rows, no actuators.

    The axis of an equatorial mount dips by the latitude, 0 while that is not known; speeds stay. The azimuth
    axis of an azimuth-elevation mount turns over the south on the southern half of the globe, so that its
    ends lie where the sun is not at noon.
    """
    southern = latitude_deg is not None and latitude_deg < 0.0
    first, second = RANGES[kind]
    if kind is MountKind.AZIMUTH_ELEVATION and southern:
        first = (-180.0, 180.0)
    mount = MountConfig(kind, 0.0 if southern else 180.0, _tilt_deg(kind, latitude_deg))
    return replace(
        config,
        azimuth=_turning(config.azimuth, first),
        elevation=_turning(config.elevation, second),
        mount=mount,
    )


def _tilt_deg(kind: MountKind, latitude_deg: float | None) -> float:
    match kind:
        case MountKind.EQUATORIAL:
            return abs(latitude_deg or 0.0)
        case MountKind.TILTED_SINGLE_AXIS:
            return USUAL_TILT_DEG
        case _:
            return 0.0


def _turning(axis: AxisConfig, ends_deg: tuple[float, float]) -> AxisConfig:
    return replace(axis, minimum_deg=ends_deg[0], maximum_deg=ends_deg[1], actuator=None)
