"""The five steps: done, to do, to be confirmed, and why."""

from dataclasses import replace

import pytest

from app.tracker.commands.commands import Move, RunShow, SelectMode, SetHome, Track
from app.tracker.commissioning.steps import Standing, Step, StepStatus, standing_of, steps
from app.tracker.memory.memory import ClockSetting, Confirmation, SiteState, StepName, TrackerMemory
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ClockState, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason
from tests.tracker.plant import BLANK, MORNING, READY, SAMSUN, Plant
from tests.tracker.test_controller_show import PLAN, at_start

SAVED = Confirmation(MORNING, "technician", 1)
SITE = SiteState(
    location=SAMSUN,
    location_revision=1,
    clock=ClockSetting("system", 0.0, MORNING, "technician"),
    confirmations={StepName.LOCATION: SAVED, StepName.CLOCK: SAVED},
)
CLOCK = ClockState("system", 0.0, trusted=True, ntp_synchronised=True, set_at=MORNING)
DONE, TO_DO, CONFIRM = StepStatus.DONE, StepStatus.TO_DO, StepStatus.TO_BE_CONFIRMED


def judge(
    memory: TrackerMemory, snapshot: Snapshot | None, *, site: SiteState = SITE, clock: ClockState = CLOCK
) -> dict[StepName, Step]:
    known = steps(site, memory, Standing() if snapshot is None else standing_of(snapshot), clock)
    assert [step.name for step in known] == list(StepName)
    for step in known:
        assert (step.status is DONE) == (not step.reasons)
        assert all(reason.message.endswith(".") and reason.hint for reason in step.reasons)
    return {step.name: step for step in known}


def of(plant: Plant, *, site: SiteState = SITE, clock: ClockState = CLOCK) -> list[StepStatus]:
    assert plant.controller.standing == standing_of(plant.snapshot)
    known = judge(plant.controller.memory, plant.snapshot, site=site, clock=clock)
    return [step.status for step in known.values()]


def test_nothing_is_done_at_first() -> None:
    known = judge(BLANK, None, site=SiteState(), clock=replace(CLOCK, trusted=False))
    assert {step.status for step in known.values()} == {TO_DO}
    assert [reason.code for reason in known[StepName.RUN].reasons] == [
        "step_location",
        "step_clock",
        "step_homing",
        "step_mode",
        "not_running",
    ]


def test_the_walk_from_a_blank_tracker_to_tracking(blank: Plant) -> None:
    assert of(blank) == [DONE, DONE, TO_DO, TO_DO, TO_DO]
    blank.ask(SetHome())
    blank.forward(1.0)
    assert of(blank) == [DONE, DONE, DONE, TO_DO, TO_DO]
    blank.ask(SelectMode(Mode.AZIMUTH, Orientation(0.0, 5.0)))
    assert of(blank) == [DONE, DONE, DONE, TO_DO, TO_DO]
    blank.ask(Move(Orientation(0.0, 5.0)))
    blank.forward(10.0)
    assert of(blank) == [DONE, DONE, DONE, DONE, TO_DO]
    blank.ask(Track())
    assert of(blank) == [DONE] * 5


def test_a_running_show_is_running_and_a_show_that_waits_is_not() -> None:
    plant = Plant(replace(READY, confirmations={StepName.HOMING: SAVED, StepName.MODE: SAVED}))
    plant.tick()
    at_start(plant)
    assert of(plant)[-1] is TO_DO
    plant.ask(RunShow(PLAN))
    assert of(plant) == [DONE] * 5


def test_a_new_location_asks_for_everything_after_it_to_be_confirmed() -> None:
    plant = Plant(replace(READY, confirmations={StepName.HOMING: SAVED, StepName.MODE: SAVED}))
    plant.tick()
    plant.ask(Track())
    moved = replace(SITE, location_revision=2)
    assert of(plant, site=moved) == [DONE, CONFIRM, CONFIRM, CONFIRM, TO_DO]
    known = judge(plant.controller.memory, plant.snapshot, site=moved)
    assert known[StepName.MODE].reasons[0].code == "location_changed"
    assert "is to be confirmed: The location has changed" in known[StepName.RUN].reasons[0].message
    assert known[StepName.HOMING].confirmed_by == "technician"
    plant.controller.confirm(StepName.HOMING, replace(SAVED, location_revision=2))
    assert of(plant, site=moved) == [DONE, CONFIRM, DONE, CONFIRM, TO_DO]


@pytest.mark.parametrize("told", [(), (Reason("clock_jumped", "The clock jumped.", "Set it."),)])
def test_a_clock_that_is_doubted_is_to_be_confirmed_with_its_reasons(told: tuple[Reason, ...]) -> None:
    doubted = replace(CLOCK, trusted=False, reasons=told)
    clock = judge(READY, None, clock=doubted)[StepName.CLOCK]
    assert clock.status is CONFIRM
    assert clock.reasons[0].code == (told[0].code if told else "clock_untrusted")


def test_a_zero_that_cannot_be_read_back_is_not_done() -> None:
    memory = replace(READY, confirmations={StepName.HOMING: SAVED})
    assert judge(memory, None)[StepName.HOMING].reasons[0].code == "drive_unreachable"
    silent = Plant(memory)
    assert judge(memory, silent.snapshot)[StepName.HOMING].status is CONFIRM
