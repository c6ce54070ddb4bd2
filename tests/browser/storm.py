"""Sixty trackers in a storm, of which three are not stowed."""

from app.base.message import say
from app.tracker.state.snapshot import ActivityName, Pair
from app.tracker.values.reason import Reason
from tests.fake_alarms import alarm
from tests.fake_data import commissioned
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine

SIXTY = 60
IN_DANGER = ("T31", "T47", "T52")
STOWING = ("T12", "T44")


def sixty_in_a_storm(machine: FakeMachine) -> None:
    """Give a machine sixty trackers: 55 are stowed, two stow, three do not."""
    machine.trackers = {f"T{number}": _stowed(f"T{number}", number) for number in range(1, SIXTY + 1)}
    for name in STOWING:
        machine.trackers[name].activity = ActivityName.STOWING
        machine.trackers[name].position = Pair(180.0, 70.0)
    for name in IN_DANGER:
        endanger(machine, name)
    machine.emit()


def endanger(machine: FakeMachine, name: str) -> None:
    """Have a tracker not stowed at 31 degrees, with its alarm."""
    tracker = machine.trackers[name]
    tracker.activity = ActivityName.HOLDING
    tracker.position = Pair(180.0, 31.2)
    tracker.not_stowed = Reason(
        "not_stowed",
        say("{name} is NOT STOWED: it must be stowed because of high wind.", name=tracker.config.name),
        say("If the tracker is to be protected, press Stow."),
    )
    machine.alarms = (*machine.alarms, alarm("not_stowed", machine.clock.now(), name))


def stow(machine: FakeMachine, name: str) -> None:
    """Have a tracker stowed, and its alarm gone."""
    tracker = machine.trackers[name]
    tracker.activity, tracker.not_stowed, tracker.position = ActivityName.STOWED, None, Pair(180.0, 90.0)
    machine.alarms = tuple(one for one in machine.alarms if one.tracker_id != name)


def _stowed(name: str, number: int) -> FakeTracker:
    tracker = FakeTracker(commissioned(name, f"Row {number}", tracking=False), Pair(180.0, 90.0))
    tracker.activity = ActivityName.STOWED
    return tracker
