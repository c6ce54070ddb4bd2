"""Recordings: frames as columns, one row a tick, the same for shows, days and simulations."""

from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from app.base.message import say
from app.sun.horizon import FLAT, Horizon
from app.sun.position import Location
from app.tracker.settings.config import MountConfig
from app.tracker.values.mode import Mode

COLUMNS = (
    "elapsed_s",
    "sun_time_s",
    "sun_azimuth_deg",
    "sun_elevation_deg",
    "target_azimuth_deg",
    "target_elevation_deg",
    "setpoint_azimuth_deg",
    "setpoint_elevation_deg",
    "measured_azimuth_deg",
    "measured_elevation_deg",
    "correction_azimuth_deg",
    "correction_elevation_deg",
    "azimuth_dps",
    "elevation_dps",
    "supply_v",
    "wind_mps",
    "wind_mean_mps",
    "irradiance_wm2",
    "activity",
)
"""`elapsed_s`: seconds since the recording began, of the machine. `sun_time_s`: seconds of sun time since
`RecordingInfo.sun_start`. `sun_elevation_deg` is apparent (refracted) if the tracker refracts. Angles are
of the sky except that setpoints and measurements of an azimuth-elevation mount are axis angles (azimuth
wrapped to [0, 360)), and that corrections are what light sensors add to the computed axis angles. Speeds and
supply voltage are what the drive tells; wind is the gust, with its mean beside it, and light what the site's
station tells, while they may be relied on. What was not known is NaN. `activity` is the index in
`list(ActivityName)`."""


class RecordingKind(StrEnum):
    """Why it was recorded."""

    SHOW = "show"
    DAY = "day"
    SIMULATION = "simulation"


@dataclass(frozen=True, slots=True)
class RecordingInfo:
    """The head of a recording. `ended_at` is None while it runs; `outcome` says how it ended.

    `first_deg` and `second_deg` are the soft limits that the axes had then; None: not known, or no such axis.
    `horizon` is what was entered for the site then.
    """

    recording_id: str
    kind: RecordingKind
    tracker_id: str
    tracker_name: str
    title: str
    began_at: datetime
    sun_start: datetime
    sun_end: datetime
    duration_s: float
    location: Location
    time_zone: str
    mode: Mode
    held_azimuth_deg: float
    held_elevation_deg: float
    algorithm: str
    drive: str
    ended_at: datetime | None = None
    outcome: str = ""
    sample_count: int = 0
    mount: MountConfig = field(default_factory=MountConfig)
    first_deg: tuple[float, float] | None = None
    second_deg: tuple[float, float] | None = None
    horizon: Horizon = FLAT


@dataclass(frozen=True, slots=True)
class Frames:
    """Columns of equal length, named and ordered as `COLUMNS`: float64 array of shape (rows, columns)."""

    values: NDArray[np.float64]

    def __post_init__(self) -> None:
        if self.values.ndim != 2 or self.values.shape[1] != len(COLUMNS):
            raise ValueError(
                say(
                    "Samples have {columns} columns, not shape {shape}.",
                    columns=len(COLUMNS),
                    shape=self.values.shape,
                )
            )

    def __len__(self) -> int:
        return len(self.values)

    def column(self, name: str) -> NDArray[np.float64]:
        """Return one column by its name."""
        return self.values[:, COLUMNS.index(name)]
