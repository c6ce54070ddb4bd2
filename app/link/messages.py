"""What crosses the wire between panel and machine: plain data, nothing else."""

from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from datetime import datetime
from typing import ClassVar, Literal, Protocol

from app.base.permission import Permission
from app.link.alarm_orders import AlarmOrder, NotificationOrder
from app.link.place_orders import SetHorizon
from app.link.record_orders import RecordOrder
from app.link.settings_orders import LockOrder, UndoSettings, UndoSiteSettings
from app.link.weather_orders import ReportWeather, SetMetStation, SetWeatherWindows, SimulateWeather
from app.sun.position import Location
from app.tracker.commands.commands import Command
from app.tracker.commissioning.drive_test_states import ProofState
from app.tracker.commissioning.steps import Step
from app.tracker.memory.drive_check import DriveCheck, DriveChoices
from app.tracker.memory.drive_tests import AxisEnd
from app.tracker.memory.memory import Sighting, SiteState, StepName, TrackerState
from app.tracker.memory.recording import RecordingInfo
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, TrackerConfig
from app.tracker.state.snapshot import Event, SiteSnapshot, Snapshot
from app.tracker.values.motion import DriveCapabilities
from app.tracker.values.order_spec import LONG_S, STORED_S, Interface, Motion, OrderSpec, setting


class MachineUnreachable(Exception):
    """The controller service does not answer; nothing was done, and nothing will be done later."""


class UnknownTracker(Exception):
    """No tracker has this id."""


class UnknownRecording(Exception):
    """No recording has this id."""


@dataclass(frozen=True, slots=True)
class SetLocation:
    """Step 1: where the site is and which civil time it keeps."""

    location: Location
    time_zone: str
    kind: Literal["set_location"] = "set_location"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class SetClock:
    """Step 2: trust the system clock (`at` is None), or make the controller's clock show `at` now."""

    source: Literal["system", "manual"]
    at: datetime | None = None
    time_zone: str | None = None
    kind: Literal["set_clock"] = "set_clock"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class RenameSite:
    """Give the site another name."""

    name: str
    kind: Literal["rename_site"] = "rename_site"
    spec: ClassVar = setting(undone_by=UndoSiteSettings)


@dataclass(frozen=True, slots=True)
class AddTracker:
    """Add a tracker; its id must be new."""

    config: TrackerConfig
    kind: Literal["add_tracker"] = "add_tracker"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class ConfigureTracker:
    """Replace a tracker's configuration; refused while it moves. Renaming is this too."""

    config: TrackerConfig
    kind: Literal["configure_tracker"] = "configure_tracker"
    spec: ClassVar = setting(sealed=True, undone_by=UndoSettings)


@dataclass(frozen=True, slots=True)
class RemoveTracker:
    """Remove a tracker that stands still; its recordings and journal stay."""

    tracker_id: str
    kind: Literal["remove_tracker"] = "remove_tracker"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class ConfirmStep:
    """The operator says that a step is still right."""

    tracker_id: str
    step: StepName
    kind: Literal["confirm_step"] = "confirm_step"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class TakeSighting:
    """The panel faces the sun now: store sun and panel as one sighting."""

    tracker_id: str
    kind: Literal["take_sighting"] = "take_sighting"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class ApplySightings:
    """Fit the stored sightings and correct with the result; no sightings: forget the correction."""

    tracker_id: str
    keep: tuple[Sighting, ...]
    kind: Literal["apply_sightings"] = "apply_sightings"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class AnswerDirection:
    """Somebody saw the panel turn: as the controller says, or the other way round."""

    tracker_id: str
    right: bool
    kind: Literal["answer_direction"] = "answer_direction"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class AnswerScale:
    """Somebody measured by how many degrees the panel turned, without a sign."""

    tracker_id: str
    measured_deg: float
    kind: Literal["answer_scale"] = "answer_scale"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class SetSoftLimit:
    """An axis stands where its lower or upper soft limit shall be."""

    tracker_id: str
    axis: Axis
    end: AxisEnd
    kind: Literal["set_soft_limit"] = "set_soft_limit"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class RestoreDrive:
    """Set the drive as it was before its settings were changed last."""

    tracker_id: str
    kind: Literal["restore_drive"] = "restore_drive"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class CheckConnection:
    """Read a drive with these settings, which need not be the tracker's; nothing is changed."""

    tracker_id: str
    drive: DriveConfig
    kind: Literal["check_connection"] = "check_connection"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, within_s=STORED_S, audited=False)


