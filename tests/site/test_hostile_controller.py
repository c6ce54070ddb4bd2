"""Another tracker controller whose points say what they cannot mean: a reading that failed, and no more."""

from dataclasses import replace
from datetime import UTC, datetime

import pytest

from app.base.clock import VirtualClock
from app.modbus.errors import DriveError
from app.simulation.devices.sunspec import (
    ALARMS,
    AZIMUTH_POSITION,
    COMMON,
    CONTROL,
    CONTROLLER,
    ELEVATION_POSITION,
    SCALE,
    STEP_POWER,
    TRACKER_ALARMS,
)
from app.tracker.commands.commands import Move, Stop
from app.tracker.settings.axes import AZIMUTH_DEFAULT
from app.tracker.settings.config import Orientation, TrackerConfig
from tests.amount import amount
from tests.golden.table import rows
from tests.site.far_controllers import FarPlant, far_drive, far_plant
from tests.site.plant import SAMSUN, SUMMER_NOON
from tests.site.test_azimuth_comes_round import commissioned

ROWS = rows("world/far_trackers.csv")
EVERY = pytest.mark.parametrize("row", ROWS, ids=[row["what"] for row in ROWS])
WORDS = {"scale": SCALE, "alarms": ALARMS, "control": CONTROL, "tracker_alarms": TRACKER_ALARMS}
WIDE_WORDS = {"azimuth": AZIMUTH_POSITION, "elevation": ELEVATION_POSITION}
SENTINELS = (0, 1, 0x7FFF, 0x8000, 0x8001, 0xFFFE, 0xFFFF)
AXIS = replace(AZIMUTH_DEFAULT, minimum_deg=-170.0, maximum_deg=190.0)
CONFIG = TrackerConfig("T1", "Tracker 1", azimuth=AXIS, park=Orientation(0.0, 90.0))


def spoiled(row: dict[str, str]) -> dict[int, int]:
    """Return the words of a row by their addresses."""
    words = {address: int(row[name]) & 0xFFFF for name, address in WORDS.items()}
    for name, address in WIDE_WORDS.items():
        value = int(row[name])
        words |= {address: value >> 16 & 0xFFFF, address + 1: value & 0xFFFF}
    return words


@EVERY
async def test_a_reading_is_right_or_says_what_is_wrong(row: dict[str, str]) -> None:
    clock = VirtualClock(datetime(2027, 6, 21, tzinfo=UTC))
    drive, controller = far_drive(CONFIG, clock, "-180 to 180")
    controller.spoiled = spoiled(row)
    if row["says"]:
        with pytest.raises(DriveError, match=row["says"]):
            await drive.read()
    else:
        seen = await drive.read()
        assert seen.azimuth.position_deg == pytest.approx(float(row["azimuth_deg"]), abs=1e-3)
        assert seen.elevation.position_deg == pytest.approx(float(row["elevation_deg"]), abs=1e-3)
        assert seen.fault_code == int(row["fault_code"])
        if int(row["scale"]) == STEP_POWER:
            await drive.stop()
    controller.spoiled = {}
    assert (await drive.read()).is_possible
    await drive.close()


@pytest.mark.parametrize("row", ROWS[:: amount(3, 1)], ids=[row["what"] for row in ROWS[:: amount(3, 1)]])
async def test_a_controller_that_says_it_in_motion_can_be_stopped(row: dict[str, str]) -> None:
    plant = far_plant(CONFIG, SUMMER_NOON, "-180 to 180")
    await plant.start()
    await commissioned(plant, SAMSUN)
    await plant.ask(Move(Orientation(150.0, 60.0)))
    await plant.forward(seconds=3)
    plant.far.spoiled = spoiled(row)
    await lived_through(plant, row["says"])
    await plant.close()


async def lived_through(plant: FarPlant, says: str) -> None:
    """See that the loop lives, tells what is wrong and takes a stop, and that it ends with its cause."""
    await plant.forward(seconds=1.2)
    loop = plant.site.model.tracker("T1")
    assert plant.site.alive
    assert loop.broken is None
    if says:
        assert loop.trouble is not None
        assert says in loop.trouble.message or "did not carry it out (control" in loop.trouble.message
    await plant.ask(Stop())
    await plant.forward(seconds=0.5)
    plant.far.spoiled = {}
    await plant.forward(seconds=3)
    assert loop.broken is None
    assert loop.trouble is None
    assert loop.feedback is not None
    assert await loop.stop_drive()
    await plant.ask(Stop())
    await plant.forward(seconds=3)
    assert not plant.far.machine.observe().azimuth.moving


HEADS = {
    "mark": COMMON - 2, "mark, second": COMMON - 1, "first model": COMMON, "its length": COMMON + 1,
    "model": CONTROLLER, "model length": CONTROLLER + 1,
}  # fmt: skip


@pytest.mark.parametrize("word", amount((0, 0x7FFF, 0xFFFF), SENTINELS), ids=hex)
@pytest.mark.parametrize("address", HEADS.values(), ids=HEADS)
async def test_no_word_of_the_chain_of_models_ends_the_loop(address: int, word: int) -> None:
    plant = far_plant(CONFIG, SUMMER_NOON, "-180 to 180")
    plant.far.spoiled = {address: word}
    await plant.start()
    await plant.forward(seconds=1.2)
    loop = plant.site.model.tracker("T1")
    assert plant.site.alive
    assert loop.broken is None
    await plant.ask(Stop())
    plant.far.spoiled = {}
    await plant.forward(seconds=2)
    assert loop.trouble is None
    assert loop.feedback is not None
    await plant.close()
