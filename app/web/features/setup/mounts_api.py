"""Mounts: what each kind can do, how a tracker is mounted, and what of the sun it can face."""

from starlette.concurrency import run_in_threadpool

from app.base.permission import Permission
from app.base.zones import day_in
from app.tracker.mounts.capabilities import ABILITIES, MountAbilities, abilities
from app.tracker.mounts.reach import Reach, reach
from app.tracker.settings.config import MountKind
from app.tracker.settings.mechanisms import MECHANISMS
from app.tracker.settings.transmission import LinearActuator
from app.web.api.base import NOT_FOUND, Output, TrackerId, api_router
from app.web.api.trackers import detail_of
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep

router = api_router(tags=["trackers"])


class MountState(Output):
    """How a tracker is mounted, what that can do, and what of this year's sun it can face."""

    abilities: MountAbilities
    reach: Reach | None


@router.get("/mounts", summary="What each kind of mount can do")
@needs(Permission.READ)
async def list_mounts() -> dict[MountKind, MountAbilities]:
    """Return names, axes and modes of every kind of mount."""
    return ABILITIES


@router.get("/actuator-presets", summary="Linear actuators by name")
@needs(Permission.READ)
async def list_actuator_presets() -> dict[str, LinearActuator]:
    """Return examples of linear actuators, ready for `azimuth.actuator` or `elevation.actuator`."""
    return {name: make() for name, make in MECHANISMS.items()}


@router.get("/trackers/{tracker_id}/mount", summary="A tracker's mount and its reach", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_mount(tracker_id: TrackerId, machine: MachineDep) -> MountState:
    """Return what the mount can do, and what of this year's sun; without location or time null."""
    config = (await detail_of(machine, tracker_id)).state.config
    site = machine.latest()
    if site is None or site.location is None:
        return MountState(abilities=abilities(config.mount), reach=None)
    found = await run_in_threadpool(reach, config, site.location, day_in(site.time_zone, site.at).year)
    return MountState(abilities=abilities(config.mount), reach=found)