DriveOrder = AnswerDirection | AnswerScale | SetSoftLimit | RestoreDrive | CheckConnection
"""What concerns the set-up of one tracker's drive."""


@dataclass(frozen=True, slots=True)
class RequestControl:
    """Ask for control of these trackers, or with `takes` take it over from whoever has it; all or none."""

    tracker_ids: tuple[str, ...]
    takes: bool = False
    reason: str = ""
    kind: Literal["request_control"] = "request_control"
    spec: ClassVar = OrderSpec(
        needs=Permission.OPERATE, within_s=STORED_S, by=Interface.PEOPLE | Interface.SUNSPEC
    )


@dataclass(frozen=True, slots=True)
class AnswerControl:
    """Whoever has control hands it over to who wants it, or keeps it."""

    tracker_id: str
    grants: bool
    kind: Literal["answer_control"] = "answer_control"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, within_s=STORED_S)


@dataclass(frozen=True, slots=True)
class ReleaseControl:
    """Whoever has control lets go of it."""

    tracker_id: str
    kind: Literal["release_control"] = "release_control"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, within_s=STORED_S)


@dataclass(frozen=True, slots=True)
class RenewControl:
    """Whoever has control of these trackers is still there; of the others nothing changes."""

    tracker_ids: tuple[str, ...]
    kind: Literal["renew_control"] = "renew_control"
    spec: ClassVar = OrderSpec(
        needs=Permission.OPERATE, within_s=STORED_S, by=Interface.PAGE | Interface.SUNSPEC, audited=False
    )


@dataclass(frozen=True, slots=True)
class ReportDeviceClock:
    """A page tells by how much the controller's clock is ahead of that of its device.

    `page` is a name that the page has for as long as it is open.
    """

    page: str
    ahead_s: float
    kind: Literal["report_device_clock"] = "report_device_clock"
    spec: ClassVar = OrderSpec(needs=Permission.READ, by=Interface.PAGE, audited=False)


ControlOrder = RequestControl | AnswerControl | ReleaseControl | RenewControl
"""What somebody says about control."""


@dataclass(frozen=True, slots=True)
class SavePlan:
    """Keep the plan of a show so that it can be found by its id."""

    tracker_id: str
    plan: ShowPlan
    kind: Literal["save_plan"] = "save_plan"
    spec: ClassVar = setting(Permission.OPERATE)


@dataclass(frozen=True, slots=True)
class StopAll:
    """Stop every tracker of the site now."""

    kind: Literal["stop_all"] = "stop_all"
    spec: ClassVar = OrderSpec(
        needs=Permission.STOP, within_s=STORED_S, motion=Motion.STOPS, in_safe_mode=True
    )


@dataclass(frozen=True, slots=True)
class SaveRecording:
    """Store a finished simulation: its head and its chunks, base64 of the store's own encoding."""

    info: RecordingInfo
    chunks: tuple[str, ...]
    kind: Literal["save_recording"] = "save_recording"
    spec: ClassVar = setting(Permission.SIMULATE, within_s=LONG_S)


@dataclass(frozen=True, slots=True)
class DeleteRecording:
    """Delete a recording that is not running."""

    recording_id: str
    kind: Literal["delete_recording"] = "delete_recording"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class InjectFault:
    """Play a fault of the lessons on a tracker that is simulated in the machine's process."""

    tracker_id: str
    fault: str
    kind: Literal["inject_fault"] = "inject_fault"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, within_s=STORED_S)


