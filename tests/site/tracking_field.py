"""Plants on a virtual clock whose trackers are homed from the beginning, and track if that is wanted."""

from dataclasses import dataclass
from datetime import timedelta
from typing import Any

from app.simulation.position_memory import AxisMemory, PositionMemory
from app.site.recording.gathering import BackgroundWriter
from app.site.site import SiteOptions
from app.tracker.memory.memory import (
    ClockSetting,
    Confirmation,
    HomeTrust,
    SiteState,
    StepName,
    TrackerMemory,
    TrackerState,
)
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from tests.site.plant import SAMSUN, SUMMER_NOON, Plant, make_plant

TEN_HZ = timedelta(milliseconds=100)
ONE_HZ = timedelta(seconds=1)
STEPS = (StepName.HOMING, StepName.MODE, StepName.RUN)


@dataclass
class Stands:
    """What every drive knows at its start: it is homed, and where it is."""

    azimuth_deg: float = 0.0
    elevation_deg: float = 0.0
    own_power = True

    def recall(self) -> PositionMemory | None:
        azimuth, elevation = (
            AxisMemory(degrees, 0.0, homed=True) for degrees in (self.azimuth_deg, self.elevation_deg)
        )
        return PositionMemory(azimuth, elevation, boot_count=1, trusted=True)

    def keep(self, memory: PositionMemory) -> None:
        """Keep nothing."""


SAID = Confirmation(SUMMER_NOON, "technician", 1)
NEAR_THE_SUN = Stands(182.0, 72.0)
PLACED = SiteState(
    location=SAMSUN,
    location_revision=1,
    time_zone="Europe/Istanbul",
    clock=ClockSetting("system", 0.0, SUMMER_NOON, "technician"),
    confirmations={StepName.LOCATION: SAID, StepName.CLOCK: SAID},
)


def homed(count: int = 1, *, tracks: bool = False, **given: Any) -> Plant:
    """Return trackers that are homed; those that track do so from the beginning, and stand near the sun."""
    memory = TrackerMemory(
        mode=Mode.DUAL if tracks else None,
        tracking_on=tracks,
        home=HomeTrust(SUMMER_NOON, "technician", "set manually", boot_count=1),
        confirmations=dict.fromkeys(STEPS if tracks else STEPS[:1], SAID),
    )
    trackers = tuple(
        TrackerState(TrackerConfig(f"T{number}", f"Tracker {number}"), memory)
        for number in range(1, count + 1)
    )
    return make_plant(
        **{"memory": NEAR_THE_SUN if tracks else Stands(), "state": PLACED, "trackers": trackers} | given
    )


async def field_of(
    count: int, *, writer: BackgroundWriter | None = None, period: timedelta = TEN_HZ
) -> Plant:
    """Return trackers that track."""
    plant = homed(count, tracks=True, writer=writer, options=SiteOptions(period=period))
    await plant.start()
    await plant.forward(seconds=2.0)
    assert activities(plant) == {ActivityName.TRACKING}
    return plant


def activities(plant: Plant) -> set[ActivityName]:
    return {loop.controller.activity for loop in plant.site.model.loops.values()}
