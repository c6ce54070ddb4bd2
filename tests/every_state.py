"""One tracker in every state there is: what its snapshot says, and what a person is to be told first."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any

from app.alarms.catalogue import CATALOGUE
from app.base.message import N_
from app.tracker.commands.control import ControlRequest, ControlState
from app.tracker.protections.words import MaintenanceLock, ServiceMode, ServiceState, WarningState
from app.tracker.state.snapshot import ActivityName, Snapshot
from app.tracker.values.operator_message import StateWord
from app.tracker.values.reason import Reason
from tests.fake_tracker import ACTIONS, FakeTracker

AT = datetime(2026, 6, 21, 12, tzinfo=UTC)
NOT_STOWED = Reason("not_stowed", N_("North field is NOT STOWED."), N_("Press Stow panel."))
FAULT = Reason("following_error", N_("The elevation axis does not follow."), N_("Check the motor."))
UNKNOWN_FAULT = Reason("odd", N_("The drive reports fault 17."), N_("See its manual."))
SILENT = Reason("drive_unreachable", N_("The drive does not answer."), N_("Check its cable."))
SUN_DOWN = Reason("sun_down", N_("The sun is below the horizon."), N_("Tracking continues at sunrise."))
OPERATOR = Reason("operator_needed", N_("Tracking was interrupted."), N_("Press Start tracking."))
AHEAD = Reason("motion_ahead", N_("North field begins to track."), N_("Keep clear of the panel."))
WISH = ControlState(
    3, "ada", "session", 2, request=ControlRequest("zoe", "session", True, "Storm.", AT, can_be_refused=True)
)


@dataclass(frozen=True, slots=True)
class Case:
    """Fields of a snapshot, the word for them, and the code of the message that is first ("" for none)."""

    fields: dict[str, Any]
    word: StateWord
    first: str = ""


def _doing(name: ActivityName, word: StateWord, **fields: Any) -> Case:
    return Case({"activity": name} | fields, word)


CASES: dict[str, Case] = {
    "at standstill": _doing(ActivityName.HOLDING, StateWord.AT_STANDSTILL),
    "not homed": _doing(ActivityName.HOLDING, StateWord.NOT_HOMED, homed=False),
    "jogging": _doing(ActivityName.JOGGING, StateWord.JOGGING),
    "moving": _doing(ActivityName.MOVING, StateWord.MOVING),
    "setting home": _doing(ActivityName.SETTING_HOME, StateWord.SETTING_HOME),
    "homing": _doing(ActivityName.HOMING, StateWord.HOMING),
    "drive test": _doing(ActivityName.MEASURING, StateWord.DRIVE_TEST),
    "showing": _doing(ActivityName.SHOWING, StateWord.SHOW),
    "stopping": _doing(ActivityName.STOPPING, StateWord.STOPPING),
    "stowing": _doing(ActivityName.STOWING, StateWord.STOWING),
    "stowed": _doing(ActivityName.STOWED, StateWord.STOWED),
    "tracking": _doing(ActivityName.TRACKING, StateWord.TRACKING, tracking_on=True),
    "moving to the sun": _doing(
        ActivityName.TRACKING, StateWord.MOVING_TO_THE_SUN, approaching=True, tracking_on=True
    ),
    "waiting": Case(
        {"activity": ActivityName.TRACKING, "tracking_on": True, "waiting": (SUN_DOWN,)},
        StateWord.WAITING,
        "sun_down",
    ),
    "interrupted": Case(
        {"activity": ActivityName.HOLDING, "tracking_on": True, "waiting": (OPERATOR,)},
        StateWord.INTERRUPTED,
        "operator_needed",
    ),
    "local": Case({"activity": ActivityName.HOLDING, "local": True}, StateWord.LOCAL, "local"),
    "inhibited": Case(
        {"activity": ActivityName.HOLDING, "lock": MaintenanceLock("ada", "ada", AT, "Gearbox open.")},
        StateWord.INHIBITED,
    ),
    "service mode": Case(
        {"activity": ActivityName.HOLDING, "service": ServiceState(ServiceMode("ada", "ada", AT), 60.0)},
        StateWord.SERVICE_MODE,
        "service",
    ),
    "fault": Case({"activity": ActivityName.FAULTED, "fault": FAULT}, StateWord.FAULT, "following_error"),
    "unknown fault": Case(
        {"activity": ActivityName.FAULTED, "fault": UNKNOWN_FAULT}, StateWord.FAULT, "fault"
    ),
    "silent drive while it holds": Case(
        {"activity": ActivityName.HOLDING, "unreachable": SILENT, "measured": None},
        StateWord.NO_CONNECTION,
        "drive_lost",
    ),
    "silent drive while it tracks": Case(
        {"activity": ActivityName.TRACKING, "unreachable": SILENT, "measured": None, "tracking_on": True},
        StateWord.NO_CONNECTION,
        "drive_lost",
    ),
    "not stowed": Case(
        {"activity": ActivityName.HOLDING, "not_stowed": NOT_STOWED}, StateWord.NOT_STOWED, "not_stowed"
    ),
    "not stowed, faulted, silent, local": Case(
        {
            "activity": ActivityName.FAULTED, "not_stowed": NOT_STOWED, "fault": FAULT, "unreachable": SILENT,
            "measured": None, "local": True, "waiting": (OPERATOR,), "warning": WarningState(4.0, AHEAD),
        },
        StateWord.NOT_STOWED,
        "motion_ahead",
    ),
    "motion announced": Case(
        {"activity": ActivityName.TRACKING, "tracking_on": True, "warning": WarningState(4.0, AHEAD)},
        StateWord.TRACKING,
        "motion_ahead",
    ),
    "control requested": Case(
        {"activity": ActivityName.HOLDING, "control": WISH}, StateWord.AT_STANDSTILL, "control_requested"
    ),
} | {
    f"alarm {code}": Case(
        {"activity": ActivityName.HOLDING, "notices": (Reason(code, entry.title, entry.do),)},
        StateWord.AT_STANDSTILL,
        code,
    )
    for code, entry in CATALOGUE.items()
}  # fmt: skip


def short_walk() -> list[str]:
    """Return the states without one for each alarm."""
    return [name for name in CASES if not name.startswith("alarm ")]


class StagedTracker(FakeTracker):
    """A tracker that is in the state that the test wants."""

    case = CASES["at standstill"]
    refused: tuple[Reason, ...] = ()
    """Why it does nothing that it is asked for, if it does not."""

    def snapshot(self, at: datetime, tick: int) -> Snapshot:
        told = replace(super().snapshot(at, tick), **self.case.fields)
        if not self.refused:
            return told
        return replace(told, actions=dict.fromkeys((*ACTIONS, "stow", "resume"), self.refused))