@dataclass(frozen=True, slots=True)
class EndInjectedFaults:
    """End every fault that is played on a simulated tracker."""

    tracker_id: str
    kind: Literal["end_injected_faults"] = "end_injected_faults"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, within_s=STORED_S)


SiteCommand = (
    SetLocation | SetHorizon | SetClock | RenameSite | AddTracker | ConfigureTracker | RemoveTracker
    | ConfirmStep | SavePlan | TakeSighting | ApplySightings | StopAll | SaveRecording | DeleteRecording
    | DriveOrder | ReportWeather | SetMetStation | SimulateWeather | SetWeatherWindows | AlarmOrder
    | NotificationOrder | ControlOrder | LockOrder | RecordOrder | UndoSettings | UndoSiteSettings
    | InjectFault | EndInjectedFaults | ReportDeviceClock
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Order:
    """One call into the machine. `tracker_id` addresses a `Command`; a `SiteCommand` leaves it None.

    `key` makes a repeated order a no-op that answers as the first did. `issued_at` (the machine's
    own clock, as told by snapshots) makes an order refused that is older than 2 s, or as much ahead. `via`
    and `address` say how whoever ordered was known, and from where. `epoch` is the one of control that the
    order was given under (None: whichever holds on arrival), `rank` whose word counts more: 2 engineer, 1
    operator. `given_s` is when it was given, on the monotonic counter that both processes share (None: on
    arrival): no motion begins that was ordered before its tracker was stopped.
    """

    command: Command | SiteCommand
    actor: str
    tracker_id: str | None = None
    key: str | None = None
    issued_at: datetime | None = None
    via: str = ""
    address: str = ""
    epoch: int | None = None
    rank: int = 0
    given_s: float | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Update:
    """What the machine tells: how the site stands, the events since the last update, and what is different.

    `changed` are the trackers that differ, `arrivals` says that some came or went, `same_alarms` that no
    alarm differs. It follows the snapshot of the sequence `after`; None: there was none, all is new. With
    `more`, further trackers that changed come with the next one.
    """

    snapshot: SiteSnapshot
    events: tuple[Event, ...] = ()
    changed: tuple[Snapshot, ...] = ()
    after: int | None = None
    arrivals: bool = True
    same_alarms: bool = False
    more: bool = False


@dataclass(frozen=True, slots=True)
class TrackerDetail:
    """What changes seldom about a tracker: stored state, the five steps, its drive's abilities and proofs."""

    state: TrackerState
    steps: tuple[Step, ...]
    capabilities: DriveCapabilities | None
    proofs: tuple[ProofState, ...] = ()
    check: DriveCheck | None = None


@dataclass(frozen=True, slots=True)
class SiteDetail:
    """What changes seldom about the site, read when a page is rendered."""

    site: SiteState
    trackers: dict[str, TrackerDetail] = field(default_factory=dict)
    choices: DriveChoices = field(default_factory=DriveChoices)


class Machine(Protocol):
    """The machine as the panel sees it: over the wire, or directly in tests."""

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order and return the snapshot after it; the tracker it is about has its `actions`.

        Raises `CommandRejected`, `UnknownTracker`, `UnknownRecording` or `MachineUnreachable`.
        """

    async def detail(self) -> SiteDetail:
        """Return stored settings, steps and capabilities, or raise `MachineUnreachable`."""

    async def tracker(self, tracker_id: str) -> Snapshot:
        """Return one tracker now, with the reasons that forbid its `actions`, or raise `UnknownTracker`."""

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        """Have snapshots of these trackers told with their `actions` from now on, and of no others."""

    def latest(self) -> SiteSnapshot | None:
        """Return the newest snapshot that arrived, None before the first or while the link is down."""

    def updates(self) -> AsyncIterator[Update]:
        """Yield updates until the link goes down; a slow reader skips snapshots, never events."""
