"""The commissioning record: who, when, as-left settings, and what was verified."""

from dataclasses import dataclass, field
from datetime import datetime, timedelta

from starlette.concurrency import run_in_threadpool

from app.base.build import VERSION
from app.base.message import N_, say
from app.link.messages import Machine, MachineUnreachable, SiteDetail, TrackerDetail, UnknownTracker
from app.store.store import JournalEntry, JournalFilter, Reader
from app.sun.position import Location
from app.tracker.commissioning.drive_test_states import ProofState
from app.tracker.commissioning.steps import Step
from app.tracker.memory.drive_check import DriveCheck
from app.tracker.memory.drive_tests import Proofs
from app.tracker.memory.memory import HomeTrust, Pointing, Sighting, SiteState
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ClockState, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCapabilities

VERIFYING = (
    EventKind.LOCATION_SET,
    EventKind.CLOCK_SET,
    EventKind.HOME_POSITION_SET,
    EventKind.HOME_POSITION_NOT_SET,
    EventKind.HOMING_ENDED,
    EventKind.HOME_LOST,
    EventKind.MODE_SELECTED,
    EventKind.MOVE_ENDED,
    EventKind.SIGHTING_TAKEN,
    EventKind.STEP_CONFIRMED,
    EventKind.SHOW_ENDED,
    EventKind.TRACKING_STARTED,
    EventKind.FAULT_RAISED,
    EventKind.DRIVE_TEST_ENDED,
    EventKind.DRIVE_CHECKED,
)
MOST_EVENTS = 200
CLOCK_GRACE = timedelta(minutes=1)
MISDATED = N_("The date is in the future because the clock was wrong. Confirm the step again.")


def is_future(at: datetime | None, written_at: datetime) -> bool:
    """Return whether something is dated after the record that tells it: its clock was wrong then."""
    return at is not None and at - written_at > CLOCK_GRACE


@dataclass(frozen=True, slots=True)
class CommissioningRecord:
    """Everything that proves how a tracker was left, as of `written_at` (site time)."""

    written_at: datetime
    software: str
    site_name: str
    location: Location | None
    time_zone: str
    clock: ClockState
    tracker: TrackerConfig
    drive: DriveCapabilities | None
    steps: tuple[Step, ...]
    home: HomeTrust | None
    mode: Mode | None
    pointing: Pointing
    sightings: tuple[Sighting, ...]
    off_sun_deg: float | None
    following_error_deg: float | None
    events: tuple[JournalEntry, ...]
    proofs: tuple[ProofState, ...] = ()
    measured: Proofs = field(default_factory=Proofs)
    check: DriveCheck | None = None


async def read_record(machine: Machine, reader: Reader, tracker_id: str) -> CommissioningRecord:
    """Return the record of a tracker, or raise `UnknownTracker` or `MachineUnreachable`."""
    detail, snapshot = await machine.detail(), machine.latest()
    if tracker_id not in detail.trackers:
        raise UnknownTracker(tracker_id)
    if snapshot is None:
        raise MachineUnreachable
    wanted = JournalFilter(limit=MOST_EVENTS, tracker_id=tracker_id, kinds=VERIFYING)
    entries = await run_in_threadpool(reader.journal, wanted)
    return _record(detail, snapshot, detail.trackers[tracker_id], tuple(reversed(entries)))


def _record(
    detail: SiteDetail, site: SiteSnapshot, tracker: TrackerDetail, events: tuple[JournalEntry, ...]
) -> CommissioningRecord:
    state: SiteState = detail.site
    memory = tracker.state.memory
    now = _now(site, tracker.state.config.tracker_id)
    return CommissioningRecord(
        written_at=site.at,
        software=say("Heliopanel {version}", version=VERSION),
        site_name=state.name,
        location=state.location,
        time_zone=state.time_zone,
        clock=site.clock,
        tracker=tracker.state.config,
        drive=tracker.capabilities,
        steps=tracker.steps,
        home=memory.home,
        mode=memory.mode,
        pointing=memory.pointing,
        sightings=memory.sightings,
        off_sun_deg=now.off_sun_deg if now else None,
        following_error_deg=now.following_error_deg if now else None,
        events=events,
        proofs=tracker.proofs,
        measured=memory.proofs,
        check=tracker.check,
    )


def _now(site: SiteSnapshot, tracker_id: str) -> Snapshot | None:
    return next((one for one in site.trackers if one.tracker_id == tracker_id), None)
