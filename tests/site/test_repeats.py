"""A key stands for one command, repeated it is answered as the first was; what a stop overtook is refused."""

import asyncio

import pytest

from app.link.messages import Order, StopAll
from app.site.orders.idempotency import Repeats
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    EndJog,
    Jog,
    Park,
    SetInhibit,
    Step,
    Stop,
    Track,
)
from app.tracker.settings.axes import Axis
from app.tracker.state.snapshot import ActivityName, SiteSnapshot
from tests.fakes import FakeMachine
from tests.fault_result import FaultResult
from tests.site.plant import Plant, settle


def park(tracker_id: str = "T1") -> Order:
    return Order(Park(), "anna", tracker_id, key="k1")


@pytest.mark.parametrize(
    "other", [Order(Track(), "anna", "T1", key="k1"), park("T2")], ids=["kind", "tracker"]
)
async def test_a_key_that_is_used_again_for_something_else_is_refused_and_nothing_is_done(
    other: Order,
) -> None:
    done: list[Order] = []
    answer = FakeMachine().emit()

    async def carry_out(order: Order) -> SiteSnapshot:
        done.append(order)
        return answer

    repeats = Repeats()
    assert await repeats.once(park(), carry_out) is answer
    assert await repeats.once(park(), carry_out) is answer
    with pytest.raises(CommandRejected) as refused:
        await repeats.once(other, carry_out)
    (reason,) = refused.value.reasons
    assert reason.code == "key_reused"
    assert reason.message == "This idempotency key was used for another command; nothing was done."
    assert len(done) == 1


@pytest.mark.fault(97)
@pytest.mark.parametrize(
    ("motion", "stop"),
    [(Jog("p", Axis.AZIMUTH, 1), Stop()), (Step(Axis.AZIMUTH, 1.0), StopAll()), (Park(), Stop())],
)
async def test_a_motion_that_a_stop_overtook_is_not_begun(
    ready: Plant, motion: Command, stop: Stop | StopAll
) -> None:
    await ready.ask(stop, given_s=100.0)
    with pytest.raises(CommandRejected, match="Tracker 1 was stopped after this command was given"):
        await ready.ask(motion, given_s=99.999)
    assert ready.tracker().activity in {ActivityName.HOLDING, ActivityName.STOPPING}
    await ready.ask(Stop(), given_s=50.0)
    with pytest.raises(CommandRejected, match="stopped after"):
        await ready.ask(motion, given_s=99.999)


async def test_what_was_given_after_a_stop_or_moves_nothing_is_carried_out(ready: Plant) -> None:
    await ready.ask(Stop(), given_s=100.0)
    await ready.forward(seconds=2)
    await ready.ask(EndJog("p"), given_s=99.0)
    await ready.ask(Park(), given_s=100.001)
    await ready.ask(Stop(), given_s=101.0)
    await ready.ask(SetInhibit("ada", "works at the gear"), given_s=99.0)
    assert ready.tracker().lock is not None


@pytest.mark.fault(97)
async def test_an_order_that_waits_for_control_while_its_tracker_is_stopped_moves_nothing(
    ready: Plant, fault: FaultResult
) -> None:
    async with ready.site.model.control.lock("T1"):
        waits = asyncio.create_task(ready.site.execute(Order(Park(), "technician", "T1")))
        await settle()
        await ready.ask(Stop())
    with pytest.raises(CommandRejected) as refused:
        await waits
    (reason,) = refused.value.reasons
    assert reason.code == "stopped_since"
    assert ready.tracker().activity in {ActivityName.HOLDING, ActivityName.STOPPING}
    fault.prevented("an order from before a stop is refused, however long it waited")
    fault.shows(reason.message)
    await ready.forward(seconds=2)
    await ready.ask(Park())
    assert ready.tracker().activity is ActivityName.MOVING
    fault.recovers("the order is given again")
