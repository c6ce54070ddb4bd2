"""What speaks against signing a record now: what is open, what alarms, and what a wrong clock dated."""

from collections.abc import Iterable, Iterator

from app.base.message import say, word
from app.tracker.commissioning.steps import StepStatus
from app.tracker.values.alarm_words import AlarmNow, AlarmState
from app.web.features.records.record import CommissioningRecord, is_future
from app.web.shell.frame import STEP_LABELS

PRESENT = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED, AlarmState.SHELVED)


def sign_doubts(record: CommissioningRecord, alarms: Iterable[AlarmNow]) -> tuple[str, ...]:
    """Return what must be known before a record is signed, as sentences; none: nothing is open."""
    return (*_steps(record), *_proofs(record), *_alarms(record, alarms))


def _steps(record: CommissioningRecord) -> Iterator[str]:
    for number, step in enumerate(record.steps, 1):
        label = STEP_LABELS[step.name]
        if step.status is not StepStatus.DONE:
            yield say("Step {number}, {label}, is open.", number=number, label=word(label))
        if is_future(step.confirmed_at, record.written_at):
            yield say(
                "Step {number}, {label}, is dated in the future: the clock was wrong then.",
                number=number,
                label=word(label),
            )


def _proofs(record: CommissioningRecord) -> Iterator[str]:
    count = sum(one.status is not StepStatus.DONE for one in record.proofs)
    if count:
        yield say("Drive tests that are open: {count}.", count=count)


def _alarms(record: CommissioningRecord, alarms: Iterable[AlarmNow]) -> Iterator[str]:
    for alarm in alarms:
        if alarm.tracker_id in (None, record.tracker.tracker_id) and alarm.state in PRESENT:
            title = alarm.title
            yield say("An alarm is active: {title}.", title=title)
