"""The lock on what was commissioned, and undoing the last change of it."""

from pydantic import Field

from app.base.permission import Permission
from app.link.settings_orders import LockSettings, UndoSettings, UnlockSettings
from app.tracker.memory.memory import CommissioningLock
from app.tracker.settings.config import TrackerConfig
from app.web.api.base import CHANGED, NOT_FOUND, REFUSED, TAGGED, Input, Output, TrackerId, api_router
from app.web.api.orders import SenderDep, tracker_of
from app.web.api.tags import tagged, unless_changed
from app.web.api.trackers import detail_of
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, SnapshotDep

router = api_router(tags=["commissioning"])


class LockInput(Input):
    """Lock the settings, or unlock them for a reason."""

    locked: bool = Field(description="True locks, false unlocks.", examples=[True])
    reason: str = Field("", max_length=200, description="Why they are unlocked; goes into the journal.")


class LockOutput(Output):
    """Whether the settings of a tracker are locked."""

    tracker_id: str = Field(description="The tracker.")
    locked: CommissioningLock | None = Field(description="Who locked them and when; null: they are open.")


def lock_of(tracker_id: TrackerId, site: SnapshotDep) -> CommissioningLock | None:
    """Return who locked the settings of a tracker, None for nobody."""
    return tracker_of(site, tracker_id).settings_lock


@router.get(
    "/trackers/{tracker_id}/settings-lock",
    summary="Whether a tracker's settings are locked",
    responses=TAGGED | NOT_FOUND,
    dependencies=[tagged(lock_of)],
)
@needs(Permission.READ)
async def read_settings_lock(tracker_id: TrackerId, site: SnapshotDep) -> LockOutput:
    """Return who locked the settings, if anybody did."""
    return LockOutput(tracker_id=tracker_id, locked=tracker_of(site, tracker_id).settings_lock)


@router.put(
    "/trackers/{tracker_id}/settings-lock",
    summary="Lock a tracker's settings, or unlock them",
    responses=CHANGED | NOT_FOUND | REFUSED,
    dependencies=[unless_changed(lock_of)],
)
@needs(Permission.CONFIGURE)
async def set_settings_lock(tracker_id: TrackerId, said: LockInput, sender: SenderDep) -> LockOutput:
    """Lock settings, drive, mount, strategy, zero and location as commissioned, or unlock them."""
    order = LockSettings(tracker_id) if said.locked else UnlockSettings(tracker_id, said.reason)
    site = await sender.send(order)
    return LockOutput(tracker_id=tracker_id, locked=tracker_of(site, tracker_id).settings_lock)


@router.post(
    "/trackers/{tracker_id}/settings/undo",
    summary="Undo the last change of the settings",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.CONFIGURE, proven=True)
async def undo_settings(tracker_id: TrackerId, sender: SenderDep, machine: MachineDep) -> TrackerConfig:
    """Set the tracker as it was before its settings were changed last, its drive aside; once more redoes."""
    await sender.send(UndoSettings(tracker_id))
    return (await detail_of(machine, tracker_id)).state.config
