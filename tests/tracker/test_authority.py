"""The switch at the cabinet and service mode: what they end, what is told of them, and what stays."""

from datetime import timedelta

import pytest

from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import (
    BeginServiceMode,
    Command,
    CommandRejected,
    ConfirmAreaClear,
    EndServiceMode,
    Jog,
    ResetFault,
    Stow,
    Track,
)
from app.tracker.settings.axes import Axis
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import ActivityName, Event, EventKind
from tests.tracker.plant import READY
from tests.tracker.test_faults import SOUTH, Plant, block_and_free, guarded, moving

KEY = Jog("press", Axis.AZIMUTH, 1)


def ready(*, clear_for_s: float = 900.0) -> Plant:
    plant = Plant(READY, config=guarded(clear_for_s=clear_for_s))
    plant.tick()
    return plant


def turn_switch(plant: Plant, *, local: bool) -> None:
    if local:
        plant.drive.inject(Fault(FaultKind.LOCAL_SWITCH, None, 0.0))
    else:
        plant.drive.end_injected_faults()


def only(plant: Plant, kind: EventKind) -> Event:
    (event,) = plant.happened(kind)
    return event


def doing(plant: Plant) -> ActivityName:
    return plant.activity


@pytest.mark.parametrize("command", [SOUTH, KEY, Stow(StowName.WIND)])
def test_what_is_under_way_ends_with_the_switch_and_nothing_begins_when_it_is_turned_back(
    command: Command,
) -> None:
    plant = ready()
    plant.ask(command)
    plant.tick()
    turn_switch(plant, local=True)
    plant.forward(0.2)
    assert doing(plant) is ActivityName.HOLDING
    plant.forward(5.0)
    turn_switch(plant, local=False)
    plant.forward(5.0)
    assert doing(plant) is ActivityName.HOLDING
    taken, back = only(plant, EventKind.SWITCHED_TO_LOCAL), only(plant, EventKind.SWITCHED_TO_REMOTE)
    assert taken.message == "The switch at the cabinet of Tracker 1 is on local."
    assert taken.data == {"code": "local"}
    assert back.message == (
        "The switch at the cabinet of Tracker 1 is on remote again. Nothing moves automatically."
    )
    assert taken.tracker_id == back.tracker_id == "T1"


def test_tracking_waits_with_the_reason_until_somebody_commands_it() -> None:
    plant = moving(tracks=True)
    turn_switch(plant, local=True)
    plant.forward(0.2)
    (waits,) = plant.snapshot.waiting
    assert (waits.code, waits.hint) == (
        "local", "The tracker is operated from its cabinet. Turn the switch to remote to use Heliopanel.",
    )  # fmt: skip
    turn_switch(plant, local=False)
    plant.forward(5.0)
    plant.ask(Track())
    assert doing(plant) is ActivityName.TRACKING


def test_a_switch_that_is_on_local_when_the_drive_is_first_heard_is_told() -> None:
    plant = Plant(READY)
    turn_switch(plant, local=True)
    plant.forward(0.3)
    assert only(plant, EventKind.SWITCHED_TO_LOCAL)
    assert not plant.happened(EventKind.SWITCHED_TO_REMOTE)
    remote = Plant(READY).forward(1.0)
    assert not remote.happened(EventKind.SWITCHED_TO_LOCAL) + remote.happened(EventKind.SWITCHED_TO_REMOTE)


def test_what_was_held_back_does_not_go_on_after_the_switch() -> None:
    """Neither the move that a guard held back, nor its approach, is taken up again."""
    plant = moving()
    turn_switch(plant, local=True)
    plant.forward(0.2)
    assert not plant.controller._state.waiting.untouched
    assert plant.snapshot.setpoint is None


def test_service_begins_at_rest_with_tracking_off_and_names_who_serves() -> None:
    plant = moving(tracks=True)
    plant.clock.advance(timedelta(seconds=0.1))
    plant.ask(BeginServiceMode("  Ada  "), actor="ada")
    assert doing(plant) in (ActivityName.STOPPING, ActivityName.HOLDING)
    plant.forward(3.0)
    assert doing(plant) is ActivityName.HOLDING
    service = plant.snapshot.service
    assert service is not None
    assert (service.mode.name, service.mode.by, service.clear_for_s) == ("Ada", "ada", 0.0)
    began = only(plant, EventKind.SERVICE_MODE_STARTED)
    assert service.mode.since == began.at
    assert began.message == (
        "Ada put Tracker 1 in service mode. The tracker moves slowly after the area is confirmed clear."
    )
    assert (began.data, began.actor) == ({"name": "Ada"}, "ada")
    off = only(plant, EventKind.TRACKING_ENDED)
    assert off.message == "Tracking is switched off: service mode begins."
    assert plant.snapshot.setpoint is None
    assert not plant.snapshot.tracking_on
    with pytest.raises(CommandRejected, match="service mode"):
        plant.ask(BeginServiceMode("Bo"))


