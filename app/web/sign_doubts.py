"""What speaks against signing a record now: what is open, what alarms, and what a wrong clock dated."""

from collections.abc import Iterable, Iterator

from app.tracker.alarm_words import AlarmNow, AlarmState
from app.tracker.commissioning import StepStatus
from app.web.record import CommissioningRecord, is_future
from app.web.ui.frame import STEP_LABELS

PRESENT = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED, AlarmState.SHELVED)


def sign_doubts(record: CommissioningRecord, alarms: Iterable[AlarmNow]) -> tuple[str, ...]:
    """Return what must be known before a record is signed, as sentences; none: nothing is open."""
    return (*_steps(record), *_proofs(record), *_alarms(record, alarms))


def _steps(record: CommissioningRecord) -> Iterator[str]:
    for number, step in enumerate(record.steps, 1):
        label = STEP_LABELS[step.name]
        if step.status is not StepStatus.DONE:
            yield f"Step {number}, {label}, is open."
        if is_future(step.confirmed_at, record.written_at):
            yield f"Step {number}, {label}, is dated in the future: the clock was wrong then."


def _proofs(record: CommissioningRecord) -> Iterator[str]:
    count = sum(one.status is not StepStatus.DONE for one in record.proofs)
    if count:
        yield f"Drive tests that are open: {count}."


def _alarms(record: CommissioningRecord, alarms: Iterable[AlarmNow]) -> Iterator[str]:
    for alarm in alarms:
        if alarm.tracker_id in (None, record.tracker.tracker_id) and alarm.state in PRESENT:
            title = alarm.title
            yield f"An alarm is active: {title}."
