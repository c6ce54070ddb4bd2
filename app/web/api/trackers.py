"""Trackers: what is set, what is, what can be done."""

from dataclasses import dataclass, fields
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError
from starlette.requests import Request

from app.adapter import adapter
from app.link.messages import AddTracker, ConfigureTracker, RemoveTracker, TrackerDetail, UnknownTracker
from app.sun.position import Algorithm
from app.tracker.axes import Axis
from app.tracker.config import DriveKind, NightBehaviour, Parity, TrackerConfig
from app.tracker.limit_change import LimitReview
from app.tracker.motion import DriveCapabilities
from app.tracker.mounts.capabilities import MountAbilities, abilities
from app.tracker.mounts.usual import mounted
from app.tracker.reason import Reason
from app.tracker.snapshot import Snapshot
from app.tracker.strategy import Strategy
from app.web.api.base import NOT_FOUND, REFUSED, Azimuth, Elevation, Input, Output, TrackerId, api_router
from app.web.api.machine_inputs import MachineChange
from app.web.api.mount_inputs import ActuatorIn, MountChange
from app.web.api.orders import SenderDep
from app.web.api.protection_inputs import ProtectionChange, kept_azimuths
from app.web.deps import MachineDep, SnapshotDep
from app.web.errors import NotAcceptable, NotFound
from app.web.limit_review import limit_review, require_proof

router = api_router(prefix="/trackers", tags=["trackers"])

Positive = Annotated[float, Field(gt=0, le=1000)]
NULLABLE = ("unit", "steps_per_revolution")
AxisAngle = Annotated[float, Field(ge=-720, le=720, description="Axis degrees, not wrapped.")]


class AxisChange(Input):
    """Limits and speeds of one axis; what is left out stays."""

    minimum_deg: AxisAngle | None = None
    maximum_deg: AxisAngle | None = None
    speed_dps: Positive | None = Field(None, description="Rated speed, degrees a second.")
    acceleration_dps2: Positive | None = None
    jog_slow_dps: Positive | None = None
    jog_fast_dps: Positive | None = None
    actuator: ActuatorIn | None = Field(None, description="Linear actuator; null: none, degrees.")


class SerialChange(Input):
    """A serial line; what is left out stays."""

    port: str | None = Field(None, max_length=255, examples=["/dev/serial/by-id/usb-FTDI_USB-RS485"])
    baud_rate: int | None = Field(None, ge=300, le=4_000_000, examples=[19200])
    parity: Parity | None = None
    stop_bits: Literal[1, 2] | None = None


class AxisDriveChange(Input):
    """How one axis hangs on its drive; what is left out stays, null takes the drive's or profile's value."""

    unit: int | None = Field(None, ge=0, le=255, description="Modbus unit id; null: the drive's.")
    steps_per_revolution: Annotated[float, Field(gt=0, lt=1e9)] | None = Field(
        None, description="Of the motor; null: the profile's."
    )
    gear_ratio: float | None = Field(None, gt=0, lt=1e6, description="Motor revolutions a revolution.")
    inverted: bool | None = Field(None, description="The motor turns the axis the other way.")


class DriveChange(Input):
    """How the drive is reached; what is left out stays."""

    kind: DriveKind | None = None
    profile: str | None = Field(None, min_length=1, max_length=64, examples=["simulated-plc"])
    host: str | None = Field(None, min_length=1, max_length=253, examples=["127.0.0.1"])
    port: int | None = Field(None, ge=1, le=65535, examples=[502])
    unit: int | None = Field(None, ge=0, le=255, description="Modbus unit id.")
    serial: SerialChange | None = Field(None, description="For Modbus RTU.")
    azimuth: AxisDriveChange | None = None
    elevation: AxisDriveChange | None = None


class OrientationIn(Input):
    """A direction of the panel's normal."""

    azimuth_deg: Azimuth
    elevation_deg: Elevation


class SimulatedLightChange(Input):
    """What a simulated drive plays to its photo-sensors."""

    azimuth_deg: float | None = Field(None, ge=-10, le=10, description="Misalignment to be found.")
    elevation_deg: float | None = Field(None, ge=-10, le=10)
    cloud: float | None = Field(None, ge=0, le=1, description="Share of the direct light that it takes.")


class HybridChange(Input):
    """Correction by photo-sensor pairs; what is left out stays."""

    enabled: bool | None = None
    threshold_wm2: float | None = Field(None, ge=1, le=2000)
    gain_dps: float | None = Field(None, ge=0.001, le=10)
    bound_deg: float | None = Field(None, ge=0.01, le=10)
    decay_s: float | None = Field(None, ge=0, le=86_400, description="0 holds the correction in the dark.")
    simulated: SimulatedLightChange | None = None


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
    mount: MountChange | None = None
    strategy: Annotated[Strategy, Field(discriminator="kind")] | None = Field(
        None, description="When the tracker moves; given as a whole."
    )
    hybrid: HybridChange | None = Field(None, description="Correction by photo-sensor pairs.")
    machine: MachineChange | None = Field(None, description="Machine protections, recovery, regions.")
    protection: ProtectionChange | None = Field(None, description="Wind, snow, light, stow positions.")


class NewTracker(TrackerChange):
    """A tracker to add; what is left out has its default."""

    tracker_id: str = Field(min_length=1, max_length=64, description="Short and new.", examples=["T2"])
    name: str = Field(min_length=1, max_length=80, examples=["South field"])