def test_a_key_that_is_held_ends_with_the_beginning_of_service() -> None:
    plant = ready()
    plant.ask(KEY)
    plant.ask(BeginServiceMode("Ada"))
    ended = only(plant, EventKind.JOG_ENDED)
    assert ended.message == "The jog of azimuth ended: service mode begins."
    assert doing(plant) is ActivityName.STOPPING


def test_neither_the_switch_nor_service_mode_leaves_a_fault() -> None:
    plant = moving()
    block_and_free(plant)
    turn_switch(plant, local=True)
    plant.forward(1.0)
    assert doing(plant) is ActivityName.FAULTED
    turn_switch(plant, local=False)
    plant.forward(1.0)
    plant.ask(BeginServiceMode("Ada"))
    assert doing(plant) is ActivityName.FAULTED
    plant.ask(ResetFault())
    assert doing(plant) is not ActivityName.FAULTED


def test_a_clear_area_counts_for_its_time_and_no_longer() -> None:
    plant = ready(clear_for_s=20.0)
    with pytest.raises(CommandRejected, match="not in service mode"):
        plant.ask(ConfirmAreaClear())
    plant.ask(BeginServiceMode("Ada"))
    plant.ask(ConfirmAreaClear())
    assert only(plant, EventKind.AREA_CONFIRMED_CLEAR).message == (
        "The area around Tracker 1 is confirmed clear, valid for 0.333333 minutes."
    )
    assert only(plant, EventKind.AREA_CONFIRMED_CLEAR).data == {"seconds": 20.0}
    plant.forward(5.0)
    service = plant.snapshot.service
    assert service is not None
    assert service.clear_for_s == pytest.approx(15.0)
    plant.ask(KEY)
    plant.leap(plant.clock.now() + timedelta(seconds=14.9))
    plant.tick()
    assert not plant.happened(EventKind.AREA_CONFIRMATION_EXPIRED)
    plant.leap(plant.clock.now() + timedelta(seconds=0.1))
    plant.tick()
    doubted = only(plant, EventKind.AREA_CONFIRMATION_EXPIRED)
    assert doubted.message == "The area-clear confirmation for Tracker 1 has expired."
    assert doubted.data == {"code": "area_not_clear"}
    plant.forward(60.0)
    assert only(plant, EventKind.AREA_CONFIRMATION_EXPIRED), "told once"
    over = plant.snapshot.service
    assert over is not None
    assert over.clear_for_s == 0.0


def test_the_next_service_wants_the_area_to_be_looked_at_anew() -> None:
    plant = ready()
    plant.ask(BeginServiceMode("Ada"))
    plant.ask(ConfirmAreaClear())
    plant.ask(SOUTH)
    plant.ask(EndServiceMode())
    assert doing(plant) is ActivityName.HOLDING, "the motion ends"
    assert only(plant, EventKind.MOVE_ENDED).message.endswith("service mode ends.")
    assert only(plant, EventKind.SERVICE_MODE_ENDED).message == "Service mode of Tracker 1 has ended."
    assert plant.snapshot.service is None
    plant.ask(BeginServiceMode("Bo"))
    service = plant.snapshot.service
    assert service is not None
    assert service.clear_for_s == 0.0
    assert plant.reasons("move") >= {"area_not_clear"}
    plant.forward(1000.0)
    assert not plant.happened(EventKind.AREA_CONFIRMATION_EXPIRED), "the former word is forgotten"


def test_service_without_a_name_is_refused_with_what_bears_one() -> None:
    plant = ready()
    with pytest.raises(CommandRejected, match=r"^Service mode requires a name of 1 to 60 characters"):
        plant.ask(BeginServiceMode("  "))
    with pytest.raises(CommandRejected, match="not in service mode"):
        plant.ask(EndServiceMode())
