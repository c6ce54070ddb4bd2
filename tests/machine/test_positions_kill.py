"""A controller that ends between two writes of a simulated drive's position: by a kill, by a power cut."""

import shutil
from collections.abc import AsyncIterator
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.simulation.kept_positions import KeptPositions
from app.tracker.commands.commands import Move, Stop
from app.tracker.settings.config import Orientation
from tests.machine.field import noon_place, prepare
from tests.machine.lives import Machine
from tests.patience import eventually

AWAY_DEG = 8.0
RESOLUTION_DEG = 0.05


@pytest.fixture
async def machine(tmp_path: Path) -> AsyncIterator[Machine]:
    machine = Machine.of(tmp_path / "data")
    prepare(machine.data_dir, 1, noon_place(datetime.now(UTC)))
    await machine.start()
    yield machine
    await machine.stop()


def azimuth_deg(machine: Machine) -> float | None:
    latest = machine.link.latest()
    measured = None if latest is None else latest.trackers[0].measured
    return None if measured is None else measured.azimuth_deg


async def moved(machine: Machine) -> float:
    """Move the panel aside and return where its disk still says that it stands."""
    await eventually(lambda: azimuth_deg(machine) is not None)
    await machine.ask(Stop())
    begun_deg = azimuth_deg(machine)
    assert begun_deg is not None
    aside_deg = begun_deg + (AWAY_DEG if begun_deg < 180.0 else -AWAY_DEG)
    await machine.ask(Move(Orientation(aside_deg, 45.0)))
    await eventually(lambda: machine.site.trackers[0].in_position and abs(_stands(machine) - aside_deg) < 0.5)
    kept = KeptPositions(machine.data_dir / "drives").of("T1").recall()
    assert kept is not None
    assert abs(kept.azimuth.true_deg - aside_deg) > AWAY_DEG / 2.0
    return kept.azimuth.true_deg


def _stands(machine: Machine) -> float:
    return azimuth_deg(machine) or 0.0


async def test_after_a_kill_position_and_home_hold_and_after_a_power_cut_what_the_disk_says(
    machine: Machine, runtime_directory: Path
) -> None:
    await moved(machine)
    before_deg = _stands(machine)
    machine.kill()
    await next_life(machine)
    assert _stands(machine) == pytest.approx(before_deg, abs=RESOLUTION_DEG)

    on_disk_deg = await moved(machine)
    machine.kill()
    _lose_memory(runtime_directory)
    await next_life(machine)
    assert _stands(machine) == pytest.approx(on_disk_deg, abs=RESOLUTION_DEG)


def _lose_memory(place: Path) -> None:
    """Lose what a computer without power loses."""
    for left in place.iterdir():
        shutil.rmtree(left)


async def next_life(machine: Machine) -> None:
    await machine.forget()
    await machine.start()
    await eventually(lambda: azimuth_deg(machine) is not None)
    assert machine.site.trackers[0].homed, machine.log()
