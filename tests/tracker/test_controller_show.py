"""A show on the machine: to its start, through its phases, and its ends."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.base.angles import separation_deg
from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import (
    CommandRejected,
    GoToStart,
    Move,
    PauseShow,
    ResumeShow,
    RunShow,
    SetHome,
    Stop,
    StopShow,
    Track,
)
from app.tracker.programs.show import ShowCourse, ShowPlan
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind, Pair, ShowPhase
from app.tracker.values.motion import HALT
from tests.tracker.plant import CONFIG, READY, SAMSUN, Plant
from tests.tracker.scripted import Scripted

PLAN = ShowPlan(
    "s1",
    datetime(2026, 6, 21, 3, 0, tzinfo=UTC),
    datetime(2026, 6, 21, 16, 30, tzinfo=UTC),
    timedelta(minutes=3),
    SAMSUN,
)


def at_start(plant: Plant) -> Plant:
    plant.ask(GoToStart(PLAN))
    return plant.forward(30.0)


def pair(place: Pair) -> tuple[float, float]:
    return place.azimuth_deg, place.elevation_deg


def outcome(plant: Plant) -> str:
    return str(plant.happened(EventKind.SHOW_ENDED)[-1].data["outcome"])


def test_a_show_from_its_start_to_its_end(plant: Plant) -> None:
    assert plant.ask(GoToStart(PLAN)) == [EventKind.MOVE_STARTED]
    show = plant.snapshot.show
    assert show is not None
    assert show.phase is ShowPhase.GOING_TO_START
    assert plant.reasons("run_show") == {"show_phase"}
    (waiting,) = plant.snapshot.actions["run_show"]
    assert waiting.hint == "Wait until the tracker has arrived, or press Stop."
    plant.forward(30.0)
    assert plant.snapshot.activity_text == "Show: ready at the start position"
    assert plant.controller.memory.showing is None
    assert plant.ask(RunShow(PLAN)) == [EventKind.SHOW_STARTED]
    assert plant.controller.memory.showing == "s1"
    off_deg: list[float] = []

    def look() -> None:
        shown = plant.snapshot
        if shown.show is not None and shown.target is not None and shown.measured is not None:
            off_deg.append(separation_deg(*pair(shown.measured), *pair(shown.target)))

    plant.forward(179.0, look, every=10)
    show = plant.snapshot.show
    assert show is not None
    assert show.elapsed_s == pytest.approx(179.0, abs=0.11)
    assert show.sun_time == PLAN.begin_at + timedelta(seconds=show.elapsed_s) * PLAN.acceleration
    assert show.sun_is_up
    assert max(off_deg) < 1.0
    assert max(off_deg[3:]) < 0.3, "once the axes have gathered speed"
    plant.forward(1.5)
    assert plant.activity is ActivityName.HOLDING
    assert outcome(plant) == "completed"
    assert plant.controller.memory.showing is None
    assert plant.snapshot.show is None


def test_a_paused_show_stands_still_and_goes_on_where_it_was(plant: Plant) -> None:
    at_start(plant).ask(RunShow(PLAN))
    plant.forward(60.0)
    assert plant.ask(PauseShow()) == [EventKind.SHOW_PAUSED]
    assert plant.told.azimuth == HALT
    plant.forward(30.0)
    show = plant.snapshot.show
    assert show is not None
    assert (show.phase, show.elapsed_s) == (ShowPhase.PAUSED, pytest.approx(60.0, abs=0.11))
    assert plant.reasons("pause_show") == {"show_phase"}
    assert plant.ask(ResumeShow()) == [EventKind.SHOW_RESUMED]
    plant.forward(121.0)
    assert outcome(plant) == "completed"


def test_a_gap_between_two_ticks_does_not_make_the_show_leap(plant: Plant) -> None:
    at_start(plant).ask(RunShow(PLAN))
    plant.forward(10.0)
    plant.clock.advance(timedelta(seconds=60))
    plant.tick()
    show = plant.snapshot.show
    assert show is None or show.elapsed_s == pytest.approx(12.0, abs=0.2)


def test_a_show_runs_only_from_its_start(plant: Plant) -> None:
    for command in (PauseShow(), ResumeShow(), StopShow()):
        with pytest.raises(CommandRejected, match="has no show under way"):
            plant.ask(command)
    with pytest.raises(CommandRejected) as refused:
        plant.ask(RunShow(PLAN))
    assert [reason.code for reason in refused.value.reasons] == ["show_phase"]
    at_start(plant)
    with pytest.raises(CommandRejected, match="is not at the start of this show"):
        plant.ask(RunShow(replace(PLAN, show_id="another")))
    later = replace(PLAN, show_id="s2", begin_at=PLAN.begin_at + timedelta(hours=2))
    assert plant.ask(GoToStart(later)) == [EventKind.MOVE_STARTED]


def test_a_show_may_be_run_by_a_panel_that_already_stands_at_its_start(plant: Plant) -> None:
    at_start(plant)
    plant.ask(StopShow())
    assert outcome(plant) == "stopped"
    assert plant.activity is ActivityName.HOLDING
    assert plant.ask(RunShow(PLAN)) == [EventKind.SHOW_STARTED]


def test_a_plan_that_is_too_fast_is_refused_with_its_reasons(plant: Plant) -> None:
    hasty = replace(PLAN, duration=timedelta(seconds=12))
    with pytest.raises(CommandRejected) as refused:
        plant.ask(GoToStart(hasty))
    assert all(reason.message for reason in refused.value.reasons)


def test_a_show_takes_over_from_tracking_and_says_so(plant: Plant) -> None:
    plant.ask(Track())
    plant.forward(1.0)
    with pytest.raises(CommandRejected, match="no show under way"):
        plant.ask(RunShow(PLAN))
    assert plant.ask(GoToStart(PLAN)) == [EventKind.TRACKING_ENDED, EventKind.MOVE_STARTED]
    assert not plant.controller.memory.tracking_on
    plant.forward(60.0)
    plant.ask(RunShow(PLAN))
    for command in (Track(), Move(Orientation(10.0, 10.0)), GoToStart(PLAN), SetHome()):
        with pytest.raises(CommandRejected, match="show"):
            plant.ask(command)


@pytest.mark.parametrize(
    "fault",
    [FaultKind.DRIVE_FAULT, FaultKind.POWER_LOSS, FaultKind.SILENCE, FaultKind.UPPER_LIMIT_STUCK],
)
def test_a_fault_a_switch_or_a_lost_drive_ends_a_show_at_once(plant: Plant, fault: FaultKind) -> None:
    at_start(plant).ask(RunShow(PLAN))
    plant.forward(20.0)
    if fault is FaultKind.SILENCE:
        plant.cut = True
    else:
        plant.drive.inject(Fault(fault, Axis.AZIMUTH, amount=7.0))
    plant.forward(0.8)
    assert outcome(plant) == "interrupted"
    assert plant.controller.memory.showing is None
    assert plant.told.azimuth == HALT


def test_stop_ends_a_show(plant: Plant) -> None:
    at_start(plant).ask(RunShow(PLAN))
    assert plant.ask(Stop()) == [EventKind.SHOW_ENDED, EventKind.STOPPED]


def test_a_start_that_is_not_reached_is_a_fault() -> None:
    script = Scripted(READY)
    axis = ShowCourse(PLAN, CONFIG, READY.pointing).start
    assert script.reading is not None
    near = replace(script.reading.azimuth, position_deg=axis.azimuth_deg - 0.2)
    high = replace(script.reading.elevation, position_deg=axis.elevation_deg)
    script.sees(azimuth=near, elevation=high)
    script.tick()
    script.ask(GoToStart(PLAN))
    script.forward(8.0)
    assert script.controller.memory.fault_code == "move_overdue"


def test_a_show_that_a_restart_cut_off_is_told_once() -> None:
    plant = Plant(replace(READY, showing="s7"))
    plant.forward(0.3)
    ended = plant.happened(EventKind.SHOW_ENDED)
    assert [event.data for event in ended] == [{"outcome": "interrupted", "show_id": "s7"}]
    assert plant.controller.memory.showing is None
