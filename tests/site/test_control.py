"""Stories of control at a site: who may move a tracker, how that passes, and what late orders do: nothing."""

import asyncio
from dataclasses import dataclass

import pytest

from app.link.messages import (
    ConfigureTracker,
    Order,
    RenewControl,
    RequestControl,
    SetLocation,
    SiteCommand,
)
from app.link.settings_orders import LockSettings, UnlockSettings
from app.sun.position import Location
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    Jog,
    Move,
    SelectMode,
    SetHome,
    SetInhibit,
    Stop,
    Track,
)
from app.tracker.commands.control import ControlHeld, ControlLost
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from tests.fault_result import FaultResult
from tests.site.plant import SAMSUN, Begun, Plant, settle

AWAY = Move(Orientation(200.0, 40.0))
TAKE = RequestControl(("T1",), takes=True, reason="rain is coming")


@dataclass
class Person:
    """Somebody at a page of the plant; without an epoch of their own they order under the present one."""

    plant: Plant
    name: str
    rank: int = 1
    via: str = "session"

    @property
    def epoch(self) -> int:
        return self.plant.tracker().control.epoch

    async def ask(self, command: Command | SiteCommand, *, epoch: int | None = None) -> None:
        tracker_id = None if isinstance(command, SiteCommand) else "T1"
        given = self.epoch if epoch is None else epoch
        order = Order(command, self.name, tracker_id, via=self.via, epoch=given, rank=self.rank)
        asking = asyncio.create_task(self.plant.site.execute(order))
        while not asking.done():
            await settle()
        await asking


@pytest.mark.fault(55)
async def test_the_first_who_moves_has_control_and_the_other_may_only_stop(
    ready: Plant, fault: FaultResult
) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(AWAY)
    assert ready.tracker().control.holder == "ada"
    with pytest.raises(ControlHeld, match="ada has control of Tracker 1") as refused:
        await bo.ask(Track())
    fault.prevented("the second user may only stop")
    fault.shows(str(refused.value))
    await bo.ask(Stop())
    await ready.forward(seconds=2)
    assert ready.tracker().activity is ActivityName.HOLDING
    await bo.ask(SetInhibit("bo", "works at the gear"))
    assert ready.tracker().control.holder == "ada"
    fault.recovers("control is handed over, or ends when it is not renewed")


@pytest.mark.fault(56)
async def test_taking_over_stops_the_motion_first_and_late_orders_move_nothing(
    ready: Plant, fault: FaultResult
) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(AWAY)
    epoch = ada.epoch
    await bo.ask(TAKE)
    await ready.forward(seconds=9)
    assert ready.tracker().activity is ActivityName.MOVING, "the countdown runs"
    await ada.ask(RenewControl(("T1",)))
    await ready.forward(seconds=2)
    assert ready.tracker().control.holder == "bo"
    kinds = [event.kind for event in ready.events]
    assert kinds.index(EventKind.STOPPED) < len(kinds) - 1 - kinds[::-1].index(EventKind.CONTROL_TAKEN)
    for late in (AWAY, Jog("held", Axis.AZIMUTH, 1, sequence=40), Jog("new", Axis.AZIMUTH, 1), Track()):
        with pytest.raises(ControlLost, match="bo has control now") as refused:
            await ada.ask(late, epoch=epoch)
        fault.shows(str(refused.value))
    await ready.forward(seconds=1)
    assert not ready.site.model.tracker("T1").moving
    fault.prevented("the motion is stopped before control changes")
    await bo.ask(AWAY)
    assert ready.tracker().activity is ActivityName.MOVING
    fault.recovers("the new holder of control commands a motion")


async def test_a_held_key_ends_when_control_passes(ready: Plant) -> None:
    ada, cy = Person(ready, "ada"), Person(ready, "cy", rank=2)
    await ada.ask(Jog("p", Axis.AZIMUTH, 1))
    held = ada.epoch - 1
    refused = False
    await cy.ask(TAKE)
    for sequence in range(1, 111):
        try:
            await ada.ask(Jog("p", Axis.AZIMUTH, 1, sequence=sequence), epoch=held)
        except CommandRejected:
            refused = True
        await ready.forward(seconds=0.1)
    assert refused
    assert ready.tracker().control.holder == "cy"
    assert not ready.site.model.tracker("T1").moving


async def test_tracking_goes_on_when_who_began_it_leaves(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(SelectMode(Mode.DUAL))
    await ada.ask(Track())
    await ready.until(lambda seen: seen.in_position and seen.control.holder is None)
    assert ready.tracker().activity is ActivityName.TRACKING
    await bo.ask(RequestControl(("T1",)))
    cy = Person(ready, "cy", rank=2)
    await cy.ask(TAKE)
    await ready.forward(seconds=11)
    assert ready.tracker().control.holder == "cy"
    assert ready.tracker().activity is ActivityName.TRACKING


async def test_a_program_gives_way_to_a_person_at_once(ready: Plant) -> None:
    ada, program = Person(ready, "ada"), Person(ready, "scada (token)", via="token")
    await program.ask(AWAY)
    with pytest.raises(ControlHeld):
        await ada.ask(Track())
    await ada.ask(RequestControl(("T1",)))
    assert ready.tracker().control.holder == "ada"
    await ready.forward(seconds=1)
    assert not ready.site.model.tracker("T1").moving
    with pytest.raises(ControlHeld, match="ada has control"):
        await program.ask(AWAY)


@pytest.mark.fault(61)
async def test_an_order_from_before_a_restart_is_refused(
    ready: Plant, fault: FaultResult, begun: Begun
) -> None:
    ada = Person(ready, "ada")
    await ada.ask(RequestControl(("T1",)))
    epoch, stored = ada.epoch, ready.site.model.tracker("T1").state
    assert stored.memory.control_epoch == epoch
    later = await begun(trackers=(stored,))
    with pytest.raises(ControlLost):
        await Person(later, "ada").ask(AWAY, epoch=epoch)
    assert later.tracker().control.epoch > epoch
    fault.prevented("the order is refused")


async def test_locked_settings_stay_until_an_engineer_says_why(ready: Plant) -> None:
    ada = Person(ready, "ada", rank=2)
    config = ready.site.model.tracker("T1").config
    await ada.ask(LockSettings("T1"))
    assert ready.tracker().settings_lock is not None
    for change in (
        ConfigureTracker(config),
        SetLocation(Location(0.0, 0.0, 0.0), "UTC"),
        SetHome(),
    ):
        with pytest.raises(CommandRejected, match="settings of Tracker 1 were locked by ada"):
            await ada.ask(change)
    await ada.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    with pytest.raises(CommandRejected, match="needs a reason"):
        await ada.ask(UnlockSettings("T1", " "))
    await ada.ask(UnlockSettings("T1", "a new gear"))
    await ada.ask(ConfigureTracker(config))
    assert ready.happened(EventKind.SETTINGS_UNLOCKED)[0].message.endswith("Reason: a new gear")