@dataclass(frozen=True, slots=True, kw_only=True)
class Capabilities(DriveCapabilities):
    """What the drive can do, and what the mount."""

    mount: MountAbilities


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
    await sender.send(AddTracker(_changed(fresh, new, await _latitude_deg(machine))))
    return (await detail_of(machine, new.tracker_id)).state.config


@router.get("/{tracker_id}", summary="A tracker's configuration", responses=NOT_FOUND)
async def read_tracker(tracker_id: TrackerId, machine: MachineDep) -> TrackerConfig:
    """Return mount, axes, limits, drive, algorithm and strategy."""
    return (await detail_of(machine, tracker_id)).state.config


@router.patch("/{tracker_id}", summary="Configure or rename a tracker", responses=NOT_FOUND | REFUSED)
async def change_tracker(
    request: Request, tracker_id: TrackerId, change: TrackerChange, sender: SenderDep, machine: MachineDep
) -> TrackerConfig:
    """Change what is given and keep the rest; refused while the tracker moves.

    In a browser's session another limit, speed or drive wants the password of the last five minutes.
    """
    before = (await detail_of(machine, tracker_id)).state.config
    wanted = _changed(before, change, await _latitude_deg(machine))
    require_proof(request, before, wanted)
    await sender.send(ConfigureTracker(wanted))
    return (await detail_of(machine, tracker_id)).state.config


@router.post(
    "/{tracker_id}/review", summary="What a change would do to limits and speeds", responses=NOT_FOUND
)
async def review_change(
    tracker_id: TrackerId, change: TrackerChange, site: SnapshotDep, machine: MachineDep
) -> LimitReview:
    """Return what would differ, what forbids it where the axes stand, and what to be sure of."""
    tracker = await detail_of(machine, tracker_id)
    return limit_review(site, tracker, _changed(tracker.state.config, change, await _latitude_deg(machine)))


@router.delete("/{tracker_id}", status_code=204, summary="Remove a tracker", responses=NOT_FOUND | REFUSED)
async def remove_tracker(tracker_id: TrackerId, sender: SenderDep) -> None:
    """Remove a tracker that stands still; its recordings and journal stay."""
    await sender.send(RemoveTracker(tracker_id))


@router.get("/{tracker_id}/snapshot", summary="Everything about a tracker now", responses=NOT_FOUND)
async def read_snapshot(tracker_id: TrackerId, machine: MachineDep) -> Snapshot:
    """Return the tracker at this instant, with what is allowed now and what forbids the rest."""
    return await machine.tracker(tracker_id)


@router.get("/{tracker_id}/capabilities", summary="What drive and mount can do", responses=NOT_FOUND)
async def read_capabilities(tracker_id: TrackerId, machine: MachineDep) -> Capabilities:
    """Return what drive and mount can do, so that nobody has to find out by trying."""
    tracker = await detail_of(machine, tracker_id)
    if tracker.capabilities is None:
        raise NotFound(f"The drive of {tracker_id} has not been reached yet; its capabilities are not known.")
    drive = {one.name: getattr(tracker.capabilities, one.name) for one in fields(DriveCapabilities)}
    return Capabilities(**drive, mount=abilities(tracker.state.config.mount))


@router.get("/{tracker_id}/actions", summary="What is allowed now", responses=NOT_FOUND)
async def read_actions(tracker_id: TrackerId, machine: MachineDep) -> list[ActionState]:
    """Return each action with whether it is allowed and every reason that forbids it."""
    actions = (await machine.tracker(tracker_id)).actions
    return [
        ActionState(action=action, allowed=not reasons, reasons=reasons)
        for action, reasons in actions.items()
    ]


async def _latitude_deg(machine: MachineDep) -> float | None:
    """Return the site's latitude, None while the location is not known."""
    location = (await machine.detail()).site.location
    return None if location is None else location.latitude_deg


def _changed(config: TrackerConfig, change: TrackerChange, latitude_deg: float | None) -> TrackerConfig:
    kind = change.mount.kind if change.mount else None
    if kind is not None and kind is not config.mount.kind:
        config = mounted(config, kind, latitude_deg)
    given = merged(change.model_dump(mode="json", exclude_none=True), _back_to_default(change))
    try:
        return adapter(TrackerConfig).validate_python(
            merged(adapter(TrackerConfig).dump_python(config, mode="json"), given)
        )
    except ValidationError as error:
        sentences = (one["msg"].removeprefix("Value error, ") for one in error.errors())
        raise NotAcceptable(" ".join(sentences)) from error


def _back_to_default(change: TrackerChange) -> dict[str, Any]:
    """Return what was given as null on purpose, so that it shall count no more."""
    axes = {} if change.drive is None else {axis: getattr(change.drive, axis) for axis in Axis}
    nulls = {
        str(axis): {
            name: None for name in NULLABLE if name in one.model_fields_set and getattr(one, name) is None
        }
        for axis, one in axes.items()
        if one is not None
    }
    found: dict[str, Any] = {"drive": nulls} if nulls else {}
    if kept := kept_azimuths(change.protection):
        found["protection"] = kept
    for name, part, removed in (
        ("mount", change.mount, "rows"),
        ("azimuth", change.azimuth, "actuator"),
        ("elevation", change.elevation, "actuator"),
    ):
        if part is not None and removed in part.model_fields_set and getattr(part, removed) is None:
            found[name] = {removed: None}
    return found


def merged(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """Return a document with the given values in it; what is left out stays."""
    return old | {
        name: merged(old.get(name) or {}, value) if isinstance(value, dict) else value
        for name, value in new.items()
    }
