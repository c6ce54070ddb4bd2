"""A field on a virtual clock whose trackers are homed and track."""

from datetime import timedelta

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


class Stands:
    """What every drive knows at its start: it is homed, and near the sun."""

    own_power = True

    def recall(self) -> PositionMemory | None:
        azimuth, elevation = AxisMemory(170.0, 0.0, homed=True), AxisMemory(70.0, 0.0, homed=True)
        return PositionMemory(azimuth, elevation, boot_count=1, trusted=True)

    def keep(self, memory: PositionMemory) -> None:
        """Keep nothing."""


def tracking(number: int) -> TrackerState:
    said = Confirmation(SUMMER_NOON, "technician", 1)
    return TrackerState(
        TrackerConfig(f"T{number}", f"Tracker {number}"),
        TrackerMemory(
            mode=Mode.DUAL,
            tracking_on=True,
            home=HomeTrust(SUMMER_NOON, "technician", "set manually", boot_count=1),
            confirmations={StepName.HOMING: said, StepName.MODE: said, StepName.RUN: said},
        ),
    )


async def field_of(
    count: int, *, writer: BackgroundWriter | None = None, period: timedelta = TEN_HZ
) -> Plant:
    """Return trackers that track."""
    said = Confirmation(SUMMER_NOON, "technician", 1)
    state = SiteState(
        location=SAMSUN,
        location_revision=1,
        clock=ClockSetting("system", 0.0, SUMMER_NOON, "technician"),
        confirmations={StepName.LOCATION: said, StepName.CLOCK: said},
    )
    states = tuple(tracking(number) for number in range(1, count + 1))
    plant = make_plant(
        trackers=states, state=state, memory=Stands(), writer=writer, options=SiteOptions(period=period)
    )
    await plant.start()
    await plant.forward(seconds=2.0)
    assert activities(plant) == {ActivityName.TRACKING}
    return plant


def activities(plant: Plant) -> set[ActivityName]:
    return {loop.controller.activity for loop in plant.site.model.loops.values()}
