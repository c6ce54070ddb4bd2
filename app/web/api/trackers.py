"""Trackers: what is set, what is, what can be done."""

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, ValidationError
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request

from app.base.adapter import adapter
from app.base.message import join, say, told_of_value
from app.base.permission import Permission
from app.link.messages import AddTracker, ConfigureTracker, RemoveTracker, TrackerDetail, UnknownTracker
from app.tracker.motion.limit_change import LimitReview
from app.tracker.mounts.capabilities import MountAbilities, abilities
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind, TrackerConfig, TrackerName
from app.tracker.state.snapshot import Snapshot
from app.tracker.values.motion import DriveCapabilities
from app.tracker.values.reason import Reason
from app.web.api.base import (
    CHANGED,
    NOT_FOUND,
    REFUSED,
    TAGGED,
    Clean,
    Output,
    Page,
    TrackerId,
    api_router,
    whole,
)
from app.web.api.changes import Change, change_of, given
from app.web.api.limit_review import limit_review, require_proof
from app.web.api.orders import SenderDep
from app.web.api.tags import tagged, unless_changed
from app.web.http.errors import NotAcceptable, NotFound
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, SnapshotDep

router = api_router(prefix="/trackers", tags=["trackers"])

if TYPE_CHECKING:
    TrackerChange = Change
else:
    TrackerChange = change_of(TrackerConfig)


class NewTracker(TrackerChange):
    """A tracker to add; what is left out has its default."""

    tracker_id: str = Field(min_length=1, max_length=64, description="Short and new.", examples=["T2"])
    name: Annotated[TrackerName, Clean] = Field(examples=["South field"])


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


async def config_of(machine: MachineDep, tracker_id: TrackerId) -> TrackerConfig:
    """Return the settings of a tracker, or raise `UnknownTracker`."""
    return (await detail_of(machine, tracker_id)).state.config


@router.get("", summary="All trackers' configurations")
@needs(Permission.READ)
async def list_trackers(machine: MachineDep) -> Page[TrackerConfig]:
    """Return what is set for each tracker, in the order they were added."""
    return whole(one.state.config for one in (await machine.detail()).trackers.values())


@router.post("", status_code=201, summary="Add a tracker", responses=REFUSED)
@needs(Permission.CONFIGURE)
async def add_tracker(new: NewTracker, sender: SenderDep, machine: MachineDep) -> TrackerConfig:
    """Add a tracker and return its configuration with all defaults."""
    fresh = TrackerConfig(new.tracker_id, new.name)
    await sender.send(AddTracker(_changed(fresh, new, await _latitude_deg(machine))))
    return (await detail_of(machine, new.tracker_id)).state.config


@router.get(
    "/{tracker_id}",
    summary="A tracker's configuration",
    responses=TAGGED | NOT_FOUND,
    dependencies=[tagged(config_of)],
)
@needs(Permission.READ)
async def read_tracker(tracker_id: TrackerId, machine: MachineDep) -> TrackerConfig:
    """Return mount, axes, limits, drive, algorithm and strategy."""
    return (await detail_of(machine, tracker_id)).state.config


@router.patch(
    "/{tracker_id}",
    summary="Configure or rename a tracker",
    responses=CHANGED | NOT_FOUND | REFUSED,
    dependencies=[unless_changed(config_of)],
)
@needs(Permission.CONFIGURE)
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
    "/{tracker_id}/review", summary="What a change would do to limits, speeds, and aim", responses=NOT_FOUND
)
@needs(Permission.READ)
async def review_change(
    tracker_id: TrackerId, change: TrackerChange, site: SnapshotDep, machine: MachineDep
) -> LimitReview:
    """Return what would differ, what forbids it where the axes stand, and what to be sure of."""
    tracker = await detail_of(machine, tracker_id)
    wanted = _changed(tracker.state.config, change, await _latitude_deg(machine))
    return await run_in_threadpool(limit_review, site, tracker, wanted)


@router.delete(
    "/{tracker_id}",
    status_code=204,
    summary="Remove a tracker",
    responses=CHANGED | NOT_FOUND | REFUSED,
    dependencies=[unless_changed(config_of)],
)
@needs(Permission.CONFIGURE)
async def remove_tracker(tracker_id: TrackerId, sender: SenderDep) -> None:
    """Remove a tracker that stands still; its recordings and journal stay."""
    await sender.send(RemoveTracker(tracker_id))


@router.get("/{tracker_id}/snapshot", summary="Everything about a tracker now", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_snapshot(tracker_id: TrackerId, machine: MachineDep) -> Snapshot:
    """Return the tracker at this instant, with what is allowed now and what forbids the rest."""
    return await machine.tracker(tracker_id)


@router.get("/{tracker_id}/capabilities", summary="What drive and mount can do", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_capabilities(tracker_id: TrackerId, machine: MachineDep) -> Capabilities:
    """Return what drive and mount can do, so that nobody has to find out by trying."""
    tracker = await detail_of(machine, tracker_id)
    if tracker.capabilities is None:
        raise NotFound(
            say(
                "The drive of {tracker_id} has not been reached yet; its capabilities are not known.",
                tracker_id=tracker_id,
            )
        )
    drive = {one.name: getattr(tracker.capabilities, one.name) for one in fields(DriveCapabilities)}
    return Capabilities(**drive, mount=abilities(tracker.state.config.mount))


@router.get("/{tracker_id}/actions", summary="What is allowed now", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_actions(tracker_id: TrackerId, machine: MachineDep) -> Page[ActionState]:
    """Return each action with whether it is allowed and every reason that forbids it."""
    actions = (await machine.tracker(tracker_id)).actions
    return whole(
        ActionState(action=action, allowed=not reasons, reasons=reasons)
        for action, reasons in actions.items()
    )


async def _latitude_deg(machine: MachineDep) -> float | None:
    """Return the site's latitude, None while the location is not known."""
    location = (await machine.detail()).site.location
    return None if location is None else location.latitude_deg


def _changed(config: TrackerConfig, change: Change, latitude_deg: float | None) -> TrackerConfig:
    wanted = given(change)
    kind = wanted.get("mount", {}).get("kind", config.mount.kind)
    if kind != config.mount.kind:
        config = mounted(config, MountKind(kind), latitude_deg)
    try:
        return adapter(TrackerConfig).validate_python(
            merged(adapter(TrackerConfig).dump_python(config, mode="json"), wanted)
        )
    except ValidationError as error:
        sentences = (told_of_value(one) for one in error.errors())
        raise NotAcceptable(join(" ", sentences)) from error


def merged(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """Return a document with the given values in it; what is left out stays."""
    return old | {
        name: merged(old.get(name) or {}, value) if isinstance(value, dict) else value
        for name, value in new.items()
    }
