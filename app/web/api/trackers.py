"""Trackers: what is set, what is, what can be done."""

from typing import Annotated, Any

from fastapi import APIRouter
from pydantic import Field, TypeAdapter, ValidationError

from app.link.messages import AddTracker, ConfigureTracker, RemoveTracker, TrackerDetail, UnknownTracker
from app.sun.position import Algorithm
from app.tracker.config import DriveKind, NightBehaviour, TrackerConfig
from app.tracker.motion import DriveCapabilities
from app.tracker.reason import Reason
from app.tracker.snapshot import Snapshot
from app.web.api.base import NOT_FOUND, REFUSED, Azimuth, Elevation, Input, Output, TrackerId
from app.web.api.orders import SenderDep, tracker_of
from app.web.deps import MachineDep, SnapshotDep
from app.web.errors import NotAcceptable, NotFound

router = APIRouter(prefix="/trackers", tags=["trackers"])

_config: TypeAdapter[TrackerConfig] = TypeAdapter(TrackerConfig)
Positive = Annotated[float, Field(gt=0, le=1000)]
AxisAngle = Annotated[float, Field(ge=-720, le=720, description="Axis degrees, not wrapped.")]


class AxisChange(Input):
    """Limits and speeds of one axis; what is left out stays."""

    minimum_deg: AxisAngle | None = None
    maximum_deg: AxisAngle | None = None
    speed_dps: Positive | None = Field(None, description="Rated speed, degrees a second.")
    acceleration_dps2: Positive | None = None
    jog_slow_dps: Positive | None = None
    jog_fast_dps: Positive | None = None


class DriveChange(Input):
    """How the drive is reached; what is left out stays."""

    kind: DriveKind | None = None
    profile: str | None = Field(None, min_length=1, max_length=64, examples=["simulated-plc"])
    host: str | None = Field(None, min_length=1, max_length=253, examples=["192.168.0.20"])
    port: int | None = Field(None, ge=1, le=65535, examples=[502])
    unit: int | None = Field(None, ge=0, le=255, description="Modbus unit id.")


class OrientationIn(Input):
    """A direction of the panel's normal."""

    azimuth_deg: Azimuth
    elevation_deg: Elevation


class TrackerChange(Input):
    """What shall be different; what is left out stays."""

    name: str | None = Field(None, min_length=1, max_length=80, examples=["North field"])
    azimuth: AxisChange | None = None
    elevation: AxisChange | None = None
    drive: DriveChange | None = None
    algorithm: Algorithm | None = Field(None, description="Sun position algorithm.")
    refraction: bool | None = Field(None, description="Point to the apparent, refracted sun.")
    deadband_deg: float | None = Field(None, gt=0, le=45, description="Largest distance from the sun.")
    in_position_deg: float | None = Field(None, gt=0, le=45)
    following_error_deg: float | None = Field(None, gt=0, le=90)
    night: NightBehaviour | None = Field(None, description="Where the panel waits for the morning.")
    park: OrientationIn | None = None


class NewTracker(TrackerChange):
    """A tracker to add; what is left out has its default."""

    tracker_id: str = Field(min_length=1, max_length=64, description="Short and new.", examples=["T2"])
    name: str = Field(min_length=1, max_length=80, examples=["South field"])


class ActionState(Output):
    """Whether an action is allowed now, and if not, why."""

    action: str
    allowed: bool
    reasons: tuple[Reason, ...]


async def detail_of(machine: MachineDep, tracker_id: TrackerId) -> TrackerDetail:
    """Return what changes seldom about a tracker, or raise `UnknownTracker`."""
    trackers = (await machine.detail()).trackers
    if tracker_id not in trackers:
        raise UnknownTracker(tracker_id)
    return trackers[tracker_id]


@router.get("", summary="All trackers' configurations")
async def list_trackers(machine: MachineDep) -> list[TrackerConfig]:
    """Return what is set for each tracker, in the order they were added."""
    return [one.state.config for one in (await machine.detail()).trackers.values()]


@router.post("", status_code=201, summary="Add a tracker", responses=REFUSED)
async def add_tracker(new: NewTracker, sender: SenderDep, machine: MachineDep) -> TrackerConfig:
    """Add a tracker and return its configuration with all defaults."""
    fresh = TrackerConfig(new.tracker_id, new.name)
    await sender.send(AddTracker(_changed(fresh, new)))
    return (await detail_of(machine, new.tracker_id)).state.config


@router.get("/{tracker_id}", summary="A tracker's configuration", responses=NOT_FOUND)
async def read_tracker(tracker_id: TrackerId, machine: MachineDep) -> TrackerConfig:
    """Return mount, axes, limits, drive, algorithm and strategy."""
    return (await detail_of(machine, tracker_id)).state.config


@router.patch("/{tracker_id}", summary="Configure or rename a tracker", responses=NOT_FOUND | REFUSED)
async def change_tracker(
    tracker_id: TrackerId, change: TrackerChange, sender: SenderDep, machine: MachineDep
) -> TrackerConfig:
    """Change what is given and keep the rest; refused while the tracker moves."""
    before = (await detail_of(machine, tracker_id)).state.config
    await sender.send(ConfigureTracker(_changed(before, change)))
    return (await detail_of(machine, tracker_id)).state.config


@router.delete("/{tracker_id}", status_code=204, summary="Remove a tracker", responses=NOT_FOUND | REFUSED)
async def remove_tracker(tracker_id: TrackerId, sender: SenderDep) -> None:
    """Remove a tracker that stands still; its recordings and journal stay."""
    await sender.send(RemoveTracker(tracker_id))


@router.get("/{tracker_id}/snapshot", summary="Everything about a tracker now", responses=NOT_FOUND)
async def read_snapshot(tracker_id: TrackerId, site: SnapshotDep) -> Snapshot:
    """Return the tracker at this instant."""
    return tracker_of(site, tracker_id)


@router.get("/{tracker_id}/capabilities", summary="What the drive can do", responses=NOT_FOUND)
async def read_capabilities(tracker_id: TrackerId, machine: MachineDep) -> DriveCapabilities:
    """Return what this drive can do, so that nobody has to find out by trying."""
    capabilities = (await detail_of(machine, tracker_id)).capabilities
    if capabilities is None:
        raise NotFound(f"The drive of {tracker_id} has not been reached yet; its abilities are not known.")
    return capabilities


@router.get("/{tracker_id}/actions", summary="What is allowed now", responses=NOT_FOUND)
async def read_actions(tracker_id: TrackerId, site: SnapshotDep) -> list[ActionState]:
    """Return each action with whether it is allowed and every reason that forbids it."""
    actions = tracker_of(site, tracker_id).actions
    return [
        ActionState(action=action, allowed=not reasons, reasons=reasons)
        for action, reasons in actions.items()
    ]


def _changed(config: TrackerConfig, change: TrackerChange) -> TrackerConfig:
    given = change.model_dump(mode="json", exclude_none=True)
    try:
        return _config.validate_python(_merged(_config.dump_python(config, mode="json"), given))
    except ValidationError as error:
        sentences = (one["msg"].removeprefix("Value error, ") for one in error.errors())
        raise NotAcceptable(" ".join(sentences)) from error


def _merged(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    return old | {
        name: _merged(old[name], value) if isinstance(value, dict) else value for name, value in new.items()
    }
