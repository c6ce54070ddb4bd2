"""Tracking is said of a panel that has reached the sun; until then it moves to the sun."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.tracker.commands.commands import Stop, Stow, Track
from app.tracker.settings.config import Orientation
from app.tracker.settings.protections import StowName
from app.tracker.settings.strategy import Continuous, Strategy
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from tests.tracker.plant import CONFIG, MORNING, READY, Plant

APPROACH = "Moving to the sun"
NIGHT = datetime(2026, 6, 21, 20, 0, tzinfo=UTC)


def told(plant: Plant) -> tuple[str, bool]:
    """Return the text without what follows `Tracking:`, and whether the panel is on its way."""
    return plant.snapshot.activity_text.split(":")[0], plant.snapshot.approaching


def begun(strategy: Strategy | None = None) -> Plant:
    config = CONFIG if strategy is None else replace(CONFIG, strategy=strategy)
    plant = Plant(READY, config=config, watchdog=None)
    plant.tick()
    plant.ask(Track())
    return plant


@pytest.mark.parametrize("strategy", [None, Continuous()], ids=["deadband", "continuous"])
def test_the_first_approach_is_no_tracking_yet(strategy: Strategy | None) -> None:
    plant = begun(strategy)
    assert plant.snapshot.off_sun_deg is not None
    assert plant.snapshot.off_sun_deg > 30.0
    worst_tracking_deg = 0.0

    def look() -> None:
        nonlocal worst_tracking_deg
        shown = plant.snapshot
        assert shown.activity is ActivityName.TRACKING
        if shown.approaching:
            assert shown.activity_text == APPROACH
        else:
            worst_tracking_deg = max(worst_tracking_deg, shown.off_sun_deg or 0.0)

    plant.forward(60.0, look, every=5)
    assert told(plant) == ("Tracking", False)
    assert worst_tracking_deg < CONFIG.deadband_deg


def test_the_runs_of_every_few_minutes_are_tracking() -> None:
    plant = begun().forward(60.0)
    moving = 0

    def look() -> None:
        nonlocal moving
        assert told(plant) == ("Tracking", False)
        moving += "moving to the sun" in plant.snapshot.activity_text

    plant.period = timedelta(seconds=1)
    plant.forward(300.0, look)
    assert moving > 2


def test_a_target_that_is_far_again_is_approached_anew_and_one_that_is_near_is_not() -> None:
    plant = begun().forward(60.0)
    plant.ask(Stop())
    plant.forward(2.0)
    plant.ask(Track())
    assert told(plant) == ("Tracking", False)
    plant.ask(Stow(StowName.WIND))
    plant.forward(30.0)
    assert not plant.snapshot.approaching
    plant.ask(Track())
    assert told(plant) == (APPROACH, True)
    plant.forward(60.0)
    assert told(plant) == ("Tracking", False)
    plant.leap(plant.clock.now() + timedelta(hours=4))
    plant.forward(1.0)
    assert told(plant) == (APPROACH, True)


@pytest.mark.parametrize(
    ("mode", "at", "text"),
    [
        (Mode.FIXED, MORNING, "Tracking: moving to the fixed orientation"),
        (Mode.DUAL, NIGHT, "Tracking: the sun is down, going to the night position"),
    ],
    ids=["fixed", "night"],
)
def test_neither_a_fixed_orientation_nor_the_night_position_is_the_sun(
    mode: Mode, at: datetime, text: str
) -> None:
    plant = Plant(replace(READY, mode=mode, orientation=Orientation(300.0, 20.0)), at=at, watchdog=None)
    plant.tick()
    plant.ask(Track())
    assert not plant.snapshot.approaching
    assert plant.snapshot.activity_text == text
