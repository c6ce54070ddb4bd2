"""What happened, under names that former versions wrote: the journal keeps them, nothing in it is changed."""

from collections.abc import Iterable

from app.tracker.state.snapshot import EventKind

FORMER_KINDS = {
    "area_cleared": EventKind.AREA_CONFIRMED_CLEAR,
    "area_doubted": EventKind.AREA_CONFIRMATION_EXPIRED,
    "control_asked": EventKind.CONTROL_REQUESTED,
    "control_refused": EventKind.CONTROL_DECLINED,
    "crept": EventKind.UNCOMMANDED_MOTION,
    "fault_recovered": EventKind.FAULT_RESET_AUTOMATICALLY,
    "faults_cleared": EventKind.INJECTED_FAULTS_ENDED,
    "local_given_back": EventKind.SWITCHED_TO_REMOTE,
    "local_taken": EventKind.SWITCHED_TO_LOCAL,
    "lock_released": EventKind.INHIBIT_RELEASED,
    "locked_out": EventKind.INHIBIT_SET,
    "machine_restarts": EventKind.CONTROLLER_RESTARTS,
    "machine_started": EventKind.CONTROLLER_STARTED,
    "machine_stopped": EventKind.CONTROLLER_STOPPED,
    "overran": EventKind.STOPPING_DISTANCE_EXCEEDED,
    "proof_ended": EventKind.DRIVE_TEST_ENDED,
    "proof_started": EventKind.DRIVE_TEST_STARTED,
    "sensor_doubted": EventKind.SENSOR_INVALID,
    "sensor_trusted": EventKind.SENSOR_VALID,
    "service_began": EventKind.SERVICE_MODE_STARTED,
    "service_ended": EventKind.SERVICE_MODE_ENDED,
    "tracking_waiting": EventKind.TRACKING_INTERRUPTED,
    "zero_failed": EventKind.HOME_POSITION_NOT_SET,
    "zero_set": EventKind.HOME_POSITION_SET,
    "zero_undone": EventKind.HOME_POSITION_UNDONE,
}


def kind_of(stored: str) -> EventKind | None:
    """Return what a stored name means today, None if it is unknown."""
    return FORMER_KINDS.get(stored) or next((kind for kind in EventKind if kind == stored), None)


def stored_as(kinds: Iterable[EventKind]) -> list[str]:
    """Return every name under which these have been stored."""
    wanted = set(kinds)
    return [*wanted, *(name for name, kind in FORMER_KINDS.items() if kind in wanted)]
