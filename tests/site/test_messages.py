"""What a site tells first of a tracker: its state, what happened last, and alarms as they are now."""

from app.link.alarm_orders import AcknowledgeAlarm, ShelveAlarm
from app.link.messages import InjectFault
from app.tracker.commands.commands import Stop
from app.tracker.state.snapshot import ActivityName, EventKind, Snapshot
from app.tracker.values.operator_message import OperatorMessage, StateWord
from tests.site.plant import Plant


def told(plant: Plant) -> Snapshot:
    return plant.latest().trackers[0]


def message(plant: Plant, code: str) -> OperatorMessage | None:
    return next((one for one in told(plant).messages if one.code == code), None)


async def test_a_tracker_is_told_with_its_state_and_with_who_stopped_it(tracked: Plant) -> None:
    await tracked.forward(seconds=60)
    assert told(tracked).state is StateWord.TRACKING
    await tracked.ask(Stop())
    await tracked.until(lambda seen: seen.activity is ActivityName.HOLDING)
    await tracked.forward(seconds=1)
    (stopped,) = tracked.happened(EventKind.STOPPED)
    first = told(tracked).messages[0]
    assert (first.code, str(first.title), first.since) == ("stopped", "Stopped by technician", stopped.at)
    assert told(tracked).state is StateWord.AT_STANDSTILL


async def test_an_alarm_that_is_acknowledged_or_shelved_is_told_so_at_once(tracked: Plant) -> None:
    await tracked.ask(InjectFault("T1", "encoder_jump"))
    await tracked.forward(seconds=5)
    jump = message(tracked, "encoder_jump")
    assert jump is not None
    assert jump.calls
    await tracked.ask(AcknowledgeAlarm(jump.alarm_id))
    seen = message(tracked, "encoder_jump")
    assert seen is not None
    assert not seen.calls, "told with the alarm, not when its tracker is due"
    await tracked.ask(ShelveAlarm(jump.alarm_id, 60, "Known."))
    assert message(tracked, "encoder_jump") is None


async def test_a_tracker_that_is_asked_for_by_itself_is_told_the_same(tracked: Plant) -> None:
    await tracked.forward(seconds=60)
    alone, told_to_all = await tracked.site.tracker("T1"), told(tracked)
    assert (alone.state, alone.messages) == (told_to_all.state, told_to_all.messages)
