"""What a show is made of: the plan, its path, and whether a tracker can do it."""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from app.sun.position import Algorithm, Location
from app.tracker.settings.config import Orientation
from app.tracker.settings.strategy import Schedule
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason


@dataclass(frozen=True, slots=True)
class ShowPlan:
    """Sun time from `begin_at` to `end_at`, played in `duration` of the drive's time. Complete in itself.

    With a `schedule` the panel stands still between its moves; without one it follows the sun smoothly.
    """

    show_id: str
    begin_at: datetime
    end_at: datetime
    duration: timedelta
    location: Location
    mode: Mode = Mode.DUAL
    orientation: Orientation = Orientation(0.0, 0.0)
    algorithm: Algorithm = Algorithm.PSA
    refraction: bool = True
    schedule: Schedule | None = None

    @property
    def span(self) -> timedelta:
        """Return how much sun time is played, also where clocks are set forward or back in between."""
        return self.end_at.astimezone(UTC) - self.begin_at.astimezone(UTC)

    @property
    def acceleration(self) -> float:
        """Return how many seconds of sun time pass in one second."""
        return self.span / self.duration

    def sun_time(self, elapsed: timedelta) -> datetime:
        """Return the sun's clock after so much of the show has run."""
        return min(self.end_at, self.begin_at.astimezone(UTC) + elapsed * self.acceleration)


@dataclass(frozen=True, slots=True)
class ShowPath:
    """The planned path as columns of equal length: sun time, sun and panel, sun up or not.

    The panel is in axis degrees on an azimuth-elevation mount, on others in degrees of the sky.
    """

    sun_time_unix_s: NDArray[np.float64]
    sun_azimuth_deg: NDArray[np.float64]
    sun_elevation_deg: NDArray[np.float64]
    panel_azimuth_deg: NDArray[np.float64]
    panel_elevation_deg: NDArray[np.float64]
    sun_is_up: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class ShowCheck:
    """What a plan needs and whether this tracker can do it.

    `reasons` forbid the show, `notices` are worth knowing. `shortest` is the least duration that works for
    this interval, rounded up to whole seconds (None if no duration works). Peak speeds are what the plan
    asks of each axis. `start` is where the panel stands at the start, axis degrees.
    """

    reasons: tuple[Reason, ...]
    notices: tuple[Reason, ...]
    shortest: timedelta | None
    sun_up: tuple[tuple[datetime, datetime], ...]
    peak_azimuth_dps: float
    peak_elevation_dps: float
    start: Orientation
    path: ShowPath

    @property
    def feasible(self) -> bool:
        """Return whether nothing forbids the show."""
        return not self.reasons
